//! The same offset for the weights of shape keys at many keys.

use super::super::op::Op;
use super::super::pending::PendingAt;
use super::super::slot::{TakeId, TakeVersions};
use super::morph::per_key;
use super::morph_given::{empty_track, with_keys};
use super::morph_keys::MeshWeight;
use super::{EditError, Transaction, finite};
use crate::edit::target::SAME_TIME;
use crate::edit::{OffsetShapes, ShapeScope};
use dragonfly_anim::data::{Interpolation, MorphTrack};
use dragonfly_anim::offset::{Falloff, KeyWeight, weights_of_keys, weights_of_range};
use dragonfly_anim::sample::sample_morph_weights;
use std::collections::BTreeMap;
use std::sync::Arc;

/// An offset edit whose numbers were checked.
struct ShapeOffsetPlan<'a> {
    take: TakeId,
    scope: &'a ShapeScope,
    falloff: Option<Falloff>,
    /// Start and end of the take, seconds.
    ends: [f32; 2],
}

/// Adds to the weights of shape keys: `shapes` are the meshes and targets with their numbers.
pub(crate) fn offset_shapes(
    work: &mut Transaction,
    edit: &OffsetShapes,
    shapes: Vec<MeshWeight>,
) -> Result<(), EditError> {
    let take = work.take(&edit.take)?;
    let at = edit.at.map(|at| finite("a time", at)).transpose()?;
    let falloff = match edit.falloff {
        Some(falloff) if finite("the falloff", falloff.seconds)? > 4.0 * SAME_TIME => {
            Some(Falloff::from(falloff))
        }
        Some(_) | None => None,
    };
    let slot = Arc::clone(work.slot(take));
    let (start, end) = slot.original.range_of_keys().unwrap_or((0.0, 0.0));
    match &edit.over {
        ShapeScope::Take => {}
        ShapeScope::Range(range) => {
            let (from, to) = (finite("a time", range.from)?, finite("a time", range.to)?);
            let (from, to) = (from.min(to), from.max(to));
            if to < start - SAME_TIME || from > end + SAME_TIME {
                return Err(EditError::Outside { time: if to < start { to } else { from }, start, end });
            }
        }
        ShapeScope::Keys(stretches) => {
            for time in stretches.iter().flatten() {
                finite("a time", *time)?;
            }
        }
    }
    let mut meshes: BTreeMap<u32, BTreeMap<usize, f32>> = BTreeMap::new();
    for (instance, (target, number)) in shapes {
        meshes.entry(instance).or_default().insert(target, number);
    }
    let plan = ShapeOffsetPlan { take, scope: &edit.over, falloff, ends: [start, end] };
    let mut tracks = slot.original.morphs.clone();
    let (mut found, mut differs) = (false, false);
    for (instance, mut numbers) in meshes {
        let rest = work.adapter().shapes().mesh(instance).map_or(&[][..], |mesh| mesh.rest()).to_vec();
        if let Some(at) = at {
            let mut shown = vec![0.0; rest.len()];
            sample_morph_weights(Some(&slot.result), instance, &rest, at, &mut shown);
            if let Some(pending) = slot.pending_at(at) {
                pending.put_weights(instance, &mut shown);
            }
            for (&target, number) in &mut numbers {
                *number -= shown.get(target).copied().unwrap_or(0.0);
            }
        }
        let index = tracks.iter().position(|track| track.instance == instance);
        let (old, new) = {
            let empty = || empty_track(instance, &rest, Interpolation::Linear);
            let old = index.map_or_else(empty, |index| tracks[index].clone());
            let new = with_keys(&old, &rest, plan.wanted_keys(&old));
            (old, new)
        };
        let weights = plan.weights(&new.times);
        if !weights.is_empty() {
            found = true;
            work.room_for_weights(&new, old.times.len())?;
            let new = offset(new, &numbers, &weights)?;
            differs |= new != old;
            match index {
                Some(index) => tracks[index] = new,
                None => tracks.push(new),
            }
        }
        found |= plan.offset_pending(work, (instance, &old.times), &numbers)?;
    }
    if !found {
        return Err(EditError::Nothing("these shape keys have no key there"));
    }
    if differs {
        work.perform(Op::Morphs(take, tracks));
    }
    Ok(())
}

/// Returns the number of keys that get an offset, without those of a falloff and new ones.
pub(crate) fn keys_of(slot: &TakeVersions, meshes: &[u32], over: &ShapeScope) -> usize {
    let named = slot.original.morphs.iter().filter(|track| meshes.contains(&track.instance));
    named.map(|track| track.times.iter().filter(|&&time| distance(over, time) == Some(0.0)).count()).sum()
}

/// Returns the distance of a time from the scope, seconds; `None` where nothing is in it.
fn distance(scope: &ShapeScope, time: f32) -> Option<f32> {
    let from = |[from, to]: [f32; 2]| {
        let (from, to) = (from.min(to) - SAME_TIME, from.max(to) + SAME_TIME);
        (from - time).max(time - to).max(0.0)
    };
    match scope {
        ShapeScope::Take => Some(0.0),
        ShapeScope::Range(range) => Some(from([range.from, range.to])),
        ShapeScope::Keys(stretches) => stretches.iter().map(|&stretch| from(stretch)).reduce(f32::min),
    }
}

impl ShapeOffsetPlan<'_> {
    /// Returns the range of the edit, inside the take.
    fn range(&self) -> Option<[f32; 2]> {
        let ShapeScope::Range(range) = self.scope else { return None };
        let [start, end] = self.ends;
        Some([range.from.min(range.to).max(start), range.from.max(range.to).min(end)])
    }

    /// Returns the times at which a track needs keys to get the offset where it is wanted and nowhere else.
    fn wanted_keys(&self, track: &MorphTrack) -> Vec<f32> {
        let [start, end] = self.ends;
        let mut wanted = Vec::new();
        match (self.range(), self.falloff) {
            (None, _) if track.times.is_empty() && *self.scope == ShapeScope::Take => wanted.push(start),
            (Some([from, to]), Some(Falloff { seconds, .. })) => {
                let step = matches!(track.interpolation, Interpolation::Step | Interpolation::Closest);
                let is_empty = track.times.is_empty();
                if is_empty {
                    wanted.push(from);
                }
                if from > start + SAME_TIME {
                    wanted.push(from);
                    // A step holds the value before by itself.
                    if from - seconds > start + SAME_TIME && (!step || is_empty) {
                        wanted.push(from - seconds);
                    } else if is_empty {
                        wanted.push(start);
                    }
                }
                if to < end - SAME_TIME {
                    wanted.push(to);
                    wanted.push((to + seconds).min(end));
                }
            }
            (Some(_) | None, _) => {}
        }
        wanted
    }

    /// Returns the keys that get parts of the offset.
    fn weights(&self, times: &[f32]) -> Vec<KeyWeight> {
        let falloff = self.shorter_falloff();
        if let Some([from, to]) = self.range() {
            return weights_of_range(times, [from - SAME_TIME, to + SAME_TIME], falloff);
        }
        let inside = |&key: &u32| distance(self.scope, times[key as usize]) == Some(0.0);
        let chosen: Vec<u32> = (0..times.len() as u32).filter(inside).collect();
        weights_of_keys(times, &chosen, falloff.filter(|_| *self.scope != ShapeScope::Take))
    }

    /// Returns the falloff without the keys that are exactly where it ends.
    fn shorter_falloff(&self) -> Option<Falloff> {
        self.falloff.map(|falloff| Falloff { seconds: falloff.seconds - 2.0 * SAME_TIME, ..falloff })
    }

    /// Offsets the pending weights of a mesh with keys at `times`. Returns whether there are any.
    fn offset_pending(
        &self,
        work: &mut Transaction,
        (instance, times): (u32, &[f32]),
        numbers: &BTreeMap<usize, f32>,
    ) -> Result<bool, EditError> {
        let slot = Arc::clone(work.slot(self.take));
        let mut met = false;
        for at in slot.pending() {
            let distance = match self.scope {
                // The keys themselves count, not the stretches.
                ShapeScope::Keys(_) => {
                    let keys = times.iter().filter(|&&key| distance(self.scope, key) == Some(0.0));
                    let nearest = keys.map(|key| (key - at.time).abs()).reduce(f32::min);
                    nearest.map(|nearest| if nearest <= SAME_TIME { 0.0 } else { nearest })
                }
                ShapeScope::Take | ShapeScope::Range(_) => distance(self.scope, at.time),
            };
            let part = match distance {
                Some(0.0) => 1.0,
                Some(distance) => self.shorter_falloff().map_or(0.0, |falloff| falloff.weight(distance)),
                None => 0.0,
            };
            let mut new = PendingAt::clone(at);
            for (&target, by) in numbers {
                let now = at.shapes_of(instance).iter().find(|shape| shape.shape as usize == target);
                if let Some(now) = now.filter(|_| part > 0.0) {
                    let weight = finite("the result", now.weight + by * part)?;
                    new.set_shape(instance, target as u32, Some(weight));
                    met = true;
                }
            }
            if new != **at {
                work.perform(Op::Pending(self.take, at.time, Some(Arc::new(new))));
            }
        }
        Ok(met)
    }
}

/// Adds parts of `numbers` to the weights of keys. Tangents stay: the curve between two keys with the whole offset is moved as a whole.
fn offset(
    track: MorphTrack,
    numbers: &BTreeMap<usize, f32>,
    weights: &[KeyWeight],
) -> Result<MorphTrack, EditError> {
    let (width, targets) = (per_key(&track), track.targets as usize);
    let row = if track.interpolation == Interpolation::CubicSpline { targets } else { 0 };
    let mut column = track.weights.to_vec();
    for &KeyWeight { key, weight } in weights {
        for (&target, by) in numbers.iter().filter(|(target, _)| **target < targets) {
            if let Some(number) = column.get_mut(key as usize * width + row + target) {
                *number = finite("the result", *number + by * weight)?;
            }
        }
    }
    Ok(MorphTrack { weights: column.into(), ..track })
}
