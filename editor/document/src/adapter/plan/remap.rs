//! A whole take on another clock: backwards, faster, slower, earlier, later.

use super::super::kind::{ChannelKind, ChannelValue, with_kind};
use super::super::op::{ChannelAddress, Op};
use super::super::slot::{ChannelContent, TakeId};
use super::arrange::stretched;
use super::{EditError, Transaction, contacts, finite, layer, moments, morph};
use crate::edit::SAME_TIME;
use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::sample::Value;
use std::sync::Arc;

/// A linear map of times: new time = `about` + (time - `from`) * `stretch`
#[derive(Clone, Copy, Debug)]
pub(crate) struct TimeMap {
    pub(crate) from: f32,
    pub(crate) about: f32,
    pub(crate) stretch: f32,
}

impl TimeMap {
    /// Returns the new time.
    fn at(&self, time: f32) -> f32 {
        let new = self.about + (time - self.from) * self.stretch;
        // Rounding, and a key within the tolerance of a cut, must not lead to a time before 0 s.
        if time >= 0.0 && (-SAME_TIME..0.0).contains(&new) { 0.0 } else { new }
    }
}

/// Moves every key of a take and of its layers, its contacts and events, by a map of times.
pub(crate) fn apply(work: &mut Transaction, take: TakeId, map: TimeMap) -> Result<(), EditError> {
    for address in work.channels(take, (&[], &[]))? {
        with_kind!(address.property, channel::<K>(work, address, map))?;
    }
    layer::remap(work, take, |time| map.at(time));
    for layer in layer::ids(work, take) {
        apply(work, layer, map)?;
    }
    for at in work.slot(take).pending() {
        finite("a time", map.at(at.time))?;
    }
    moments::remap(work, take, |time| Some(map.at(time)))?;
    contacts::follow(work, take, |track| track.remapped(|time| map.at(time)))?;
    let slot = work.slot(take);
    if slot.original.morphs.is_empty() {
        return Ok(());
    }
    let to = |time| Some(map.at(time));
    let morphs: Vec<_> =
        slot.original.morphs.iter().map(|track| morph::mapped(track, to, map.stretch)).collect();
    if slot.original.morphs.iter().zip(&morphs).any(|(old, new)| !apart(&old.times, &new.times)) {
        return Err(EditError::TooShort);
    }
    work.perform(Op::Morphs(take, morphs));
    Ok(())
}

/// Returns whether the new times ascend, and no more neighbors are at the same time ([`SAME_TIME`]) than before.
fn apart(old: &[f32], new: &[f32]) -> bool {
    let near = |times: &[f32]| times.windows(2).filter(|pair| pair[1] - pair[0] <= SAME_TIME).count();
    new.windows(2).all(|pair| pair[0] < pair[1]) && near(new) <= near(old)
}

fn channel<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    map: TimeMap,
) -> Result<(), EditError> {
    let slot = work.slot(address.take);
    let Some(old) = slot.original_of::<K>(address.bone).filter(|old| !old.is_empty()) else { return Ok(()) };
    let backwards = map.stretch < 0.0;
    let last = old.len() - 1;
    let from = |key: usize| if backwards { last - key } else { key };
    let times: Vec<f32> = (0..=last).map(|key| map.at(old.times[from(key)])).collect();
    if !apart(&old.times, &times) {
        return Err(EditError::TooShort);
    }
    let old_times = Arc::clone(&old.times);
    let spline = old.interpolation == Interpolation::CubicSpline;
    // Forwards and without tangents, the values stay as they are and are shared.
    let content = if !backwards && (!spline || map.stretch == 1.0) {
        let original = Channel { times: times.into(), ..old.clone() };
        ChannelContent {
            original: K::Value::wrap(original),
            changes: slot.changes(address.bone, address.property).to_vec(),
        }
    } else {
        let mut changes = Vec::new();
        let mut values = vec![K::Value::ZERO; old.values.len()];
        for key in 0..=last {
            let Some(found) = slot.key::<K>(address.property, address.bone, from(key)) else { continue };
            let found = stretched(found, map.stretch);
            super::super::change::put::<K>(&mut values, old.interpolation, key, &found.original);
            changes.extend(found.change.map(|change| (key as u32, change)));
        }
        let original =
            Channel { times: times.into(), values: values.into(), interpolation: old.interpolation };
        ChannelContent { original: K::Value::wrap(original), changes }
    };
    work.replace::<K>(address, content, &old_times);
    Ok(())
}
