//! Gives keys of morph weights new weights and tangents, many at once: each column is copied only once.

use super::super::op::Op;
use super::super::slot::TakeId;
use super::morph::{key_at, per_key, slope_at_key};
use super::{EditError, Transaction, pending};
use dragonfly_anim::data::{Interpolation, MorphTrack};
use std::collections::BTreeMap;

/// New numbers for a target at a time. What is absent stays as it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GivenWeight {
    /// Seconds.
    pub(crate) time: f32,
    /// Index of the target.
    pub(crate) target: usize,
    /// The weight. Where no key is at the time, one is added that keeps the other weights.
    pub(crate) weight: Option<f32>,
    /// In-tangent of a spline, per second.
    pub(crate) arrive: Option<f32>,
    /// Out-tangent of a spline, per second.
    pub(crate) leave: Option<f32>,
}

/// How new numbers are written.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WeightRules {
    /// The interpolation of a mesh without keys.
    pub(crate) interpolation: Interpolation,
    /// Whether keys of splines get smooth tangents where none are given.
    pub(crate) smooth: bool,
}

/// Gives shape keys their numbers, by mesh. Pending weights at these times are removed.
pub(crate) fn give_weights(
    work: &mut Transaction,
    take: TakeId,
    given: BTreeMap<u32, (WeightRules, Vec<GivenWeight>)>,
) -> Result<(), EditError> {
    let mut tracks = work.slot(take).original.morphs.clone();
    for (instance, (rules, given)) in &given {
        let at = tracks.iter().position(|track| track.instance == *instance);
        let rest = work.adapter().shapes().mesh(*instance).map_or(&[][..], |mesh| mesh.rest());
        let empty = empty_track(*instance, rest, rules.interpolation);
        let old = at.map(|at| &tracks[at]).filter(|track| !track.times.is_empty()).unwrap_or(&empty);
        let new = with_given(old, rest, given, *rules);
        work.room_for_weights(&new, old.times.len())?;
        match at {
            Some(at) => tracks[at] = new,
            None if new.times.is_empty() => {}
            None => tracks.push(new),
        }
    }
    work.perform(Op::Morphs(take, tracks));
    for (instance, (_, given)) in given {
        for given in given.iter().filter(|given| given.weight.is_some()) {
            pending::shapes_overwritten(work, take, given.time, [(instance, given.target as u32)]);
        }
    }
    Ok(())
}

/// Returns a track of a mesh without keys.
pub(super) fn empty_track(instance: u32, rest: &[f32], interpolation: Interpolation) -> MorphTrack {
    let targets = rest.len() as u32;
    MorphTrack { instance, targets, times: [].into(), weights: [].into(), interpolation }
}

/// Returns the track with the given numbers. `rest` are the weights of a first key that are not given.
fn with_given(track: &MorphTrack, rest: &[f32], given: &[GivenWeight], rules: WeightRules) -> MorphTrack {
    let weighted = given.iter().filter(|given| given.weight.is_some());
    let new_times = weighted.map(|given| given.time);
    let mut new = with_keys(track, rest, new_times);
    let (width, targets) = (per_key(&new), new.targets as usize);
    let spline = new.interpolation == Interpolation::CubicSpline;
    let mut column = new.weights.to_vec();
    let found = given.iter().filter(|given| given.target < targets);
    let found = found.filter_map(|given| Some((super::key_at(&new.times, given.time).ok()?, given)));
    let mut smoothed: Vec<(usize, &GivenWeight)> = Vec::new();
    for (key, given) in found {
        let mut put = |part: usize, number: Option<f32>| {
            if let Some((place, number)) =
                column.get_mut(key * width + part * targets + given.target).zip(number)
            {
                *place = number;
            }
        };
        put(usize::from(spline), given.weight);
        if spline {
            put(0, given.arrive);
            put(2, given.leave);
            smoothed.push((key, given));
        }
    }
    if spline && rules.smooth {
        for (key, given) in smoothed {
            let value = |key: usize| column.get(key * width + targets + given.target).copied().unwrap_or(0.0);
            let slope = slope_at_key(&new.times, value, key);
            for (part, tangent) in [(0, given.arrive), (2, given.leave)] {
                let place = column.get_mut(key * width + part * targets + given.target);
                if let Some(place) = place.filter(|_| tangent.is_none()) {
                    *place = slope;
                }
            }
        }
    }
    new.weights = column.into();
    new
}

/// Returns the track with a key at each of these times, in any order, that leaves its curves as they are.
pub(super) fn with_keys(
    track: &MorphTrack,
    rest: &[f32],
    times: impl IntoIterator<Item = f32>,
) -> MorphTrack {
    let mut wanted: Vec<f32> =
        times.into_iter().filter(|&time| super::key_at(&track.times, time).is_err()).collect();
    wanted.sort_by(f32::total_cmp);
    wanted.dedup_by(|next, kept| *next - *kept <= crate::edit::SAME_TIME);
    if wanted.is_empty() {
        return track.clone();
    }
    let (width, targets) = (per_key(track), track.targets as usize);
    let own = track.times.iter().enumerate().map(|(key, &time)| (time, Some(key)));
    let mut keys: Vec<(f32, Option<usize>)> = own.chain(wanted.iter().map(|&time| (time, None))).collect();
    keys.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut weights: Vec<f32> = Vec::with_capacity(keys.len() * width);
    for &(time, key) in &keys {
        let end = weights.len() + width;
        match key {
            Some(key) => {
                weights.extend_from_slice(track.weights.get(key * width..(key + 1) * width).unwrap_or(&[]));
            }
            None if track.times.is_empty() => {
                weights.resize(weights.len() + (width - targets) / 2, 0.0);
                weights.extend(rest.iter().take(targets));
            }
            None => weights.extend(key_at(track, time)),
        }
        weights.resize(end, 0.0);
    }
    let times = keys.iter().map(|(time, _)| *time).collect();
    MorphTrack { times, weights: weights.into(), ..track.clone() }
}
