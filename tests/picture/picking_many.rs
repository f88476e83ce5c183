//! Picking finds all bones under the pointer, the nearest first, and those in a box or lasso.

use dragonfly_document::bones::{BoneSelection, Choice, HiddenBones};
use dragonfly_kit::document::arm;
use dragonfly_kit::random::{Random, seed};
use dragonfly_picture::camera::Camera;
use dragonfly_picture::pick::ClickCycle;
use dragonfly_picture::pick::Region;
use dragonfly_picture::pick::{pick, pick_all, pick_region};
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::scene::Scene;
use dragonfly_picture::{BoneLook, Look};
use glam::{Vec2, Vec3};
use std::time::Instant;

const VIEWPORT: [u32; 4] = [100, 50, 640, 480];

fn scene(camera: Camera, bone_look: BoneLook) -> Scene {
    let now = Instant::now();
    let mut scene = Scene::new(now);
    scene.show_model(arm::loaded());
    scene.camera = camera;
    scene.look = Look { viewport: VIEWPORT, skeleton: true, bone_look, ..Look::default() };
    scene.playback = PlaybackClock { take: None, length: arm::LENGTH, ..PlaybackClock::rest(now) };
    scene.prepare(now);
    scene
}

/// Returns a camera that looks along the arm, slightly from the side: its three bones overlap in the view.
fn from_the_tip() -> Camera {
    let camera = Camera { target: Vec3::Y * 1.5, distance: 8.0, yaw: 0.0, ..Camera::default() };
    Camera { pitch: 1.56, ..camera }
}

fn all(scene: &Scene, at: [f32; 2], hidden: &HiddenBones) -> Vec<u32> {
    let mut bones = vec![42];
    pick_all(scene, at, hidden, &mut bones);
    bones
}

#[test]
fn picked_bones_are_sorted_by_depth_and_repeated_clicks_cycle_through_them() {
    let scene = scene(from_the_tip(), BoneLook::Octahedra);
    let middle = [100.0 + 320.0, 50.0 + 240.0];
    let none = HiddenBones::default();
    assert_eq!(all(&scene, middle, &none), [2, 1, 0]);
    let mut cycle = ClickCycle::default();
    let clicks: Vec<_> =
        (0..4).map(|_| cycle.click(Vec2::from(middle), &all(&scene, middle, &none)).unwrap()).collect();
    assert_eq!(clicks, [2, 1, 0, 2]);
    let mut hidden = HiddenBones::default();
    let mut selection = BoneSelection::new(arm::BONES);
    selection.click(Some(2), Choice::Replace);
    hidden.hide(&mut selection);
    assert_eq!(all(&scene, middle, &hidden), [1, 0]);
    assert_eq!(all(&scene, [0.0, 0.0], &none), [0_u32; 0], "outside of the viewport");
}

#[test]
fn the_first_of_all_picked_bones_is_the_one_a_single_pick_returns() {
    let seed = seed(81);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let mut found = 0;
    for _ in 0..60 {
        let look = random.choice(&[BoneLook::Octahedra, BoneLook::Sticks, BoneLook::Lines]);
        let camera = Camera {
            target: Vec3::Y * 1.5,
            distance: 8.0,
            yaw: random.between(-3.0, 3.0),
            pitch: random.between(-1.5, 1.5),
            ..Camera::default()
        };
        let scene = scene(camera, look);
        for _ in 0..100 {
            let at = [random.between(370.0, 470.0), random.between(100.0, 480.0)];
            let bones = all(&scene, at, &HiddenBones::default());
            assert_eq!(bones.first().copied(), pick(&scene, at), "{look:?} {at:?}");
            found += bones.len();
        }
    }
    assert!(found > 300, "{found}");
}

#[test]
fn a_box_or_lasso_selects_bones_whose_joint_or_middle_is_inside() {
    for (pixels_per_point, look) in
        [(1.0, BoneLook::Octahedra), (2.0, BoneLook::Sticks), (1.5, BoneLook::Lines)]
    {
        let camera =
            Camera { target: Vec3::Y * 1.5, distance: 8.0, yaw: 0.0, pitch: 0.0, ..Camera::default() };
        let mut scene = scene(camera, look);
        scene.look.pixels_per_point = pixels_per_point;
        let at = |point: Vec3| {
            let clip = scene.clip_from_world(&scene.bounds().sphere) * point.extend(1.0);
            let place = clip.truncate() / clip.w;
            Vec2::new(place.x * 0.5 + 0.5, 0.5 - place.y * 0.5) * scene.size() / pixels_per_point
        };
        let held = |region: Region<'_>, hidden: &HiddenBones| {
            let mut bones = vec![42];
            pick_region(&scene, &region, hidden, &mut bones);
            bones
        };
        let none = HiddenBones::default();
        let wide = Vec2::X * 20.0;
        let between = |low: f32, high: f32| Region::Box(at(Vec3::Y * low) - wide, at(Vec3::Y * high) + wide);
        assert_eq!(held(between(0.9, 1.1), &none), [1], "the joint of 1");
        assert_eq!(held(between(0.4, 0.6), &none), [0], "the middle of 0");
        assert_eq!(held(between(0.4, 1.1), &none), [0, 1]);
        assert_eq!(held(between(0.6, 0.9), &none), [0_u32; 0], "nothing but an edge");
        assert_eq!(held(between(-1.0, 4.0), &none), [0, 1, 2]);
        let line = [at(Vec3::Y * 1.9) - wide, at(Vec3::Y * 2.1) - wide, at(Vec3::Y * 2.05) + wide];
        assert_eq!(held(Region::Lasso(&line), &none), [2]);
        let mut hidden = HiddenBones::default();
        let mut selection = BoneSelection::new(arm::BONES);
        selection.click(Some(1), Choice::Replace);
        hidden.hide(&mut selection);
        assert_eq!(held(between(-1.0, 4.0), &hidden), [0, 2]);
    }
}
