//! Contacts that are held after a take was smoothed: in motion capture, feet stay where they were planted.

use crate::retarget_figure::captured;
use dragonfly_anim::contact::{
    Contact, ContactThresholds, LockSettings, contact_slide, detect_contacts, feet_by_name, hold_contacts,
    lock_contacts,
};
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::inbetween::{KeyFilter, UniformTimes, filter_keys};
use dragonfly_anim::motion::Axis;
use dragonfly_anim::sample::sample_channel;
use glam::{Quat, Vec3};

/// Meters in a unit of the captures of Carnegie Mellon University: inches divided by 0.45.
const METERS: f32 = 0.0254 / 0.45;
const RATE: f32 = 30.0;
const SETTINGS: LockSettings = LockSettings { rate: RATE, ease: 4 };

/// Returns a take with all channels smoothed by a Gaussian of 0.1 s.
fn smoothed(take: &Take) -> Take {
    let filter = KeyFilter::Gaussian { sigma: 0.1 };
    let mut smooth = take.clone();
    for track in &mut smooth.tracks {
        let channel = track.translation.clone();
        let uniform = UniformTimes::over(&channel.times, None);
        let at = |time: f32| sample_channel(&channel, Vec3::ZERO, time);
        if let Some(values) = filter_keys(&channel.times, &channel.values, filter, uniform, at) {
            track.translation.values = values.into();
        }
        let channel = track.rotation.clone();
        let uniform = UniformTimes::over(&channel.times, None);
        let at = |time: f32| sample_channel(&channel, Quat::IDENTITY, time);
        if let Some(values) = filter_keys(&channel.times, &channel.values, filter, uniform, at) {
            track.rotation.values = values.into();
        }
    }
    smooth
}

/// Returns the largest slide of a contact, millimeters.
fn slide(take: &Take, skeleton: &Skeleton, contacts: &[Contact]) -> f32 {
    let frames = TakeFrames::of(take, skeleton, RATE).expect("frames");
    let slides = contacts.iter().map(|contact| contact_slide(&frames, contact, Axis::Y, METERS).drift);
    slides.fold(0.0, f32::max)
}

#[test]
fn feet_of_smoothed_motion_capture_are_held_within_2_mm() {
    let Some((skeleton, captured)) = captured() else { return };
    let frames = TakeFrames::of(&captured, &skeleton, RATE).expect("frames");
    let thresholds = ContactThresholds { meters_per_unit: METERS, ..ContactThresholds::default() };
    let contacts = detect_contacts(&frames, &feet_by_name(&skeleton), &thresholds);
    assert!(contacts.len() >= 10, "{contacts:?}");
    let take = lock_contacts(&captured, &skeleton, &contacts, &SETTINGS).expect("locked").take;
    let smooth = smoothed(&take);
    let held = hold_contacts(&smooth, &take, &skeleton, &contacts, &SETTINGS).expect("held");
    let [before, free, after] = [&take, &smooth, &held.take].map(|take| slide(take, &skeleton, &contacts));
    println!(
        "planted {before} mm, smoothed {free} mm, held {after} mm, out of reach {}",
        held.farthest * METERS
    );
    assert!(before < 2.0 && free > 10.0 && after < 2.0, "{before} {free} {after}");
    // They are where they were, not only still.
    let [was, now] = [&take, &held.take].map(|take| TakeFrames::of(take, &skeleton, RATE).expect("frames"));
    for contact in &contacts {
        let middle = ((contact.from + contact.to) / 2.0 * RATE) as usize;
        let away = was.position(middle, contact.bone).distance(now.position(middle, contact.bone));
        assert!(1000.0 * METERS * away < 2.0, "{contact:?}: {away}");
    }
    // A take that was not changed stays as it is.
    let same = hold_contacts(&take, &take, &skeleton, &contacts, &SETTINGS).expect("held");
    assert_eq!((same.take, same.bones), (take.clone(), Vec::new()));
    let nobody = [Contact { bone: 1000, from: 0.0, to: 1.0 }];
    assert_eq!(hold_contacts(&smooth, &take, &skeleton, &nobody, &SETTINGS).expect("nothing").take, smooth);
}
