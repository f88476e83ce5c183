//! Contacts as a track of a take: they stay in order and apart, and follow edits of time. Slide that is measured in steps.

use super::support::{bone, take};
use dragonfly_anim::contact::{Contact, ContactTrack, SlideMeter, contact_slide};
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Take, Track};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::motion::Axis;
use glam::{Quat, Vec3};

fn contact(bone: u32, from: f32, to: f32) -> Contact {
    Contact { bone, from, to }
}

fn spans(track: &ContactTrack) -> Vec<(u32, f32, f32)> {
    track.contacts().iter().map(|contact| (contact.bone, contact.from, contact.to)).collect()
}

fn track() -> ContactTrack {
    ContactTrack::of([contact(5, 0.5, 1.0), contact(2, 1.5, 2.0), contact(2, 0.0, 0.5)])
}

#[test]
fn contacts_of_a_bone_are_in_order_and_those_that_overlap_are_one() {
    let joined = ContactTrack::of([
        contact(2, 0.75, 1.0),
        contact(2, 0.0, 0.5),
        contact(2, 0.5, 0.625),
        contact(2, 0.25, 0.375),
        contact(1, 3.0, 4.0),
        contact(1, 2.0, 2.0),
        contact(1, 2.0, 1.0),
        contact(1, f32::NAN, 1.0),
        contact(1, 0.0, f32::INFINITY),
    ]);
    assert_eq!(spans(&joined), [(1, 3.0, 4.0), (2, 0.0, 0.625), (2, 0.75, 1.0)]);
    assert_eq!(joined.bones(), [1, 2]);
    assert_eq!(joined.of_bone(2).len(), 2);
    assert!(joined.of_bone(7).is_empty());
    assert!(ContactTrack::of([]).is_empty());
}

#[test]
fn contacts_of_some_bones_are_replaced_and_the_others_stay() {
    let replaced = track().replaced(&[2], [contact(2, 3.0, 3.5)]);
    assert_eq!(spans(&replaced), [(2, 3.0, 3.5), (5, 0.5, 1.0)]);
    assert_eq!(spans(&track().replaced(&[2, 5], [])), []);
}

#[test]
fn contacts_follow_retiming_reversing_and_cutting() {
    assert_eq!(
        spans(&track().remapped(|time| 1.0 + 2.0 * time)),
        [(2, 1.0, 2.0), (2, 4.0, 5.0), (5, 2.0, 3.0)]
    );
    assert_eq!(spans(&track().remapped(|time| 2.0 - time)), [(2, 0.0, 0.5), (2, 1.5, 2.0), (5, 1.0, 1.5)]);
    assert_eq!(spans(&track().between(0.25, 1.75)), [(2, 0.25, 0.5), (2, 1.5, 1.75), (5, 0.5, 1.0)]);
    assert_eq!(spans(&track().between(0.5, 0.5)), []);
}

#[test]
fn time_that_is_inserted_or_removed_moves_what_follows() {
    assert_eq!(spans(&track().rippled(0.75, 1.0)), [(2, 0.0, 0.5), (2, 2.5, 3.0), (5, 0.5, 2.0)]);
    // The half second before 1.0 s is removed.
    assert_eq!(spans(&track().rippled(1.0, -0.5)), [(2, 0.0, 0.5), (2, 1.0, 1.5)]);
    assert_eq!(spans(&track().rippled(1.75, -0.5)), [(2, 0.0, 0.5), (2, 1.25, 1.5), (5, 0.5, 1.0)]);
}

#[test]
fn mirrored_contacts_belong_to_the_other_bone() {
    let mirrored = track().mirrored(|bone| match bone {
        2 => Some(5),
        5 => Some(2),
        _ => None,
    });
    assert_eq!(spans(&mirrored), [(2, 0.5, 1.0), (5, 0.0, 0.5), (5, 1.5, 2.0)]);
    assert_eq!(track().mirrored(|_| None), track());
}

#[test]
fn contacts_that_move_around_a_loop_continue_at_its_start() {
    assert_eq!(spans(&track().shifted(0.0, 2.0, 0.25)), [(2, 0.0, 0.75), (2, 1.75, 2.0), (5, 0.75, 1.25)]);
    // All the way around.
    assert_eq!(spans(&track().shifted(0.0, 2.0, 2.0)), spans(&track()));
    assert_eq!(track().shifted(0.0, 0.0, 1.0), track());
    assert_eq!(track().shifted(0.0, 2.0, f32::NAN), track());
}

/// Hips that swing, and a foot below them.
fn swing() -> (Skeleton, Take) {
    let skeleton = Skeleton {
        bones: vec![bone("Hips", None, Vec3::Y), bone("Foot", Some(0), Vec3::new(0.0, -0.9, 0.1))],
    };
    let times: Vec<f32> = (0..61).map(|frame| frame as f32 / 30.0).collect();
    let turns: Vec<Quat> =
        (0..61).map(|frame| Quat::from_rotation_x(0.01 * (frame * frame % 7) as f32)).collect();
    let track = Track { rotation: Channel::new(times, turns, Interpolation::Linear), ..Track::default() };
    (skeleton, take(vec![track, Track::default()]))
}

#[test]
fn slide_measured_in_steps_is_that_of_the_whole_table_of_poses() {
    let (skeleton, take) = swing();
    let frames = TakeFrames::of(&take, &skeleton, 30.0).expect("frames");
    let contacts = [contact(1, 0.0, 0.5), contact(1, 0.7, 1.0), contact(1, 1.2, 2.0)];
    let speed = |contact: &Contact| {
        contact_slide(&frames, contact, Axis::Y, 1.0).millimeters / (contact.to - contact.from)
    };
    let worst = contacts.iter().map(speed).fold(0.0, f32::max);
    for step in [1, 7, 1000] {
        let mut meter = SlideMeter::new(&contacts, 30.0, Axis::Y, 1.0);
        let mut steps = 0;
        while !meter.step(&take, &skeleton, step) {
            steps += 1;
            assert!(steps < 100, "it ends");
        }
        // 16, 10 and 25 samples.
        assert_eq!(steps, 50 / step, "a step is no larger than it was allowed");
        let found = meter.worst().expect("the worst");
        assert!((found.millimeters_per_second - worst).abs() < 0.01 * worst, "{found:?}, {worst}");
        assert!((speed(&found.contact) - worst).abs() < 1e-6);
    }
    assert!(SlideMeter::new(&[], 30.0, Axis::Y, 1.0).step(&take, &skeleton, 1));
    let mut strange = SlideMeter::new(&[contact(9, 0.0, 1.0)], f32::NAN, Axis::Y, 1.0);
    assert!(strange.step(&take, &skeleton, 1000));
    assert_eq!(strange.worst().map(|worst| worst.millimeters_per_second), Some(0.0));
}
