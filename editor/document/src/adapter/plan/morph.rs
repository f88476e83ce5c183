//! Moves and cuts morph weights together with the keys of their take.

use crate::edit::SAME_TIME;
use dragonfly_anim::data::{Interpolation, MorphTrack, Take};
use dragonfly_anim::sample::mix::hermite_slope;
use dragonfly_anim::sample::{find_keys, sample_morph_weights};

/// Returns the number of floats per key.
fn per_key(track: &MorphTrack) -> usize {
    track.targets as usize * if track.interpolation == Interpolation::CubicSpline { 3 } else { 1 }
}

/// Returns the track with its keys moved to the times that `to` returns, without those for which it returns `None`.
/// Time runs `stretch` times slower, so tangents are divided by it. Where it is negative, `to` reverses the order of
/// all keys.
pub(crate) fn mapped(track: &MorphTrack, to: impl Fn(f32) -> Option<f32>, stretch: f32) -> MorphTrack {
    let width = per_key(track);
    let mut keys: Vec<(f32, usize)> =
        track.times.iter().enumerate().filter_map(|(key, &time)| Some((to(time)?, key))).collect();
    if stretch < 0.0 {
        keys.reverse();
    }
    let mut weights = Vec::with_capacity(keys.len() * width);
    for &(_, key) in &keys {
        let values = track.weights.get(key * width..(key + 1) * width).unwrap_or(&[]);
        put(&mut weights, values, track, stretch);
    }
    let times = keys.iter().map(|(time, _)| *time).collect();
    MorphTrack { times, weights: weights.into(), ..track.clone() }
}

/// Appends a key, with its tangents divided by `stretch`; a negative `stretch` also swaps them.
fn put(weights: &mut Vec<f32>, values: &[f32], track: &MorphTrack, stretch: f32) {
    let targets = track.targets as usize;
    if track.interpolation != Interpolation::CubicSpline || values.len() < 3 * targets {
        return weights.extend_from_slice(values);
    }
    let (arrive, rest) = values.split_at(targets);
    let (value, leave) = rest.split_at(targets);
    let (arrive, leave) = if stretch < 0.0 { (leave, arrive) } else { (arrive, leave) };
    weights.extend(arrive.iter().map(|tangent| tangent / stretch));
    weights.extend_from_slice(value);
    weights.extend(leave.iter().map(|tangent| tangent / stretch));
}

/// Returns the keys between two times, with keys at both where the track continues outside; a single key where there
/// is none inside.
pub(crate) fn between(track: &MorphTrack, from: f32, to: f32) -> MorphTrack {
    let (Some(&first), Some(&last)) = (track.times.first(), track.times.last()) else { return track.clone() };
    let width = per_key(track);
    let (mut times, mut weights) = (Vec::new(), Vec::new());
    let sampled = |time: f32, times: &mut Vec<f32>, weights: &mut Vec<f32>| {
        times.push(time);
        weights.extend(key_at(track, time));
    };
    let inside = |time: f32| time >= from - SAME_TIME && time <= to + SAME_TIME;
    let on = |wanted: f32| track.times.iter().any(|&time| (time - wanted).abs() <= SAME_TIME);
    let none_inside = !track.times.iter().any(|&time| inside(time));
    if !on(from) && (first < from || none_inside) {
        sampled(from, &mut times, &mut weights);
    }
    for (key, &time) in track.times.iter().enumerate().filter(|(_, time)| inside(**time)) {
        times.push(time);
        weights.extend_from_slice(track.weights.get(key * width..(key + 1) * width).unwrap_or(&[]));
    }
    // A range of length zero needs only one key.
    if !on(to) && first < to && last > to && to - from > SAME_TIME {
        sampled(to, &mut times, &mut weights);
    }
    MorphTrack { times: times.into(), weights: weights.into(), ..track.clone() }
}

/// Returns the numbers of a new key at `time` that leaves the curves of the track as they are.
fn key_at(track: &MorphTrack, time: f32) -> Vec<f32> {
    let targets = track.targets as usize;
    let mut value = vec![0.0; targets];
    let alone = Take { morphs: vec![track.clone()], ..Take::default() };
    sample_morph_weights(Some(&alone), track.instance, &[], time, &mut value);
    if track.interpolation != Interpolation::CubicSpline {
        return value;
    }
    let slope: Vec<f32> = (0..targets).map(|target| slope(track, target, time)).collect();
    [slope.clone(), value, slope].concat()
}

fn slope(track: &MorphTrack, target: usize, time: f32) -> f32 {
    let Some(keys) = find_keys(&track.times, time) else { return 0.0 };
    if keys.before == keys.after {
        return 0.0;
    }
    let width = track.targets as usize;
    let at =
        |key: usize, row: usize| track.weights.get((key * 3 + row) * width + target).copied().unwrap_or(0.0);
    let span = track.times[keys.after] - track.times[keys.before];
    let (before, after) = (keys.before, keys.after);
    hermite_slope(at(before, 1), at(before, 2), at(after, 0), at(after, 1), span, keys.mix)
}
