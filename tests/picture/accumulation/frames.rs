//! A frame is the same bytes whatever was drawn before it, and whatever happens to the device.

use super::still;
use dragonfly_document::{FaultInjection, FaultPlan};
use dragonfly_kit::document::arm;
use dragonfly_kit::picture::images::settings;
use dragonfly_kit::picture::studio;
use dragonfly_picture::{DeviceParameters, FrameSampling, PictureSettings, Studio};
use image::RgbaImage;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Returns a small frame of the bending arm.
fn frame(studio: &mut Studio, time: f32, sampling: FrameSampling) -> RgbaImage {
    let settings = PictureSettings { size: [80, 60], time, sampling, ..settings() };
    studio.render(&arm::loaded(), &settings).expect("an image")
}

fn moving(samples: u32) -> FrameSampling {
    FrameSampling { samples, ..FrameSampling::default() }
}

#[test]
fn one_sub_frame_is_drawn_as_ever_whatever_its_shutter() {
    let Some(mut studio) = studio::studio() else { return };
    let plain = frame(&mut studio, 0.4, FrameSampling::default());
    let open = FrameSampling { samples: 1, shutter: 360.0, ..FrameSampling::default() };
    assert!(frame(&mut studio, 0.4, open) == plain);
    let several = frame(&mut studio, 0.4, moving(4));
    assert!(several != plain, "several sub-frames are blurred");
    assert!(frame(&mut studio, 0.4, still(0)) == plain, "none counts as one, also after several");
    assert!(frame(&mut studio, 0.4, moving(4)) == several);
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn frames_are_the_same_in_any_order_and_in_another_studio() {
    let Some(mut studio) = studio::studio() else { return };
    let times = [0.1, 0.4, 0.8];
    let [third, first, second] =
        [times[2], times[0], times[1]].map(|time| frame(&mut studio, time, moving(4)));
    let Some(mut other) = studio::studio() else { return };
    let again = times.map(|time| frame(&mut other, time, moving(4)));
    assert!([first, second, third] == again);
    assert!(again[0] != again[1] && again[1] != again[2]);
}

/// Loses the device in the middle of a frame when a test sets it.
#[derive(Debug, Default)]
struct LoseInFrame(AtomicBool);

impl FaultPlan for LoseInFrame {
    fn loses_device_in_frame(&self, sub_frame: u32) -> bool {
        sub_frame == 2 && self.0.swap(false, Ordering::Relaxed)
    }
}

#[test]
fn a_device_lost_in_the_middle_of_a_frame_changes_nothing() {
    let plan = Arc::new(LoseInFrame::default());
    let faults = FaultInjection::new(Arc::clone(&plan) as Arc<dyn FaultPlan>);
    let parameters = DeviceParameters { faults, ..DeviceParameters::default() };
    let Some(mut studio) = studio::studio_with(parameters) else { return };
    let before = frame(&mut studio, 0.4, moving(4));
    plan.0.store(true, Ordering::Relaxed);
    let after = frame(&mut studio, 0.4, moving(4));
    assert_eq!(studio.stage().device().losses(), 1, "the device was lost");
    assert!(before == after);
    assert_eq!(studio.stage().device().errors(), 0);
}
