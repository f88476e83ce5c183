//! Contacts of feet: detection, slide and locking, on a leg whose motion is known and on models of others.

use super::support::{bone, take};
use dragonfly_anim::contact::{
    Contact, ContactThresholds, LockError, LockSettings, contact_slide, detect_contacts, feet_by_name,
    lock_contacts, take_slide,
};
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Take, Track};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use dragonfly_anim::frames::{FramesError, TakeFrames, frame_rate};
use dragonfly_anim::motion::Axis;
use glam::{Quat, Vec3};

const RATE: f32 = 30.0;
const FOOT: u32 = 3;

/// Hips at a height of 0.9, and a leg of two parts of 0.45 that is slightly bent.
pub(crate) fn leg() -> Skeleton {
    Skeleton {
        bones: vec![
            bone("Hips", None, Vec3::new(0.0, 0.88, 0.0)),
            bone("Thigh.L", Some(0), Vec3::ZERO),
            bone("Shin.L", Some(1), Vec3::new(0.0, -0.44, 0.05)),
            bone("Foot.L", Some(2), Vec3::new(0.0, -0.44, -0.05)),
        ],
    }
}

/// The hips move along z at `speed(frame)` meters per frame, and down again by `height(frame)`.
fn moved(frames: usize, place: impl Fn(usize) -> Vec3) -> Take {
    let times: Vec<f32> = (0..frames).map(|frame| frame as f32 / RATE).collect();
    let values: Vec<Vec3> = (0..frames).map(|frame| Vec3::new(0.0, 0.88, 0.0) + place(frame)).collect();
    let hips = Track { translation: Channel::new(times, values, Interpolation::Linear), ..Track::default() };
    take(vec![hips, Track::default(), Track::default(), Track::default()])
}

/// Still for 20 frames, up and forward for 10, still for 20. While it is still it drifts by 2 mm per frame.
pub(crate) fn step() -> Take {
    moved(50, |frame| match frame {
        0..20 => Vec3::Z * 0.002 * frame as f32,
        20..30 => {
            let part = (frame - 19) as f32 / 11.0;
            Vec3::new(0.0, 0.2 * (part * std::f32::consts::PI).sin(), 0.038 + 0.5 * part)
        }
        _ => Vec3::Z * (0.538 + 0.002 * (frame - 30) as f32),
    })
}

fn sampled(take: &Take, skeleton: &Skeleton, rate: f32) -> TakeFrames {
    TakeFrames::of(take, skeleton, rate).expect("a table")
}

#[test]
fn a_contact_lasts_while_the_foot_is_low_and_slow() {
    let (skeleton, take) = (leg(), step());
    let frames = sampled(&take, &skeleton, RATE);
    let found = detect_contacts(&frames, &[FOOT, 77], &ContactThresholds::default());
    let in_frames = |contact: &Contact| (frames.frame_at(contact.from), frames.frame_at(contact.to));
    assert_eq!(found.iter().map(in_frames).collect::<Vec<_>>(), [(0, 18), (31, 49)]);
}

#[test]
fn a_speed_that_oscillates_about_the_lower_threshold_does_not_split_a_contact() {
    let skeleton = leg();
    // Speeds of 0.06 and 0.24 m/s in turn, on both sides of 0.15 m/s.
    let place = |frame: usize| {
        Vec3::Z * (0..frame).map(|at| if at / 3 % 2 == 0 { 0.002 } else { 0.008 }).sum::<f32>()
    };
    let frames = sampled(&moved(40, place), &skeleton, RATE);
    let thresholds = ContactThresholds::default();
    assert_eq!(detect_contacts(&frames, &[FOOT], &thresholds).len(), 1);
    let without = ContactThresholds { leave_speed: thresholds.enter_speed, least: 0.0, ..thresholds };
    assert!(detect_contacts(&frames, &[FOOT], &without).len() > 3);
}

#[test]
fn contacts_that_are_too_short_or_too_high_are_dropped() {
    let (skeleton, take) = (leg(), step());
    let frames = sampled(&take, &skeleton, RATE);
    let long = ContactThresholds { least: 0.7, ..ContactThresholds::default() };
    assert!(detect_contacts(&frames, &[FOOT], &long).is_empty());
    let deep = ContactThresholds { ground: Some(-0.1), ..ContactThresholds::default() };
    assert!(detect_contacts(&frames, &[FOOT], &deep).is_empty());
}

#[test]
fn a_reversed_take_has_the_reversed_contacts() {
    let skeleton = leg();
    let place = |frame: usize| Vec3::Z * 0.0002 * (frame * frame) as f32;
    let forth = sampled(&moved(40, place), &skeleton, RATE);
    let back = sampled(&moved(40, |frame| place(39 - frame)), &skeleton, RATE);
    let ends = |frames: &TakeFrames| {
        let found = detect_contacts(frames, &[FOOT], &ContactThresholds::default());
        assert_eq!(found.len(), 1);
        (frames.frame_at(found[0].from), frames.frame_at(found[0].to))
    };
    let ((first, last), (from, to)) = (ends(&forth), ends(&back));
    assert_eq!((first, last), (39 - to, 39 - from));
}

#[test]
fn slide_is_the_length_of_the_way_on_the_ground() {
    let (skeleton, take) = (leg(), step());
    let frames = sampled(&take, &skeleton, RATE);
    let contact = Contact { bone: FOOT, from: 0.0, to: 18.0 / RATE };
    let slide = contact_slide(&frames, &contact, Axis::Y, 1.0);
    assert!((slide.millimeters - 36.0).abs() < 0.01, "{slide:?}");
    assert!((slide.drift - 36.0).abs() < 0.01, "{slide:?}");
    let whole = take_slide(&frames, &[contact, contact], Axis::Y, 1.0);
    assert!((whole.millimeters_per_second() - 60.0).abs() < 0.05, "{whole:?}");
    assert_eq!(take_slide(&frames, &[], Axis::Y, 1.0).millimeters_per_second(), 0.0);
    let none = contact_slide(&frames, &Contact { bone: 99, ..contact }, Axis::Y, 1.0);
    assert_eq!(none.millimeters, 0.0);
}

/// Returns the largest slide of a contact in mm, measured at four times the rate, so that motion between keys counts.
fn largest_slide(take: &Take, skeleton: &Skeleton, contacts: &[Contact], unit: f32) -> f32 {
    let frames = sampled(take, skeleton, 4.0 * RATE);
    let each = contacts.iter().map(|contact| contact_slide(&frames, contact, Axis::Y, unit).millimeters);
    each.fold(0.0, f32::max)
}

#[test]
fn a_locked_foot_slides_less_than_two_millimeters_and_nothing_changes_far_from_its_contacts() {
    let (skeleton, take) = (leg(), step());
    let contacts = detect_contacts(&sampled(&take, &skeleton, RATE), &[FOOT], &ContactThresholds::default());
    assert!(largest_slide(&take, &skeleton, &contacts, 1.0) > 30.0);
    let locked =
        lock_contacts(&take, &skeleton, &contacts, &LockSettings { rate: RATE, ease: 4 }).expect("locked");
    let slide = largest_slide(&locked.take, &skeleton, &contacts, 1.0);
    assert!(slide < 2.0, "{slide} mm");
    assert!(locked.farthest < 1e-4, "{}", locked.farthest);
    assert_eq!(locked.bones, [1, 2, 3]);
    assert_eq!(locked.take.tracks[0], take.tracks[0]);
    let (before, after) = (sampled(&take, &skeleton, RATE), sampled(&locked.take, &skeleton, RATE));
    for frame in 23..27 {
        // Rotations of the keys at both ends of the gap are computed, so the last digit may differ.
        let distance = before.position(frame, FOOT).distance(after.position(frame, FOOT));
        assert!(distance < 1e-6, "frame {frame}: {distance}");
    }
}

#[test]
fn a_locked_foot_does_not_jump_where_the_correction_fades() {
    let (skeleton, take) = (leg(), step());
    let contacts = detect_contacts(&sampled(&take, &skeleton, RATE), &[FOOT], &ContactThresholds::default());
    let locked =
        lock_contacts(&take, &skeleton, &contacts, &LockSettings { rate: RATE, ease: 4 }).expect("locked");
    let (before, after) = (sampled(&take, &skeleton, RATE), sampled(&locked.take, &skeleton, RATE));
    for frame in 0..49 {
        let step = |frames: &TakeFrames| frames.position(frame + 1, FOOT) - frames.position(frame, FOOT);
        // The correction of at most 18 mm fades over four frames: no step differs by half of it.
        let difference = (step(&after) - step(&before)).length();
        assert!(difference < 0.009, "frame {frame}: {difference}");
    }
}

#[test]
fn a_foot_keeps_its_direction_while_it_is_locked() {
    let (skeleton, take) = (leg(), step());
    let contact = Contact { bone: FOOT, from: 0.0, to: 0.6 };
    let locked =
        lock_contacts(&take, &skeleton, &[contact], &LockSettings { rate: RATE, ease: 0 }).expect("locked");
    let frames = sampled(&locked.take, &skeleton, RATE);
    for frame in 0..18 {
        let whole = (1..=3).fold(Quat::IDENTITY, |sum, bone| sum * frames.pose(frame, bone).rotation);
        assert!(whole.angle_between(Quat::IDENTITY) < 1e-3, "frame {frame}: {whole}");
    }
}

#[test]
fn limbs_that_share_bones_are_locked_alike_whatever_the_order_of_the_bones() {
    let place = |name: &str| Vec3::new(if name == "a" { 0.1 } else { -0.2 }, -0.44, -0.05);
    let rotations = |[first, second]: [&str; 2]| {
        let skeleton = Skeleton {
            bones: vec![
                bone("Thigh", None, Vec3::new(0.0, 0.88, 0.0)),
                bone("Shin", Some(0), Vec3::new(0.0, -0.44, 0.05)),
                bone(first, Some(1), place(first)),
                bone(second, Some(1), place(second)),
            ],
        };
        let span = |name: &str| if name == "a" { (0.1, 0.2) } else { (0.15, 0.4) };
        let contact =
            |(index, name): (u32, &str)| Contact { bone: index, from: span(name).0, to: span(name).1 };
        let contacts = [(2, first), (3, second)].map(contact);
        let take = moved(20, |frame| Vec3::Z * 0.01 * frame as f32);
        let settings = LockSettings { rate: RATE, ease: 2 };
        let locked = lock_contacts(&take, &skeleton, &contacts, &settings).expect("locked");
        let rotation = |name: &str| {
            let index = skeleton.find(name).expect("a bone");
            locked.take.tracks[index as usize].rotation.clone()
        };
        ["Thigh", "Shin", "a", "b"].map(rotation)
    };
    assert_eq!(rotations(["a", "b"]), rotations(["b", "a"]));
}

#[test]
fn spline_keys_of_a_leg_are_locked_like_linear_ones() {
    let (skeleton, mut take) = (leg(), step());
    let zero = Quat::from_array([0.0; 4]);
    let turned = Quat::from_rotation_x(0.1);
    take.tracks[1].rotation = Channel::new(
        vec![0.0, 1.6],
        vec![zero, Quat::IDENTITY, zero, zero, turned, zero],
        Interpolation::CubicSpline,
    );
    let contacts = [Contact { bone: FOOT, from: 0.0, to: 0.6 }];
    let locked =
        lock_contacts(&take, &skeleton, &contacts, &LockSettings { rate: RATE, ease: 4 }).expect("locked");
    let slide = largest_slide(&locked.take, &skeleton, &contacts, 1.0);
    assert!(slide < 2.0, "{slide} mm");
    let (before, after) = (sampled(&take, &skeleton, RATE), sampled(&locked.take, &skeleton, RATE));
    for frame in 24..49 {
        let distance = before.position(frame, FOOT).distance(after.position(frame, FOOT));
        assert!(distance < 1e-4, "frame {frame}: {distance}");
    }
}

#[test]
fn an_anchor_out_of_reach_is_reported_with_its_distance() {
    let skeleton = leg();
    let take = moved(30, |frame| Vec3::Z * 0.05 * frame as f32);
    let contact = Contact { bone: FOOT, from: 0.0, to: 29.0 / RATE };
    let locked =
        lock_contacts(&take, &skeleton, &[contact], &LockSettings { rate: RATE, ease: 4 }).expect("locked");
    assert!(locked.farthest > 0.1, "{}", locked.farthest);
}

#[test]
fn contacts_without_a_limb_and_rates_that_are_none_are_errors() {
    let (skeleton, take) = (leg(), step());
    let settings = LockSettings { rate: RATE, ease: 4 };
    for bone in [0, 1, 40] {
        let contact = Contact { bone, from: 0.0, to: 0.5 };
        assert_eq!(lock_contacts(&take, &skeleton, &[contact], &settings), Err(LockError::NoLimb { bone }));
    }
    for rate in [0.0, -1.0, f32::NAN, f32::INFINITY, 1e30] {
        let settings = LockSettings { rate, ..settings };
        assert!(matches!(lock_contacts(&take, &skeleton, &[], &settings), Err(LockError::Rate { .. })));
    }
    assert_eq!(TakeFrames::of(&take, &skeleton, 0.0), Err(FramesError::Rate { rate: 0.0 }));
    assert!(matches!(TakeFrames::of(&take, &skeleton, 1e9), Err(FramesError::TooMany { .. })));
}

#[test]
fn the_frame_rate_of_a_take_is_the_lowest_that_fits_its_keys() {
    assert_eq!(frame_rate(&step()), 30.0);
    assert_eq!(frame_rate(&Take::default()), 30.0);
    let at = |times: Vec<f32>| {
        let values = vec![Vec3::ZERO; times.len()];
        let moving = Channel::new(times, values, Interpolation::Linear);
        frame_rate(&take(vec![Track { translation: moving, ..Track::default() }]))
    };
    assert_eq!(at(vec![0.0, 1.0 / 24.0, 1.0]), 24.0);
    assert_eq!(at(vec![0.5, 0.5 + 1.0 / 60.0, 1.5]), 60.0);
    assert_eq!(at(vec![0.0, 0.123_456, 1.0]), 30.0);
}

#[test]
fn feet_are_found_by_their_names() {
    assert_eq!(feet_by_name(&leg()), [FOOT]);
    let mut skeleton = leg();
    skeleton.bones.push(bone("FootToes.L", Some(3), Vec3::Z));
    skeleton.bones.push(bone("Foot_IK.L", Some(2), Vec3::Z));
    skeleton.bones.push(bone("footstool", None, Vec3::Z));
    assert_eq!(feet_by_name(&skeleton), [FOOT]);
    let fox = include_bytes!("../data/gltf/Fox.glb");
    let model = read("Fox.glb", fox, &NoFiles, &ReadOptions::default()).expect("the fox").model;
    let skeleton = &model.animation.skeleton;
    let names: Vec<&str> =
        feet_by_name(skeleton).iter().map(|&foot| skeleton.bones[foot as usize].name.as_str()).collect();
    assert_eq!(names, ["b_LeftFoot01_017", "b_RightFoot01_021"]);
}

#[test]
fn a_take_with_numbers_that_are_none_is_an_error_or_unchanged() {
    let (skeleton, settings) = (leg(), LockSettings { rate: RATE, ease: 4 });
    let contact = Contact { bone: FOOT, from: 0.1, to: 0.5 };
    for (start, length) in [(f32::NAN, 1.0), (0.0, f32::NAN), (0.0, -1.0), (f32::INFINITY, 1.0)] {
        let take = Take { start, length, ..step() };
        if let Ok(locked) = lock_contacts(&take, &skeleton, &[contact], &settings) {
            let values = locked.take.tracks.iter().flat_map(|track| track.rotation.values.to_vec());
            assert!(values.into_iter().all(Quat::is_finite), "{start} {length}");
        }
    }
}
