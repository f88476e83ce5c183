//! Loops that are shifted and searched in steps, on a swing whose motion is known.

use super::support::{bone, take};
use dragonfly_anim::data::{Channel, Interpolation, MorphTrack, Skeleton, Take, Track, Transform};
use dragonfly_anim::frames::TakeFrames;
use dragonfly_anim::loops::{
    LoopFinder, LoopSearch, ShiftError, ShiftSettings, find_loop, is_one_frame_short, loop_gaps, shift_loop,
};
use dragonfly_anim::motion::Axis;
use dragonfly_anim::sample::{sample_morph_weights, sample_take};
use dragonfly_kit::random::{Random, seed};
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
    ShiftSettings { by, rate: None, travel: None, up: Axis::Y }
}

fn pose_at(take: &Take, skeleton: &Skeleton, time: f32) -> Vec<Transform> {
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    sample_take(Some(take), skeleton, time, &mut poses);
    poses
}

#[test]
fn a_shifted_loop_shows_what_the_loop_showed_earlier() {
    for (interpolation, tolerance) in
        [(Interpolation::Linear, 1e-5), (Interpolation::Step, 1e-5), (Interpolation::CubicSpline, 1e-5)]
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
    let settings = ShiftSettings { rate: Some(0.0), ..shift(1.0) };
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

/// Returns times from 0.5 s to 2.5 s, sometimes without keys at the ends.
fn random_times(random: &mut Random) -> Vec<f32> {
    let count = 3 + random.below(8);
    let mut times: Vec<f32> = (0..count).map(|_| 0.6 + 1.8 * random.unit()).collect();
    times.extend([0.5, 2.5].into_iter().filter(|_| random.below(3) > 0));
    times.sort_by(f32::total_cmp);
    // Nearer keys are a curve so steep that the rounding of times is seen.
    times.dedup_by(|later, earlier| *later - *earlier < 0.1);
    times
}

/// Returns the values of a channel that ends as it begins, with the tangents of a spline.
fn random_values<T: Copy>(
    random: &mut Random,
    keys: usize,
    interpolation: Interpolation,
    mut value: impl FnMut(&mut Random) -> T,
    mut slope: impl FnMut(&mut Random) -> T,
) -> Vec<T> {
    let mut values: Vec<T> = (0..keys).map(|_| value(random)).collect();
    values[keys - 1] = values[0];
    if interpolation != Interpolation::CubicSpline {
        return values;
    }
    values.into_iter().flat_map(|value| [slope(random), value, slope(random)]).collect()
}

fn random_loop(random: &mut Random) -> Take {
    let kinds = [
        Interpolation::Step,
        Interpolation::Linear,
        Interpolation::CubicSpline,
        Interpolation::CubicSpline,
        Interpolation::Closest,
    ];
    let vector = |random: &mut Random| {
        let mut number = || random.between(-0.3, 0.3);
        Vec3::new(number(), number(), number())
    };
    let rotation = |random: &mut Random| {
        let axis = vector(random).try_normalize().unwrap_or(Vec3::X);
        Quat::from_axis_angle(axis, random.between(-0.6, 0.6))
    };
    let tangent = |random: &mut Random| {
        let mut number = || random.between(-1.0, 1.0);
        Quat::from_xyzw(number(), number(), number(), number())
    };
    let mut track = Track::default();
    let (times, kind) = (random_times(random), random.choice(&kinds));
    let places = random_values(random, times.len(), kind, vector, vector);
    track.translation = Channel::new(times, places, kind);
    let (times, kind) = (random_times(random), random.choice(&kinds));
    let turns = random_values(random, times.len(), kind, rotation, tangent);
    track.rotation = Channel::new(times, turns, kind);
    let (times, interpolation) = (random_times(random), random.choice(&kinds));
    let keys = times.len();
    let weight = |random: &mut Random| 0.5 * random.unit();
    let columns = [0, 1].map(|_| random_values(random, keys, interpolation, weight, weight));
    let weights =
        (0..columns[0].len()).flat_map(|row| [columns[0][row], columns[1][row]]).collect::<Vec<_>>();
    let morphs = vec![MorphTrack {
        instance: 0,
        targets: 2,
        times: times.into(),
        weights: weights.into(),
        interpolation,
    }];
    Take { name: "loop".to_owned(), start: 0.5, length: 2.0, tracks: vec![track], morphs, ..Take::default() }
}

/// Returns whether a switch of steps is near a time.
fn is_at_switch(take: &Take, time: f32) -> bool {
    let track = &take.tracks[0];
    let columns = [
        (&track.translation.times, track.translation.interpolation),
        (&track.rotation.times, track.rotation.interpolation),
        (&take.morphs[0].times, take.morphs[0].interpolation),
    ];
    columns.into_iter().any(|(times, interpolation)| match interpolation {
        Interpolation::Step => times.iter().any(|key| (key - time).abs() < 1e-3),
        Interpolation::Closest => {
            times.windows(2).any(|pair| (0.5 * (pair[0] + pair[1]) - time).abs() < 1e-3)
        }
        Interpolation::Linear | Interpolation::CubicSpline => false,
    })
}

#[test]
fn random_loops_keep_their_motion_and_the_kind_of_their_keys() {
    let skeleton = Skeleton { bones: vec![bone("Hips", None, Vec3::Y)] };
    let mut random = Random::new(seed(71));
    let mut added = 0;
    for round in 0..300 {
        let take = random_loop(&mut random);
        let by = random.between(-3.0, 3.0);
        let shifted = shift_loop(&take, &skeleton, &shift(by)).expect("shifted");
        let (old, new) = (&take.tracks[0], &shifted.tracks[0]);
        assert_eq!(new.translation.interpolation, old.translation.interpolation, "{round}");
        assert_eq!(new.rotation.interpolation, old.rotation.interpolation, "{round}");
        assert_eq!(shifted.morphs[0].interpolation, take.morphs[0].interpolation, "{round}");
        assert_eq!(shifted.range_of_keys(), Some((0.5, 2.5)), "{round}");
        for times in [&new.translation.times, &new.rotation.times, &shifted.morphs[0].times] {
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{round}: {times:?}");
        }
        // One at each end, one at the seam; two more for closest keys.
        assert!(new.translation.len() <= old.translation.len() + 5, "{round}");
        added = added.max(new.rotation.len() as i32 - old.rotation.len() as i32);
        // Each key of before is there, with its tangents.
        let parts = old.translation.values_per_key();
        for (key, &time) in old.translation.times.iter().enumerate() {
            let moved = 0.5 + (time - 0.5 + by).rem_euclid(2.0);
            let is_end = !(0.501..=2.499).contains(&time) || !(0.501..=2.499).contains(&moved);
            let is_edge = key == 0 || key + 1 == old.translation.len();
            if is_end || is_edge {
                continue;
            }
            let at = new.translation.times.iter().position(|new| (new - moved).abs() < 1e-5);
            let at = at.unwrap_or_else(|| panic!("{round}: no key at {moved}"));
            assert_eq!(
                new.translation.values[at * parts..(at + 1) * parts],
                old.translation.values[key * parts..(key + 1) * parts],
                "{round}"
            );
        }
        for step in 0..400 {
            let time = 0.5 + (step as f32 + 0.5) * 0.005;
            let before = 0.5 + (time - 0.5 - by).rem_euclid(2.0);
            if is_at_switch(&take, before) || !(0.501..2.499).contains(&before) {
                continue;
            }
            let (now, was) = (pose_at(&shifted, &skeleton, time)[0], pose_at(&take, &skeleton, before)[0]);
            let apart = now.translation.distance(was.translation);
            let turned = (now.rotation - was.rotation).length().min((now.rotation + was.rotation).length());
            let weights = |take: &Take, time: f32| {
                let mut weights = [0.0; 2];
                sample_morph_weights(Some(take), 0, &[], time, &mut weights);
                glam::Vec2::from_array(weights)
            };
            let weighed = weights(&shifted, time).distance(weights(&take, before));
            assert!(
                apart < 1e-5 && turned < 1e-5 && weighed < 1e-5,
                "{round} by {by} at {time}: {apart} {turned} {weighed}\n{old:?}\n{new:?}"
            );
        }
    }
    println!("at most {added} rotation keys added");
}

#[test]
fn with_a_frame_rate_splines_become_linear_keys_at_every_frame() {
    let (skeleton, take) = swing(Interpolation::CubicSpline);
    let settings = ShiftSettings { rate: Some(30.0), ..shift(0.31) };
    let shifted = shift_loop(&take, &skeleton, &settings).expect("shifted");
    let channel = &shifted.tracks[1].translation;
    assert_eq!((channel.interpolation, channel.len()), (Interpolation::Linear, 61));
}
