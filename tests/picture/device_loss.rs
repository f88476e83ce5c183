//! A lost device loses nothing: everything is restored from the data in main memory, however often.

use dragonfly_kit::document::arm;
use dragonfly_kit::picture::images::{difference, settings};
use dragonfly_kit::picture::studio;
use dragonfly_kit::process::{alone, resident_bytes};
use dragonfly_picture::PictureSettings;
use dragonfly_picture::losses::{LossRecord, LossTolerance, MAX_LOSSES, PATIENCE};
use std::time::{Duration, Instant};

#[test]
fn the_image_is_the_same_after_a_hundred_device_losses() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = arm::loaded();
    let settings = PictureSettings { size: [64, 48], skeleton: true, ..settings() };
    let before = studio.render(&loaded, &settings).unwrap();
    for loss in 1..=100 {
        studio.stage().device().lose();
        // Most devices are lost before anything was drawn again, some after; both must work.
        if loss % 10 == 0 {
            let after = studio.render(&loaded, &settings).unwrap();
            assert_eq!(difference(&before, &after), 0, "after {loss} losses");
        } else {
            studio.stage().whole_frame(Instant::now());
        }
    }
    assert_eq!(studio.stage().device().losses(), 100);
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn a_hundred_device_losses_leak_no_memory() {
    alone("device_loss::a_hundred_device_losses_leak_no_memory", || {
        let Some(mut studio) = studio::studio() else { return };
        let loaded = arm::loaded();
        let settings = PictureSettings { size: [64, 48], ..settings() };
        let mut lose = |times: usize| {
            for _ in 0..times {
                studio.stage().device().lose();
                studio.render(&loaded, &settings).unwrap();
            }
            resident_bytes()
        };
        // The first few losses fill the caches of the driver.
        let before = lose(20);
        let after = lose(100);
        println!("{} KiB before, {} KiB after a hundred losses", before >> 10, after >> 10);
        assert!(after <= before + before / 20, "{before} bytes grew to {after}");
    });
}

#[test]
fn deliberate_device_losses_do_not_count_toward_the_limit() {
    let mut record = LossRecord::default();
    let now = Instant::now();
    for _ in 0..100 {
        record.expect_one();
        assert_eq!(record.note(now), LossTolerance::Left);
    }
    assert_eq!(record.total(), 100);
}

#[test]
fn three_device_losses_within_a_minute_exceed_the_limit() {
    let start = Instant::now();
    let after = |seconds| start + Duration::from_secs(seconds);
    let mut record = LossRecord::default();
    for loss in 1..MAX_LOSSES as u64 {
        assert_eq!(record.note(after(loss)), LossTolerance::Left);
    }
    assert_eq!(record.note(after(30)), LossTolerance::Gone);
    record.forgive();
    assert_eq!(record.note(after(31)), LossTolerance::Left);
    assert_eq!(record.note(after(32)), LossTolerance::Left);
    let late = 33 + PATIENCE.as_secs();
    assert_eq!(record.note(after(late)), LossTolerance::Left, "the others are long past");
}

#[test]
fn no_scene_is_drawn_after_too_many_device_losses_until_drawing_is_resumed() {
    use dragonfly_picture::stage::DeviceEvent;
    let Some(mut studio) = studio::studio() else { return };
    let loaded = arm::loaded();
    studio.render(&loaded, &settings()).unwrap();
    let stage = studio.stage();
    for _ in 0..MAX_LOSSES {
        stage.device().assume_lost("a test says so");
        stage.touch_scene();
        stage.whole_frame(Instant::now());
    }
    let events = stage.take_events();
    assert!(matches!(events.last(), Some(DeviceEvent::Paused(_))), "{events:?}");
    assert!(stage.read_scene().is_err(), "the scene stands still");
    stage.resume();
    stage.whole_frame(Instant::now());
    assert!(stage.read_scene().is_ok());
    assert_eq!(stage.device().errors(), 0);
}
