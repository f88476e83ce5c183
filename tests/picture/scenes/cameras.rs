//! Scenes seen through their cameras.

use super::{SIZE, arms, drawn_at, projected, script, shown, state, view};
use dragonfly_kit::random::Random;
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::camera::Camera;
use glam::Vec3;
use std::time::Instant;

const SEED: u64 = 20;

/// Checks that points around the scene are drawn where a camera 36 mm wide has them.
fn check(view: &std::sync::Arc<dragonfly_document::SceneView>, seconds: f32, points: &mut Random) -> Camera {
    let scene = shown(view, seconds);
    let camera = state(view, f64::from(seconds)).camera.expect("a camera");
    let mut compared = 0;
    for _ in 0..50 {
        let mut next = |reach: f32| points.between(-reach, reach);
        let point = Vec3::new(next(4.0), next(3.0) + 1.0, next(4.0));
        let expected = projected(camera.position, camera.rotation, camera.lens, point);
        let Some((drawn, expected)) = drawn_at(&scene, point).zip(expected) else { continue };
        if expected.abs().max_element() < 3.0 {
            assert!(
                drawn.distance(expected) < 1e-3,
                "seed {SEED}: {point} at {seconds}: {drawn}, not {expected}"
            );
            compared += 1;
        }
    }
    assert!(compared > 5, "seed {SEED}: {compared} points at {seconds}");
    *scene.seen()
}

#[test]
fn a_shot_shows_what_a_lens_shows_on_an_image_36_mm_wide_also_during_a_blend() {
    let view = view(&arms());
    let mut points = Random::new(SEED);
    // The first camera, the middle of the blend, the second one.
    for seconds in [0.0, 1.75, 1.8, 2.5] {
        check(&view, seconds, &mut points);
    }
}

#[test]
fn a_camera_that_is_carried_rolls_with_its_carrier() {
    let text = script(
        r#"<role id="anna" model="arm"/><camera id="eye" at="0 0 0"/>"#,
        r#"<play who="anna" take="bend"/><attach who="eye" to="anna.bone 2"/>"#,
    );
    let view = view(&text);
    let mut points = Random::new(SEED);
    let rolls = [0.0, 0.3, 0.6, 1.0].map(|seconds| check(&view, seconds, &mut points).roll.abs());
    assert!(rolls[0] < 0.01 && rolls[3] > 1.0, "it is as if nothing rolled: {rolls:?}");
}

#[test]
fn any_camera_of_the_cast_can_be_looked_through_and_without_one_the_free_camera_shows() {
    let view = view(&arms());
    let mut scene = shown(&view, 0.0);
    let free = scene.camera;
    let shot = *scene.seen();
    let mut seen = |through: ThroughCamera| {
        scene.look.through = through;
        scene.prepare(Instant::now());
        *scene.seen()
    };
    assert_eq!(seen(ThroughCamera::Of("wide".into())), shot);
    let close = seen(ThroughCamera::Of("close".into()));
    assert!((close.eye() - Vec3::new(-2.0, 3.0, 4.0)).length() < 1e-4, "{}", close.eye());
    assert!(close.field_of_view < shot.field_of_view, "85 mm shows less than 35 mm");
    assert_eq!(seen(ThroughCamera::Free), free);
    assert_eq!(seen(ThroughCamera::Of("nobody".into())), free);
}

#[test]
fn a_viewport_of_another_shape_shows_the_whole_image() {
    let view = view(&arms());
    let camera = state(&view, 0.0).camera.expect("a camera");
    let corner = |x: f32, y: f32| {
        let half = Vec3::new(x * 18.0, y * 18.0 * SIZE[1] as f32 / SIZE[0] as f32, -camera.lens);
        camera.position + camera.rotation * half * 0.1
    };
    for (size, touches) in [([320, 320], 0), ([900, 180], 1)] {
        let mut scene = shown(&view, 0.0);
        scene.look.viewport = [0, 0, size[0], size[1]];
        scene.prepare(Instant::now());
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let at = drawn_at(&scene, corner(x, y)).expect("in front");
            assert!(at.abs().max_element() < 1.0 + 1e-4, "{size:?}: {at}");
            assert!((at[touches].abs() - 1.0).abs() < 1e-4, "{size:?} is not filled: {at}");
        }
    }
}
