//! A take with layers is, at any time, what blending their poses gives; a channel that no layer moves is shared.

use crate::support::{about_z, along_x, angle_between, animation_data, bone, take};
use dragonfly_anim::blend::{add_to, mix_poses};
use dragonfly_anim::data::{AnimationData, Channel, Interpolation, Skeleton, Take, Track, Transform};
use dragonfly_anim::layers::{
    AddedKeys, LayerChannel, LayerMode, LayerRule, LayerSettings, RotationRule, ScaleRule, TakeLayer,
    TranslationRule, WeightKey, flatten, flatten_channel, flatten_with, key_for, seen,
};
use dragonfly_anim::sample::{rest_pose, sample_channel};
use dragonfly_kit::random::{Random, seed};
use glam::{Quat, Vec3};
use std::sync::Arc;

const KINDS: [Interpolation; 4] =
    [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline, Interpolation::Closest];

fn times(random: &mut Random, most: usize) -> Vec<f32> {
    let mut times: Vec<f32> = (0..random.below(most + 1)).map(|_| random.below(40) as f32 * 0.05).collect();
    times.sort_by(f32::total_cmp);
    times.dedup();
    times
}

fn turn(random: &mut Random, angle: f32) -> Quat {
    let axis = Vec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0))).normalize_or(Vec3::X);
    Quat::from_axis_angle(axis, random.between(0.0, angle))
}

fn channel<T: Copy>(
    random: &mut Random,
    most: usize,
    zero: T,
    value: impl Fn(&mut Random) -> T,
) -> Channel<T> {
    let (times, kind) = (times(random, most), random.choice(&KINDS));
    // Splines without slope: their tangents are tested where they have one.
    let a_key = |random: &mut Random| match kind {
        Interpolation::CubicSpline => vec![zero, value(random), zero],
        _ => vec![value(random)],
    };
    let values: Vec<T> = times.iter().flat_map(|_| a_key(random)).collect();
    Channel { times: times.into(), values: values.into(), interpolation: kind }
}

fn track(random: &mut Random, most: usize, angle: f32) -> Track {
    let place = |random: &mut Random| Vec3::from_array([(); 3].map(|()| random.between(-1.0, 1.0)));
    let scale = |random: &mut Random| Vec3::from_array([(); 3].map(|()| random.between(0.5, 1.5)));
    Track {
        bone: 0,
        translation: channel(random, most, Vec3::ZERO, place),
        rotation: channel(random, most, Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), |random| turn(random, angle)),
        scale: channel(random, most, Vec3::ZERO, scale),
    }
}

fn settings(random: &mut Random) -> LayerSettings {
    let mode = random.choice(&[LayerMode::Additive, LayerMode::Override]);
    let weight = |random: &mut Random| random.choice(&[0.0, 0.25, 0.7, 1.0]);
    let weights =
        times(random, 2).into_iter().map(|time| WeightKey { time, weight: 0.5 }).collect::<Vec<_>>();
    let weights = weights.into_iter().map(|key| WeightKey { weight: weight(random), ..key }).collect();
    LayerSettings { mode, weight: weight(random), weights, ..LayerSettings::default() }
}

/// Computes the pose of a bone with its layers by the functions for poses, independently of those for keys.
fn blended(base: &Track, layers: &[TakeLayer], rest: Transform, time: f32) -> Transform {
    let pose = |track: &Track, rest: Transform| Transform {
        translation: sample_channel(&track.translation, rest.translation, time),
        rotation: sample_channel(&track.rotation, rest.rotation, time),
        scale: sample_channel(&track.scale, rest.scale, time),
    };
    layers.iter().filter(|layer| !layer.settings.is_muted).fold(pose(base, rest), |below, layer| {
        let weight = layer.settings.weight_at(time);
        let keys = &layer.take.tracks[0];
        match layer.settings.mode {
            LayerMode::Additive => add_to(below, pose(keys, Transform::IDENTITY), weight),
            LayerMode::Override => mix_poses(below, pose(keys, below), weight),
        }
    })
}

/// Returns whether a step of any channel is near `time`.
fn is_near_jump(tracks: &[&Track], time: f32) -> bool {
    let jumps = |times: &[f32], kind: Interpolation| match kind {
        Interpolation::Step => times.iter().any(|&key| (key - time).abs() < 2e-3),
        Interpolation::Closest => {
            times.windows(2).any(|pair| (pair[0].midpoint(pair[1]) - time).abs() < 2e-3)
        }
        Interpolation::Linear | Interpolation::CubicSpline => false,
    };
    tracks.iter().any(|track| {
        jumps(&track.translation.times, track.translation.interpolation)
            || jumps(&track.rotation.times, track.rotation.interpolation)
            || jumps(&track.scale.times, track.scale.interpolation)
    })
}

fn one_bone() -> Skeleton {
    Skeleton { bones: vec![bone("arm", None, Vec3::new(0.0, 1.0, 0.0))] }
}

#[test]
fn a_flattened_take_is_what_blending_its_poses_gives() {
    let first = seed(180);
    let skeleton = one_bone();
    let rest = rest_pose(&skeleton.bones[0]);
    let mut compared = 0;
    for number in first..first + 300 {
        let mut random = Random::new(number);
        // Moderate angles, because half way between opposite rotations either way round is right.
        let base = take(vec![track(&mut random, 6, 1.0)]);
        let layers: Vec<TakeLayer> = (0..1 + random.below(3))
            .map(|_| TakeLayer {
                settings: LayerSettings { is_muted: random.below(5) == 0, ..settings(&mut random) },
                take: Arc::new(take(vec![track(&mut random, 4, 0.7)])),
            })
            .collect();
        let flat = flatten(&base, &layers, &skeleton);
        let tracks: Vec<&Track> = std::iter::once(&base.tracks[0])
            .chain(layers.iter().map(|layer| &layer.take.tracks[0]))
            .collect();
        for _ in 0..60 {
            let time = random.between(-0.1, 2.2);
            if is_near_jump(&tracks, time) {
                continue;
            }
            let wanted = blended(&base.tracks[0], &layers, rest, time);
            let got = Transform {
                translation: sample_channel(&flat.tracks[0].translation, rest.translation, time),
                rotation: sample_channel(&flat.tracks[0].rotation, rest.rotation, time),
                scale: sample_channel(&flat.tracks[0].scale, rest.scale, time),
            };
            let off = [
                (got.translation - wanted.translation).length(),
                angle_between(got.rotation, wanted.rotation),
                (got.scale - wanted.scale).length(),
            ];
            assert!(
                off.iter().all(|off| *off < 2e-3),
                "seed {number}, {time} s: off by {off:?}\n{base:?}\n{layers:?}\n{flat:?}"
            );
            compared += 1;
        }
    }
    assert!(compared > 10_000, "{compared}");
}

#[test]
fn channels_that_no_layer_moves_are_shared_with_the_base() {
    let mut random = Random::new(seed(181));
    let skeleton = one_bone();
    let base = take(vec![track(&mut random, 6, 1.0)]);
    let with = |settings: LayerSettings, keys: Track| {
        flatten(&base, &[TakeLayer { settings, take: Arc::new(take(vec![keys])) }], &skeleton)
    };
    let up = || Track { translation: along_x(&[(0.0, 1.0)], Interpolation::Linear), ..Track::default() };
    let moved = with(LayerSettings::default(), up());
    assert!(Arc::ptr_eq(&moved.tracks[0].rotation.values, &base.tracks[0].rotation.values));
    assert!(moved.tracks[0].translation != base.tracks[0].translation);
    for still in [
        LayerSettings { is_muted: true, ..LayerSettings::default() },
        LayerSettings { bones: Some(Arc::from([1, 2])), ..LayerSettings::default() },
    ] {
        assert_eq!(with(still, up()), base);
    }
    assert_eq!(with(LayerSettings::default(), Track::default()), base);
}

#[test]
fn of_several_layers_only_the_solo_ones_are_played() {
    let skeleton = one_bone();
    let base =
        take(vec![Track { translation: along_x(&[(0.0, 0.0)], Interpolation::Linear), ..Track::default() }]);
    let layer = |x: f32, is_solo: bool| TakeLayer {
        settings: LayerSettings { is_solo, ..LayerSettings::default() },
        take: Arc::new(take(vec![Track {
            translation: along_x(&[(0.0, x)], Interpolation::Linear),
            ..Track::default()
        }])),
    };
    let x = |layers: &[TakeLayer]| flatten(&base, layers, &skeleton).tracks[0].translation.values[0].x;
    assert_eq!(x(&[layer(1.0, false), layer(2.0, false), layer(4.0, false)]), 7.0);
    assert_eq!(x(&[layer(1.0, true), layer(2.0, false), layer(4.0, true)]), 5.0);
}

#[test]
fn a_constant_offset_keeps_the_times_and_the_tangents_of_a_spline() {
    let spline = Channel::new(
        [0.0, 1.0, 2.0],
        [0.0, 0.0, 2.0, 2.0, 1.0, 1.0, 1.0, 3.0, 0.0].map(|x: f32| Vec3::new(x, 0.0, 0.0)),
        Interpolation::CubicSpline,
    );
    let up = along_x(&[(0.5, 10.0)], Interpolation::Linear);
    let half = LayerSettings { weight: 0.5, ..LayerSettings::default() };
    let layers = [LayerChannel { settings: &half, keys: &up }];
    let flat = flatten_channel::<TranslationRule>(&spline, &layers, Vec3::ZERO).unwrap();
    assert!(Arc::ptr_eq(&flat.times, &spline.times));
    for step in 0..=40 {
        let time = step as f32 * 0.05;
        let off = sample_channel(&flat, Vec3::ZERO, time) - sample_channel(&spline, Vec3::ZERO, time);
        assert!((off - Vec3::new(5.0, 0.0, 0.0)).length() < 1e-5, "{time} s: {off}");
    }
}

#[test]
fn three_keys_over_a_long_channel_add_few_keys() {
    let keys: Vec<(f32, f32)> =
        (0..18_000).map(|key| (key as f32 / 30.0, (key as f32 * 0.1).sin())).collect();
    let base = about_z(&keys, Interpolation::Linear);
    let nod = about_z(&[(100.0, 0.0), (101.0, 0.3), (102.0, 0.0)], Interpolation::Linear);
    let settings = LayerSettings::default();
    let layers = [LayerChannel { settings: &settings, keys: &nod }];
    let flat = flatten_channel::<RotationRule>(&base, &layers, Quat::IDENTITY).unwrap();
    assert!(flat.len() <= 18_003, "{} keys", flat.len());
    // Before and after the three keys the layer is the identity, and the keys are those of the base, to the bit.
    let same = flat.times.iter().zip(flat.values.iter()).filter(|(time, _)| !(100.0..=102.0).contains(*time));
    for (time, value) in same {
        let at = base.times.partition_point(|key| key < time);
        assert_eq!((base.times[at], base.values[at]), (*time, *value));
    }
}

/// Checks for one channel that the key that a layer is given is the one with which the wanted value is seen.
fn solved<R: LayerRule>(
    random: &mut Random,
    channel: impl Fn(&mut Random, usize) -> Channel<R::Value>,
    wanted: R::Value,
    context: &str,
) -> bool {
    let (base, time) = (channel(random, 4), random.below(40) as f32 * 0.05);
    let below = sample_channel(&base, wanted, time);
    let all: Vec<(LayerSettings, Channel<R::Value>)> =
        (0..3).map(|_| (settings(random), channel(random, 3))).collect();
    let index = random.below(3);
    let mut layers: Vec<LayerChannel<'_, R::Value>> =
        all.iter().map(|(settings, keys)| LayerChannel { settings, keys }).collect();
    let Some(key) = key_for::<R>(below, &layers, index, time, wanted) else { return false };
    let own = Channel::new([time], [key], Interpolation::Linear);
    layers[index].keys = &own;
    let got = seen::<R>(below, &layers, time);
    assert!(R::distance(got, wanted) < 5e-3, "{context}");
    true
}

#[test]
fn the_key_that_a_layer_needs_for_a_pose_shows_that_pose() {
    let first = seed(182);
    let mut found = 0;
    for number in first..first + 1000 {
        let mut random = Random::new(number);
        let random = &mut random;
        let context = format!("seed {number}");
        let (place, factor) = (random.between(-1.0, 1.0), random.between(0.5, 1.5));
        let goal = turn(random, 0.5);
        found += usize::from(solved::<TranslationRule>(
            random,
            |random, most| track(random, most, 0.5).translation,
            Vec3::splat(place),
            &context,
        ));
        found += usize::from(solved::<RotationRule>(
            random,
            |random, most| track(random, most, 0.5).rotation,
            goal,
            &context,
        ));
        found += usize::from(solved::<ScaleRule>(
            random,
            |random, most| track(random, most, 0.5).scale,
            Vec3::splat(factor),
            &context,
        ));
    }
    assert!(found > 1000, "{found}");
}

#[test]
fn a_layer_without_weight_or_under_an_opaque_one_has_no_key_for_a_pose() {
    let keys = along_x(&[(0.0, 1.0)], Interpolation::Linear);
    let [none, whole] = [0.0, 1.0].map(|weight| LayerSettings {
        weight,
        mode: LayerMode::Override,
        ..LayerSettings::default()
    });
    let layer = |settings| LayerChannel { settings, keys: &keys };
    let key = |layers: &[LayerChannel<'_, Vec3>], index| {
        key_for::<TranslationRule>(Vec3::ZERO, layers, index, 0.0, Vec3::X)
    };
    assert_eq!(key(&[layer(&none)], 0), None);
    assert_eq!(key(&[layer(&whole), layer(&whole)], 0), None);
    assert_eq!(key(&[layer(&whole), layer(&none)], 0), Some(Vec3::X));
    assert_eq!(key(&[layer(&whole)], 1), None);
}

#[test]
fn flattening_a_take_of_another_skeleton_does_not_panic() {
    let skeleton = one_bone();
    let AnimationData { takes, .. } = animation_data(Vec::new(), vec![take(Vec::new())]);
    let layer = TakeLayer { settings: LayerSettings::default(), take: Arc::clone(&takes[0]) };
    assert_eq!(flatten(&takes[0], std::slice::from_ref(&layer), &skeleton).tracks.len(), 0);
    let base: Take = take(vec![Track::default(), Track::default()]);
    assert_eq!(flatten(&base, &[layer], &skeleton), base);
}

#[test]
fn a_flattened_channel_of_many_keys_has_no_more_keys_than_its_sources_and_is_exact_between_them() {
    let first = seed(1807);
    for number in first..first + 60 {
        let mut random = Random::new(number);
        let times: Vec<f32> = (0..200).map(|key| key as f32 * 0.01).collect();
        // Turns by a few degrees from key to key.
        let mut now = turn(&mut random, 3.0);
        let step = random.choice(&[0.001, 0.01, 0.08]);
        let mut walk = || {
            now = (turn(&mut random, step) * now).normalize();
            now
        };
        let base = Channel::new(
            times.clone(),
            times.iter().map(|_| walk()).collect::<Vec<_>>(),
            Interpolation::Linear,
        );
        let mut offset = turn(&mut random, 2.9);
        let reach = random.choice(&[0.05, 0.5, 2.0]);
        let ends = [0.0, 0.7, 1.99].map(|time| {
            offset = (turn(&mut random, reach) * offset).normalize();
            (time, offset)
        });
        let keys = Channel::new(ends.map(|end| end.0), ends.map(|end| end.1), Interpolation::Linear);
        let weight = random.choice(&[0.3, 1.0, 2.0]);
        let settings = LayerSettings { weight, ..LayerSettings::default() };
        let layers = [LayerChannel { settings: &settings, keys: &keys }];
        let flat = flatten_channel::<RotationRule>(&base, &layers, Quat::IDENTITY).expect("a layer");
        let mut worst = 0.0_f32;
        for at in 0..2000 {
            let time = at as f32 * 0.001;
            let below = sample_channel(&base, Quat::IDENTITY, time);
            let wanted = seen::<RotationRule>(below, &layers, time);
            worst = worst.max(angle_between(sample_channel(&flat, Quat::IDENTITY, time), wanted));
        }
        assert!(worst < 2.5e-4, "seed {number}: off by {worst}");
        let is_slow = step < 0.005 && reach < 0.1;
        assert!(!is_slow || flat.len() <= times.len() + 3, "seed {number}: {} keys", flat.len());
    }
}

#[test]
fn keys_on_frames_of_an_enormous_rate_stay_between_their_neighbors() {
    let base = about_z(&[(0.0, 0.0), (4_000.0, 1.0), (8_000.0, 0.0)], Interpolation::CubicSpline);
    let nod = about_z(&[(0.0, 0.0), (5_000.0, 0.9), (8_000.0, 0.0)], Interpolation::Linear);
    for rate in [1e3, 1e15, 1e18, f32::MAX] {
        let bones = one_bone();
        let track = |rotation: &Channel<Quat>| Track { rotation: rotation.clone(), ..Track::default() };
        let layer = TakeLayer { settings: LayerSettings::default(), take: Arc::new(take(vec![track(&nod)])) };
        let flat = flatten_with(&take(vec![track(&base)]), &[layer], &bones, AddedKeys::OnFrames(rate));
        let times = &flat.tracks[0].rotation.times;
        assert!(times.is_sorted_by(|a, b| a < b) && times.last() == Some(&8_000.0), "{rate}: {times:?}");
    }
}
