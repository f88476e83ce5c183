//! Loops: gaps, the missing last frame, the best range, and closing.

use super::support::{bone, take};
use dragonfly_anim::contact::{Contact, contact_slide};
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Take, Track};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::loops::{
    CloseError, CloseSettings, LoopSearch, close_loop, find_loop, is_one_frame_short, loop_gaps,
};
use dragonfly_anim::motion::Axis;
use glam::{Quat, Vec3};
use std::f32::consts::TAU;

const RATE: f32 = 30.0;

fn arm() -> Skeleton {
    Skeleton {
        bones: vec![
            bone("Hips", None, Vec3::Y),
            bone("Arm", Some(0), Vec3::X * 0.2),
            bone("Hand", Some(1), Vec3::X * 0.5),
        ],
    }
}

/// A take of `frames` frames; the hips are at `place(frame)` and the arm turns by `angle(frame)` about z.
fn made(frames: usize, place: impl Fn(f32) -> Vec3, angle: impl Fn(f32) -> f32) -> Take {
    let times: Vec<f32> = (0..frames).map(|frame| frame as f32 / RATE).collect();
    let places: Vec<Vec3> = (0..frames).map(|frame| Vec3::Y + place(frame as f32)).collect();
    let turns: Vec<Quat> = (0..frames).map(|frame| Quat::from_rotation_z(angle(frame as f32))).collect();
    let hips = Channel::new(times.clone(), places, Interpolation::Linear);
    let arm = Channel::new(times, turns, Interpolation::Linear);
    take(vec![
        Track { translation: hips, ..Track::default() },
        Track { rotation: arm, ..Track::default() },
        Track::default(),
    ])
}

fn swing(frame: f32) -> f32 {
    0.5 * (frame / 30.0 * TAU).sin()
}

fn sampled(take: &Take) -> TakeFrames {
    TakeFrames::of(take, &arm(), RATE).expect("a table")
}

#[test]
fn a_take_that_repeats_has_no_gap_and_travel_is_left_out() {
    let take = made(31, |frame| Vec3::Z * 0.03 * frame, swing);
    for gap in loop_gaps(&sampled(&take), Some(0), Axis::Y) {
        // One step of velocity differs, because the first and the last step are one frame apart.
        assert!(gap.position < 1e-5 && gap.rotation < 1e-5 && gap.velocity < 0.2, "{gap:?}");
    }
    let gap = loop_gaps(&sampled(&take), None, Axis::Y)[2];
    assert!((gap.position - 0.9).abs() < 1e-4, "{gap:?}");
}

#[test]
fn each_gap_has_the_value_computed_on_paper() {
    let take = made(4, |frame| if frame == 3.0 { Vec3::X * 0.5 } else { Vec3::ZERO }, |frame| 0.1 * frame);
    let gaps = loop_gaps(&sampled(&take), None, Axis::Y);
    assert!((gaps[0].position - 0.5).abs() < 1e-6);
    assert!((gaps[0].velocity - 15.0).abs() < 1e-4);
    assert!((gaps[1].rotation - 0.3).abs() < 1e-5);
}

#[test]
fn only_a_take_without_its_last_frame_is_one_frame_short() {
    let short =
        |frames: usize| is_one_frame_short(&sampled(&made(frames, |_| Vec3::ZERO, swing)), None, Axis::Y);
    assert!(short(30));
    assert!(!short(31));
    assert!(!short(29));
    assert!(!short(20));
    assert!(!short(1));
}

#[test]
fn the_loop_of_a_long_take_is_found() {
    // A period of 40 frames between two stretches in which the arm does something else.
    let angle = |frame: f32| match frame as usize {
        0..50 => 0.02 * frame,
        50..130 => {
            1.0 + 0.4 * ((frame - 50.0) / 40.0 * TAU).sin() + 0.2 * ((frame - 50.0) / 20.0 * TAU).cos()
        }
        _ => 1.2 + 0.05 * (frame - 130.0),
    };
    let take = made(200, |frame| Vec3::Z * 0.01 * frame, angle);
    let search = LoopSearch { travel: Some(0), most: 1.5, ..LoopSearch::default() };
    let found = find_loop(&sampled(&take), &search).expect("a loop");
    assert_eq!(found.last - found.first, 40, "{found:?}");
    assert!(found.first >= 50 && found.last <= 130 && found.cost < 0.002, "{found:?}");
    assert_eq!(find_loop(&sampled(&made(10, |_| Vec3::ZERO, swing)), &search), None);
}

#[test]
fn the_loop_of_a_take_of_minutes_is_found_without_comparing_all_pairs() {
    let angle = |frame: f32| {
        0.001 * frame
            + if (3000.0..3090.0).contains(&frame) {
                -0.001 * (frame - 3000.0) + 0.4 * ((frame - 3000.0) / 45.0 * TAU).sin()
            } else {
                0.1 * (frame * frame * 1e-3).sin()
            }
    };
    let take = made(5400, |_| Vec3::ZERO, angle);
    let found =
        find_loop(&sampled(&take), &LoopSearch { least: 1.0, ..LoopSearch::default() }).expect("a loop");
    assert!(found.cost < 0.01, "{found:?}");
}

/// Returns the largest second difference of positions of three plays in a row, in meters: a jump of position or of velocity shows
/// in it.
fn roughness(take: &Take, travel: Vec3) -> f32 {
    let skeleton = arm();
    let frames = TakeFrames::of(take, &skeleton, RATE).expect("a table");
    let mut largest = 0.0_f32;
    for bone in 0..3 {
        let mut row = Vec::new();
        for play in 0..3 {
            let rows = 0..frames.len() - 1;
            row.extend(rows.map(|frame| frames.position(frame, bone) + travel * play as f32));
        }
        let bends = row.windows(3).map(|at| (at[2] - 2.0 * at[1] + at[0]).length());
        largest = bends.fold(largest, f32::max);
    }
    largest
}

#[test]
fn three_plays_in_a_row_of_a_closed_loop_show_no_jump() {
    let take = made(41, |frame| Vec3::Y * 0.004 * frame, |frame| 0.02 * frame + swing(frame));
    assert!(roughness(&take, Vec3::ZERO) > 0.1);
    let settings = CloseSettings { rate: RATE, frames: 20, travel: None, up: Axis::Y };
    let closed = close_loop(&take, &arm(), &[], &settings).expect("closed");
    let rough = roughness(&closed, Vec3::ZERO);
    // The swing itself bends the way by 17 mm per frame².
    assert!(rough < 0.025, "{rough}");
    for gap in loop_gaps(&sampled(&closed), None, Axis::Y) {
        assert!(gap.position < 1e-5 && gap.rotation < 1e-5, "{gap:?}");
    }
    let (before, after) = (sampled(&take), sampled(&closed));
    for frame in 0..20 {
        assert_eq!(before.position(frame, 2), after.position(frame, 2), "frame {frame}");
    }
}

#[test]
fn the_bone_that_travels_keeps_its_way() {
    let take = made(41, |frame| Vec3::new(0.0, 0.002 * frame, 0.03 * frame), swing);
    let settings = CloseSettings { rate: RATE, frames: 12, travel: Some(0), up: Axis::Y };
    let closed = close_loop(&take, &arm(), &[], &settings).expect("closed");
    let end = sampled(&closed).position(40, 0);
    assert!((end - Vec3::new(0.0, 1.0, 1.2)).length() < 1e-5, "{end}");
    assert!(roughness(&closed, Vec3::Z * 1.2) < 0.03);
}

#[test]
fn a_loop_that_is_closed_already_keeps_its_keys_bit_for_bit() {
    let hold = made(31, |_| Vec3::ZERO, |_| 0.3);
    let settings = CloseSettings { rate: RATE, frames: 10, travel: None, up: Axis::Y };
    assert_eq!(close_loop(&hold, &arm(), &[], &settings), Ok(hold));
}

#[test]
fn contacts_are_kept_while_a_loop_is_closed() {
    let take = made(41, |_| Vec3::ZERO, |frame| if frame < 25.0 { 0.01 * frame } else { 0.25 });
    let contact = Contact { bone: 2, from: 26.0 / RATE, to: 36.0 / RATE };
    let settings = CloseSettings { rate: RATE, frames: 14, travel: None, up: Axis::Y };
    let slide = |contacts: &[Contact]| {
        let closed = close_loop(&take, &arm(), contacts, &settings).expect("closed");
        contact_slide(&sampled(&closed), &contact, Axis::Z, 1.0).millimeters
    };
    assert!(slide(&[]) > 20.0);
    assert!(slide(&[contact]) < 2.0, "{} {}", slide(&[contact]), slide(&[]));
}

#[test]
fn a_window_without_frames_or_longer_than_the_take_is_an_error() {
    let take = made(31, |_| Vec3::ZERO, swing);
    for (rate, frames) in [(30.0, 0), (30.0, 32), (0.0, 5), (f32::NAN, 5)] {
        let settings = CloseSettings { rate, frames, travel: None, up: Axis::Y };
        assert!(matches!(close_loop(&take, &arm(), &[], &settings), Err(CloseError::Range { .. })));
    }
}
