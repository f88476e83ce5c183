//! Loops that are shifted and searched in steps, on a swing whose motion is known.

use super::support::{bone, take};
use dragonfly_anim::data::{Channel, Interpolation, Skeleton, Take, Track, Transform};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::loops::{
    LoopFinder, LoopSearch, ShiftError, ShiftSettings, find_loop, is_one_frame_short, loop_gaps, shift_loop,
};
use dragonfly_anim::motion::Axis;
use dragonfly_anim::sample::sample_take;
use glam::{Quat, Vec3};

/// A swing that repeats every 2 s: hips that turn, and a foot with spline keys of translation.
fn swing(interpolation: Interpolation) -> (Skeleton, Take) {
    let skeleton = Skeleton { bones: vec![bone("Hips", None, Vec3::Y), bone("Foot", Some(0), Vec3::NEG_Y)] };
    let angle = |step: usize| std::f32::consts::TAU * step as f32 / 10.0;
    let times: Vec<f32> = (0..=10).map(|step| 0.5 + step as f32 * 0.2).collect();
    let turns: Vec<Quat> = (0..=10).map(|step| Quat::from_rotation_x(0.4 * angle(step).sin())).collect();
    let places = (0..=10).flat_map(|step| {
        let place = Vec3::new(0.1 * angle(step).cos(), -1.0, 0.0);
        let slope = Vec3::new(-0.1 * angle(step).sin() * std::f32::consts::PI, 0.0, 0.0);
        if interpolation == Interpolation::CubicSpline { vec![slope, place, slope] } else { vec![place] }
    });
    let hips =
        Track { rotation: Channel::new(times.clone(), turns, Interpolation::Linear), ..Track::default() };
    let foot = Track {
        translation: Channel::new(times, places.collect::<Vec<_>>(), interpolation),
        ..Track::default()
    };
    (skeleton, take(vec![hips, foot]))
}

fn shift(by: f32) -> ShiftSettings {
    ShiftSettings { by, rate: 30.0, travel: None, up: Axis::Y }
}

fn pose_at(take: &Take, skeleton: &Skeleton, time: f32) -> Vec<Transform> {
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    sample_take(Some(take), skeleton, time, &mut poses);
    poses
}

#[test]
fn a_shifted_loop_shows_what_the_loop_showed_earlier() {
    for (interpolation, tolerance) in
        [(Interpolation::Linear, 1e-5), (Interpolation::Step, 1e-5), (Interpolation::CubicSpline, 2e-3)]
    {
        let (skeleton, take) = swing(interpolation);
        for by in [0.3, -0.3, 0.2, 1.9, 4.7] {
            let shifted = shift_loop(&take, &skeleton, &shift(by)).expect("shifted");
            assert_eq!(shifted.range_of_keys(), take.range_of_keys());
            for step in 0..200 {
                // Not at the times of steps, where rounding decides.
                let time = 0.5 + 0.00501 + step as f32 * 0.0099;
                let before = 0.5 + (time - 0.5 - by).rem_euclid(2.0);
                let (now, was) = (pose_at(&shifted, &skeleton, time), pose_at(&take, &skeleton, before));
                for (now, was) in now.iter().zip(&was) {
                    let apart = now.translation.distance(was.translation);
                    let turned =
                        (now.rotation - was.rotation).length().min((now.rotation + was.rotation).length());
                    assert!(
                        apart < tolerance && turned < 1e-5,
                        "{interpolation:?} by {by} at {time}: {apart} {turned}"
                    );
                }
            }
        }
    }
}

#[test]
fn three_plays_of_a_shifted_loop_have_no_step_that_the_loop_has_not() {
    let (skeleton, take) = swing(Interpolation::Linear);
    let largest = |take: &Take| {
        let place = |frame: usize| {
            let time = 0.5 + (frame as f32 / 60.0).rem_euclid(2.0);
            TakeFrames::of(&Take { start: time, length: 0.0, ..take.clone() }, &skeleton, 60.0)
                .expect("a pose")
                .position(0, 1)
        };
        (0..360).map(|frame| place(frame + 1).distance(place(frame))).fold(0.0, f32::max)
    };
    let before = largest(&take);
    for by in [0.07, 0.9, 1.31] {
        let after = largest(&shift_loop(&take, &skeleton, &shift(by)).expect("shifted"));
        assert!(after <= before + 1e-5, "{by}: {after} of {before}");
    }
}

#[test]
fn the_bone_that_travels_goes_on_across_the_shifted_seam() {
    let skeleton = Skeleton { bones: vec![bone("Hips", None, Vec3::Y)] };
    let places = vec![Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 1.2, 1.0), Vec3::new(0.0, 1.0, 2.0)];
    let track = Track {
        translation: Channel::new(vec![0.0, 1.0, 2.0], places, Interpolation::Linear),
        ..Track::default()
    };
    let walk = take(vec![track]);
    let settings = ShiftSettings { travel: Some(0), ..shift(0.5) };
    let shifted = shift_loop(&walk, &skeleton, &settings).expect("shifted");
    for step in 0..=40 {
        let time = step as f32 * 0.05;
        let place = pose_at(&shifted, &skeleton, time)[0].translation;
        assert!((place.z - (time - 0.5)).abs() < 1e-5, "{time}: {place}");
    }
    let still = shift_loop(&walk, &skeleton, &shift(0.5)).expect("shifted");
    // It does not repeat: from the cut at 1.5 m the way leads to the old start.
    assert_eq!(pose_at(&still, &skeleton, 0.0)[0].translation.z, 1.5);
    assert_eq!(pose_at(&still, &skeleton, 0.5)[0].translation.z, 0.0);
}

#[test]
fn shifts_that_are_none_are_errors_or_change_nothing() {
    let (skeleton, take) = swing(Interpolation::Linear);
    assert_eq!(shift_loop(&take, &skeleton, &shift(0.0)).as_ref(), Ok(&take));
    assert_eq!(shift_loop(&take, &skeleton, &shift(-4.0)).as_ref(), Ok(&take));
    for by in [f32::NAN, f32::INFINITY] {
        assert!(matches!(shift_loop(&take, &skeleton, &shift(by)), Err(ShiftError::By { .. })));
    }
    let pose = Take { length: 0.0, ..take.clone() };
    assert!(matches!(shift_loop(&pose, &skeleton, &shift(1.0)), Err(ShiftError::Range { .. })));
    let settings = ShiftSettings { rate: 0.0, ..shift(1.0) };
    assert!(matches!(shift_loop(&take, &skeleton, &settings), Err(ShiftError::Range { .. })));
    let empty = Take { tracks: vec![Track::default(); 2], ..take };
    assert_eq!(shift_loop(&empty, &skeleton, &shift(0.3)).as_ref(), Ok(&empty));
}

#[test]
fn the_gap_of_a_loop_needs_only_the_frames_at_its_ends() {
    let (skeleton, take) = swing(Interpolation::Linear);
    for length in [2.0, 1.5, 0.1, 0.0] {
        let take = Take { length, ..take.clone() };
        let (all, ends) = (TakeFrames::of(&take, &skeleton, 30.0), TakeFrames::ends(&take, &skeleton, 30.0));
        let (all, ends) = (all.expect("a table"), ends.expect("a table"));
        for (end, all) in loop_gaps(&ends, None, Axis::Y).iter().zip(loop_gaps(&all, None, Axis::Y)) {
            let apart = (end.position - all.position).abs().max((end.rotation - all.rotation).abs());
            assert!(apart < 1e-5 && (end.velocity - all.velocity).abs() < 1e-3, "{length}: {end:?} {all:?}");
        }
        assert_eq!(
            is_one_frame_short(&ends, None, Axis::Y),
            is_one_frame_short(&all, None, Axis::Y),
            "{length}"
        );
    }
    // An end between two frames is the end that is compared.
    let between = TakeFrames::ends(&Take { length: 1.37, ..take.clone() }, &skeleton, 30.0).expect("a table");
    assert!((between.times()[3] - (take.start + 1.37)).abs() < 1e-6);
    assert!(TakeFrames::ends(&take, &skeleton, f32::NAN).is_err());
}

#[test]
fn a_search_in_steps_finds_several_loops_far_from_each_other() {
    let (skeleton, once) = swing(Interpolation::Linear);
    // Three times the swing, the second one a little larger.
    let times: Vec<f32> = (0..=30).map(|step| step as f32 * 0.2).collect();
    let turns: Vec<Quat> = (0..=30)
        .map(|step| {
            let size = if (10..20).contains(&step) { 0.45 } else { 0.4 };
            Quat::from_rotation_x(size * (std::f32::consts::TAU * step as f32 / 10.0).sin())
        })
        .collect();
    let hips = Track { rotation: Channel::new(times, turns, Interpolation::Linear), ..Track::default() };
    let long = take(vec![hips, Track::default()]);
    assert!(long.length > once.length);
    let frames = TakeFrames::of(&long, &skeleton, 30.0).expect("a table");
    let search = LoopSearch { least: 1.0, ..LoopSearch::default() };
    let mut finder = LoopFinder::new(&frames, &search, 6);
    let mut steps = 0;
    while !finder.step(500) {
        steps += 1;
        assert!(steps < 100, "it ends");
    }
    assert!(steps > 10, "{steps}");
    let found = finder.found();
    let best = find_loop(&frames, &search).expect("a loop");
    assert_eq!(found[0].cost, best.cost);
    assert!(found.len() > 2 && found.windows(2).all(|pair| pair[0].cost <= pair[1].cost), "{found:?}");
    for (index, one) in found.iter().enumerate() {
        for other in &found[..index] {
            let near = one.first.abs_diff(other.first) <= 6 && one.last.abs_diff(other.last) <= 6;
            assert!(!near, "{one:?} {other:?}");
        }
    }
    // Whole swings of 60 frames, from any frame.
    assert_eq!((found[0].last - found[0].first) % 60, 0, "{:?}", found[0]);
    let none = LoopSearch { least: 100.0, ..search };
    assert!(LoopFinder::new(&frames, &none, 0).step(1));
}
