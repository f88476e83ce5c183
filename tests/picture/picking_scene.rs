//! A click on the scene picks drawn bones; where none is drawn, it picks by the skin that they move, and never a
//! hidden bone.

use dragonfly_document::bones::{BoneSelection, Choice, HiddenBones};
use dragonfly_kit::document::arm;
use dragonfly_picture::Look;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::scene::Scene;
use dragonfly_picture::shape::Body;
use glam::Vec3;
use std::sync::Arc;
use std::time::Instant;

const VIEWPORT: [u32; 4] = [100, 50, 640, 480];

fn scene(skeleton: bool, hidden: &[u32]) -> Scene {
    let now = Instant::now();
    let mut scene = Scene::new(now);
    scene.show_model(arm::loaded());
    scene.camera = Camera { target: Vec3::Y * 1.5, distance: 8.0, yaw: 0.3, pitch: 0.2, ..Camera::default() };
    let mut selection = BoneSelection::new(arm::BONES);
    selection.choose(hidden, Choice::Replace);
    let mut bones = HiddenBones::default();
    bones.hide(&mut selection);
    scene.look = Look { viewport: VIEWPORT, skeleton, hidden: Arc::new(bones), ..Look::default() };
    scene.playback = PlaybackClock { take: Some(0), length: arm::LENGTH, ..PlaybackClock::rest(now) };
    scene.prepare(now);
    scene
}

/// Returns where a point of the scene appears in the window.
fn window_position(scene: &Scene, place: Vec3) -> [f32; 2] {
    let clip = scene.clip_from_world(&scene.bounds().sphere) * place.extend(1.0);
    let [x, y, width, height] = VIEWPORT.map(|value| value as f32);
    let place = clip.truncate() / clip.w;
    [x + (place.x * 0.5 + 0.5) * width, y + (0.5 - place.y * 0.5) * height]
}

#[test]
fn hidden_bones_are_neither_drawn_nor_picked() {
    let mut scene = scene(true, &[0]);
    let shape = scene.model().unwrap().shape();
    let drawn = |bone: u32| Body::ALL.iter().any(|body| shape.owners(*body).contains(&bone));
    assert!(!drawn(0) && drawn(1) && drawn(2));
    let at = window_position(&scene, Vec3::Y * 0.5);
    assert!(!scene.pick_all(at).contains(&0));
    let mut all = self::scene(true, &[]);
    assert_eq!(all.pick_all(at).first(), Some(&0));
}

#[test]
fn a_click_picks_the_skin_where_no_bone_is_drawn() {
    let mut scene = scene(false, &[]);
    // Next to the bones, on the tube around them.
    let aside = scene.camera.right() * 0.15;
    for (height, bone) in [(0.2, 0), (1.2, 1)] {
        let at = window_position(&scene, Vec3::Y * height + aside);
        assert_eq!(scene.pick_all(at).first(), Some(&bone), "{height}");
    }
    let far = window_position(&scene, Vec3::Y * 1.5 + scene.camera.right() * 2.0);
    assert!(scene.pick_all(far).is_empty());
}
