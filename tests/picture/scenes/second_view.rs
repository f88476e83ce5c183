//! The second view of a scene, next to the viewport: what its camera sees, and the viewport as it is without it.

use super::{SIZE, arms, view};
use dragonfly_kit::picture::images::difference;
use dragonfly_kit::picture::studio;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::{Look, SecondView, Studio, ThroughCamera};
use image::RgbaImage;
use std::time::Instant;

const WIDTH: u32 = SIZE[0];
const HEIGHT: u32 = SIZE[1];

/// Returns the two halves of a window whose left one is the viewport.
fn halves(studio: &mut Studio, through: ThroughCamera, second: Option<ThroughCamera>) -> [RgbaImage; 2] {
    let (now, stage, view) = (Instant::now(), studio.stage(), view(&arms()));
    stage.scene.show_scene(&view);
    let camera = Camera { yaw: 1.0, distance: 5.0, ..Camera::default() };
    let second = second.map(|through| SecondView { viewport: [WIDTH, 0, WIDTH, HEIGHT], through, camera });
    let viewport = [0, 0, WIDTH, HEIGHT];
    stage.scene.look = Look { viewport, through, second, helpers: true, ..Look::default() };
    let length = view.plan.as_ref().map_or(0.0, |plan| plan.length().seconds());
    stage.scene.playback = PlaybackClock::of_scene(length, now).seek(1.0, now);
    stage.resize([2 * WIDTH, HEIGHT]);
    stage.touch_scene();
    let image = stage.capture(now).unwrap();
    [0, WIDTH].map(|left| image::imageops::crop_imm(&image, left, 0, WIDTH, HEIGHT).to_image())
}

#[test]
fn the_second_view_is_what_its_camera_sees_and_the_viewport_stays_as_it_is() {
    let Some(mut studio) = studio::studio() else { return };
    let close = ThroughCamera::Of("close".into());
    let [free, nothing] = halves(&mut studio, ThroughCamera::Free, None);
    let [beside, second] = halves(&mut studio, ThroughCamera::Free, Some(close.clone()));
    assert_eq!(difference(&free, &beside), 0, "the viewport is as without a second view");
    assert!(difference(&nothing, &second) > 0, "something is drawn");
    // The camera without helpers, as images of it are.
    studio.stage().scene.look.helpers = false;
    let view = view(&arms());
    let length = view.plan.as_ref().map_or(0.0, |plan| plan.length().seconds());
    let now = Instant::now();
    let stage = studio.stage();
    stage.scene.look = Look { viewport: [0, 0, WIDTH, HEIGHT], through: close, ..Look::default() };
    stage.scene.playback = PlaybackClock::of_scene(length, now).seek(1.0, now);
    stage.touch_scene();
    let alone = stage.capture(now).unwrap();
    let alone = image::imageops::crop_imm(&alone, 0, 0, WIDTH, HEIGHT).to_image();
    assert_eq!(difference(&alone, &second), 0, "the second view is the image of its camera");
    let [_, gone] = halves(&mut studio, ThroughCamera::Free, None);
    assert_eq!(difference(&nothing, &gone), 0, "nothing is left of it");
}

#[test]
fn a_second_view_through_no_camera_of_the_scene_is_seen_with_a_free_camera_of_its_own() {
    let Some(mut studio) = studio::studio() else { return };
    let [free, nothing] = halves(&mut studio, ThroughCamera::Free, None);
    let [beside, second] = halves(&mut studio, ThroughCamera::Free, Some(ThroughCamera::Free));
    assert_eq!(difference(&free, &beside), 0, "the viewport is as without a second view");
    assert!(difference(&nothing, &second) > 0, "something is drawn");
    let own = studio.stage().scene.camera;
    // The same camera in the viewport, with the helpers with which the user works in it.
    let now = Instant::now();
    let stage = studio.stage();
    stage.scene.camera = Camera { yaw: 1.0, distance: 5.0, ..Camera::default() };
    stage.scene.look = Look { viewport: [0, 0, WIDTH, HEIGHT], helpers: true, ..Look::default() };
    stage.touch_scene();
    let alone = stage.capture(now).unwrap();
    let alone = image::imageops::crop_imm(&alone, 0, 0, WIDTH, HEIGHT).to_image();
    stage.scene.camera = own;
    assert_eq!(difference(&alone, &second), 0, "the second view is the image of its camera");
}
