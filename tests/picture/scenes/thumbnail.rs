//! Small pictures of shots: what their cameras see, and the viewport as it is without them.

use super::{SIZE, arms, view};
use dragonfly_kit::picture::images::difference;
use dragonfly_kit::picture::studio;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::{Look, ThroughCamera, ThumbnailOrder};
use std::sync::Arc;
use std::time::Instant;

/// The end of the scene, in seconds, and another time in it.
const SHOWN: f32 = 1.0;
const OTHER: f64 = 1.75;

#[test]
fn a_thumbnail_is_what_a_camera_sees_at_a_time_and_the_viewport_stays_as_it_is() {
    let Some(mut studio) = studio::studio() else { return };
    let (now, stage, view) = (Instant::now(), studio.stage(), view(&arms()));
    let length = view.plan.as_ref().map_or(0.0, |plan| plan.length().seconds());
    let clock = |time| PlaybackClock::of_scene(length, now).seek(time, now);
    let viewport = [0, 0, SIZE[0], SIZE[1]];
    let free = Look { viewport, helpers: true, ..Look::default() };
    stage.scene.show_scene(&view);
    stage.resize(SIZE);
    (stage.scene.look, stage.scene.playback) = (free.clone(), clock(SHOWN));
    stage.touch_scene();
    let before = stage.capture(now).unwrap();

    let order = ThumbnailOrder { camera: "close".into(), time: OTHER, size: SIZE };
    let thumbnail = stage.thumbnail(&order, now).expect("nothing is loaded later");
    assert!(Arc::ptr_eq(&thumbnail.plan.unwrap(), view.plan.as_ref().unwrap()));
    assert_eq!((&stage.scene.look, stage.scene.playback), (&free, clock(SHOWN)));
    // The window alone is drawn again, with the scene as it is.
    stage.touch_window();
    assert_eq!(difference(&before, &stage.capture(now).unwrap()), 0, "the viewport is as it was");
    stage.touch_scene();
    assert_eq!(difference(&before, &stage.capture(now).unwrap()), 0, "also drawn again");

    let through = ThroughCamera::Of("close".into());
    (stage.scene.look, stage.scene.playback) =
        (Look { viewport, through, ..Look::default() }, clock(OTHER as f32));
    stage.touch_scene();
    let alone = stage.capture(now).unwrap();
    assert_eq!(difference(&alone, &thumbnail.picture.unwrap()), 0, "it is the image of its camera");
    assert!(difference(&alone, &before) > 0);
}

#[test]
fn there_is_no_thumbnail_of_a_model_and_none_without_a_size() {
    let Some(mut studio) = studio::studio() else { return };
    let (now, stage) = (Instant::now(), studio.stage());
    let order = ThumbnailOrder { camera: "close".into(), time: 0.0, size: SIZE };
    let nothing = stage.thumbnail(&order, now).unwrap();
    assert!(nothing.plan.is_none() && nothing.picture.is_none());
    stage.scene.show_scene(&view(&arms()));
    let flat = stage.thumbnail(&ThumbnailOrder { size: [0, 80], ..order }, now).unwrap();
    assert!(flat.plan.is_some() && flat.picture.is_none());
}
