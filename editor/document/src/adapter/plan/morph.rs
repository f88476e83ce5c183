//! Moves and cuts morph weights together with the keys of their take.

use super::super::op::Op;
use super::super::slot::TakeId;
use super::values::ValueTool;
use super::{EditError, Transaction, finite};
use crate::edit::SAME_TIME;
use dragonfly_anim::data::{Interpolation, MorphTrack, Take};
use dragonfly_anim::sample::mix::hermite_slope;
use dragonfly_anim::sample::{find_keys, sample_morph_weights};

/// Returns the number of floats per key.
pub(super) fn per_key(track: &MorphTrack) -> usize {
    track.targets as usize * if track.interpolation == Interpolation::CubicSpline { 3 } else { 1 }
}

/// Returns the track with its keys moved to the times that `to` returns, without those for which it returns `None`.
/// Time runs `stretch` times slower, so tangents are divided by it. Where it is negative, `to` reverses the order of
/// all keys. Of keys that come to the same time, the last one is kept.
pub(crate) fn mapped(
    track: &MorphTrack,
    to: impl Fn(f32) -> Option<f32>,
    stretches: impl Fn(f32) -> [f32; 2],
) -> MorphTrack {
    let width = per_key(track);
    let mut keys: Vec<(f32, usize)> =
        track.times.iter().enumerate().filter_map(|(key, &time)| Some((to(time)?, key))).collect();
    if track.times.first().is_some_and(|&time| stretches(time)[0] < 0.0) {
        keys.reverse();
    }
    // Late in a take, times that differ may become the same: the later key stays.
    keys.dedup_by(|later, earlier| {
        let is_same = later.0 <= earlier.0;
        if is_same {
            earlier.1 = later.1;
        }
        is_same
    });
    let mut weights = Vec::with_capacity(keys.len() * width);
    for &(_, key) in &keys {
        let values = track.weights.get(key * width..(key + 1) * width).unwrap_or(&[]);
        put(&mut weights, values, track, stretches(track.times[key]));
    }
    let times = keys.iter().map(|(time, _)| *time).collect();
    MorphTrack { times, weights: weights.into(), ..track.clone() }
}

/// Appends a key, with its tangents divided by the factors before and after it; negative factors also swap them.
pub(super) fn put(weights: &mut Vec<f32>, values: &[f32], track: &MorphTrack, [before, after]: [f32; 2]) {
    let targets = track.targets as usize;
    if track.interpolation != Interpolation::CubicSpline || values.len() < 3 * targets {
        return weights.extend_from_slice(values);
    }
    let (arrive, rest) = values.split_at(targets);
    let (value, leave) = rest.split_at(targets);
    let (arrive, leave) = if before < 0.0 { (leave, arrive) } else { (arrive, leave) };
    weights.extend(arrive.iter().map(|tangent| tangent / before));
    weights.extend_from_slice(value);
    weights.extend(leave.iter().map(|tangent| tangent / after));
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
pub(super) fn key_at(track: &MorphTrack, time: f32) -> Vec<f32> {
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

/// Gives new weights to the keys of morph targets in stretches of time. A tangent changes as the slope from the key before to the key
/// after does.
pub(crate) fn change_weights(
    work: &mut Transaction,
    take: TakeId,
    shapes: &[[f32; 2]],
    alone: bool,
    tool: &impl ValueTool,
) -> Result<(), EditError> {
    if shapes.is_empty() {
        return Ok(());
    }
    for time in shapes.iter().flatten() {
        finite("the time", *time)?;
    }
    let inside =
        |time: f32| shapes.iter().any(|[from, to]| time >= from - SAME_TIME && time <= to + SAME_TIME);
    let (mut found, mut differs) = (false, false);
    let mut tracks = work.slot(take).original.morphs.clone();
    for track in &mut tracks {
        let chosen: Vec<u32> =
            (0..track.times.len() as u32).filter(|&key| inside(track.times[key as usize])).collect();
        found |= !chosen.is_empty();
        if let Some(weights) = changed_weights(work, track, &chosen, tool)? {
            track.weights = weights.into();
            differs = true;
        }
    }
    if alone && !found {
        return Err(EditError::Nothing("no key is selected"));
    }
    if differs {
        work.perform(Op::Morphs(take, tracks));
    }
    Ok(())
}

/// Returns the column of weights of a track after its `chosen` keys were changed; `None` where nothing changes.
fn changed_weights(
    work: &Transaction,
    track: &MorphTrack,
    chosen: &[u32],
    tool: &impl ValueTool,
) -> Result<Option<Vec<f32>>, EditError> {
    let (width, targets) = (per_key(track), track.targets as usize);
    let spline = track.interpolation == Interpolation::CubicSpline;
    if chosen.is_empty() || track.weights.len() < track.times.len() * width {
        return Ok(None);
    }
    let mut column = track.weights.to_vec();
    let mut differs = false;
    for target in 0..targets {
        let place = |key: usize| key * width + if spline { targets } else { 0 } + target;
        let old: Vec<f32> = (0..track.times.len()).map(|key| track.weights[place(key)]).collect();
        let Some(wanted) = tool.shape_weights(work, track, target, &old, chosen)? else { continue };
        let mut new = old.clone();
        for (&key, wanted) in chosen.iter().zip(wanted) {
            new[key as usize] = finite("the result", wanted)?;
        }
        if new == old {
            continue;
        }
        differs = true;
        for key in chosen.iter().map(|&key| key as usize) {
            column[place(key)] = new[key];
            if spline {
                let slope = |weights: &[f32]| slope_at_key(&track.times, |key| weights[key], key);
                let more = slope(&new) - slope(&old);
                for tangent in [key * width + target, key * width + 2 * targets + target] {
                    column[tangent] = finite("the result", column[tangent] + more)?;
                }
            }
        }
    }
    Ok(differs.then_some(column))
}

/// Returns the slope at a key per second: from the key before to the key after, at either end to the only neighbor.
pub(super) fn slope_at_key(times: &[f32], weight: impl Fn(usize) -> f32, key: usize) -> f32 {
    let (before, after) = (key.saturating_sub(1), (key + 1).min(times.len() - 1));
    let seconds = times[after] - times[before];
    if seconds > 0.0 { (weight(after) - weight(before)) / seconds } else { 0.0 }
}
