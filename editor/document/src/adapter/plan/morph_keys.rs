//! Sets, moves and copies single keys of morph weights.

use super::super::op::Op;
use super::super::slot::TakeId;
use super::morph::{key_at, per_key, put};
use super::{EditError, KeyMove, Transaction, finite, key_time};
use crate::edit::SAME_TIME;
use dragonfly_anim::data::{Interpolation, MorphTrack};
use std::collections::BTreeMap;

/// Returns the track with new weights at `time`: pairs of a target and a weight. Where it has no key there, it gets one that keeps the
/// other weights. `empty` is the mesh instance and its own weights, for a mesh without a track.
pub(crate) fn with_weights(
    track: Option<&MorphTrack>,
    (instance, rest): (u32, &[f32]),
    time: f32,
    weights: &[(usize, f32)],
) -> MorphTrack {
    let empty = MorphTrack {
        instance,
        targets: rest.len() as u32,
        times: [time].into(),
        weights: rest.into(),
        interpolation: Interpolation::Linear,
    };
    let mut new = track.filter(|track| !track.times.is_empty()).cloned().unwrap_or(empty);
    let (width, targets) = (per_key(&new), new.targets as usize);
    let mut column = new.weights.to_vec();
    let key = match super::key_at(&new.times, time) {
        Ok(key) => key,
        Err(key) => {
            // A track whose column is too short is not made longer than its keys.
            let at = (key * width).min(column.len());
            column.splice(at..at, key_at(&new, time));
            let (before, after) = new.times.split_at(key);
            new.times = [before, &[time], after].concat().into();
            key
        }
    };
    let value = key * width + if new.interpolation == Interpolation::CubicSpline { targets } else { 0 };
    for &(target, weight) in weights.iter().filter(|(target, _)| *target < targets) {
        if let Some(number) = column.get_mut(value + target) {
            *number = weight;
        }
    }
    new.weights = column.into();
    new
}

/// The mesh of a weight, and its target with the number.
pub(crate) type MeshWeight = (u32, (usize, f32));

/// Gives shape keys weights at a time: pairs of a mesh, and of a target with its weight.
pub(crate) fn set_weights(
    work: &mut Transaction,
    take: TakeId,
    time: f32,
    weights: impl Iterator<Item = MeshWeight>,
) -> Result<(), EditError> {
    let mut meshes: BTreeMap<u32, Vec<(usize, f32)>> = BTreeMap::new();
    for (instance, weight) in weights {
        meshes.entry(instance).or_default().push(weight);
    }
    if meshes.is_empty() {
        return Ok(());
    }
    let mut tracks = work.slot(take).original.morphs.clone();
    for (instance, weights) in meshes {
        let at = tracks.iter().position(|track| track.instance == instance);
        let old = at.map(|at| &tracks[at]);
        let rest = work.adapter().shapes().mesh(instance).map_or(&[][..], |mesh| mesh.rest());
        let new = with_weights(old, (instance, rest), time, &weights);
        work.room_for_weights(&new, old.map_or(0, |old| old.times.len()))?;
        match at {
            Some(at) => tracks[at] = new,
            None => tracks.push(new),
        }
    }
    work.perform(Op::Morphs(take, tracks));
    Ok(())
}

/// Moves or copies the keys in stretches of time to the times that `to` returns. A key that is at a new time already is overwritten.
/// Returns whether there are any keys in them.
pub(crate) fn move_weights(
    work: &mut Transaction,
    take: TakeId,
    shapes: &[[f32; 2]],
    how: KeyMove,
    to: impl Fn(f32) -> f32,
) -> Result<bool, EditError> {
    for time in shapes.iter().flatten() {
        finite("the time", *time)?;
    }
    let inside =
        |time: f32| shapes.iter().any(|[from, to]| time >= from - SAME_TIME && time <= to + SAME_TIME);
    let mut found = false;
    let mut tracks = work.slot(take).original.morphs.clone();
    for track in &mut tracks {
        let times = track.times.iter().enumerate();
        let slot = work.slot(take);
        let chosen = times.filter(|(_, time)| inside(**time));
        let chosen: Vec<(usize, f32)> = chosen
            .map(|(key, &time)| Ok((key, key_time(to(time), slot)?)))
            .collect::<Result<_, EditError>>()?;
        if chosen.is_empty() {
            continue;
        }
        found = true;
        let moved = arranged(track, &chosen, how);
        work.room_for_weights(&moved, track.times.len())?;
        *track = moved;
    }
    if found {
        work.perform(Op::Morphs(take, tracks));
    }
    Ok(found)
}

/// Returns the track with its keys `chosen`, ascending, each with its new time, moved or copied there. Of two keys that
/// come to one time, the later one in the list stays.
fn arranged(track: &MorphTrack, chosen: &[(usize, f32)], how: KeyMove) -> MorphTrack {
    let mut moved = chosen.to_vec();
    // The sort is stable, so of keys at one time the last in the list comes last.
    moved.sort_by(|a, b| a.1.total_cmp(&b.1));
    moved.reverse();
    moved.dedup_by(|next, kept| (kept.1 - next.1).abs() <= SAME_TIME);
    moved.reverse();
    let leaves = |key: usize| !how.copy && chosen.binary_search_by_key(&key, |(key, _)| *key).is_ok();
    let covered = |time: f32| {
        let at = moved.partition_point(|(_, new)| *new < time - SAME_TIME);
        moved.get(at).is_some_and(|(_, new)| *new <= time + SAME_TIME)
    };
    let times = track.times.iter().enumerate();
    let stay = times.filter(|&(key, &time)| !leaves(key) && !covered(time));
    let mut keys: Vec<(f32, usize, f32)> = stay.map(|(key, &time)| (time, key, 1.0)).collect();
    keys.extend(moved.iter().map(|&(key, time)| (time, key, how.stretch)));
    keys.sort_by(|a, b| a.0.total_cmp(&b.0));
    let width = per_key(track);
    let mut weights = Vec::with_capacity(keys.len() * width);
    for &(_, key, stretch) in &keys {
        put(
            &mut weights,
            track.weights.get(key * width..(key + 1) * width).unwrap_or(&[]),
            track,
            [stretch; 2],
        );
    }
    let times = keys.iter().map(|(time, ..)| *time).collect();
    MorphTrack { times, weights: weights.into(), ..track.clone() }
}
