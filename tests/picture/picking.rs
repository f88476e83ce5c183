//! Picking finds the bone that is drawn under the pointer, in its animated pose.

use dragonfly_kit::document::arm;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::pick::pick;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::scene::Scene;
use dragonfly_picture::{BoneLook, Look};
use glam::Vec3;
use std::time::Instant;

/// A window larger than the viewport, which does not start at its corner.
const VIEWPORT: [u32; 4] = [100, 50, 640, 480];

fn scene(time: f32, bone_look: BoneLook) -> Scene {
    let now = Instant::now();
    let mut scene = Scene::new(now);
    scene.show_model(arm::loaded());
    scene.camera = Camera { target: Vec3::Y * 1.5, distance: 8.0, yaw: 0.3, pitch: 0.2, ..Camera::default() };
    scene.look = Look { viewport: VIEWPORT, skeleton: true, bone_look, ..Look::default() };
    scene.playback =
        PlaybackClock { take: Some(0), length: arm::LENGTH, ..PlaybackClock::rest(now) }.seek(time, now);
    scene.prepare(now);
    scene
}

/// Returns where a point of the scene appears in the window.
fn window_position(scene: &Scene, point: Vec3) -> [f32; 2] {
    let clip = scene.clip_from_world(&scene.bounds().sphere) * point.extend(1.0);
    let [x, y, width, height] = VIEWPORT.map(|value| value as f32);
    let place = clip.truncate() / clip.w;
    [x + (place.x * 0.5 + 0.5) * width, y + (0.5 - place.y * 0.5) * height]
}

#[test]
fn a_click_on_a_drawn_bone_picks_it() {
    for bone_look in [BoneLook::Octahedra, BoneLook::Sticks, BoneLook::Lines] {
        for time in [0.0, 0.6, arm::LENGTH] {
            let scene = scene(time, bone_look);
            let to_root = scene.model().unwrap().to_root();
            for (bone, matrix) in to_root.iter().enumerate() {
                // The last bone is short; a point near its start is inside all of them.
                let along = matrix.transform_point3(Vec3::Y * 0.12);
                let picked = pick(&scene, window_position(&scene, along));
                assert_eq!(picked, Some(bone as u32), "{bone_look:?} at {time}");
            }
        }
    }
}

#[test]
fn a_near_miss_picks_the_nearest_bone_and_a_far_miss_none() {
    let scene = scene(0.0, BoneLook::Lines);
    let [x, y] = window_position(&scene, Vec3::Y * 0.5);
    assert_eq!(pick(&scene, [x + 7.0, y]), Some(0));
    assert_eq!(pick(&scene, [x + 60.0, y]), None);
}

#[test]
fn the_pick_distance_is_the_same_on_a_high_dpi_screen() {
    let mut scene = scene(0.0, BoneLook::Lines);
    let [x, y] = window_position(&scene, Vec3::Y * 0.5);
    assert_eq!(pick(&scene, [x + 17.0, y]), None);
    scene.look.pixels_per_point = 2.0;
    assert_eq!(pick(&scene, [x + 17.0, y]), Some(0));
    assert_eq!(pick(&scene, [x + 60.0, y]), None);
}

#[test]
fn picking_ignores_points_outside_the_viewport_and_includes_hidden_bones() {
    let mut scene = scene(0.0, BoneLook::Octahedra);
    let on_bone = window_position(&scene, Vec3::Y * 0.5);
    assert_eq!(pick(&scene, [99.0, 200.0]), None);
    assert_eq!(pick(&scene, on_bone), Some(0));
    scene.look.skeleton = false;
    assert_eq!(pick(&scene, on_bone), Some(0), "bones that are not drawn can be picked too");
}
