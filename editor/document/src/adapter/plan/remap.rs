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

/// A map of times: new time = `about` + (time - `from`) * `stretch`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TimeMap {
    from: f32,
    about: f32,
    stretch: f32,
    /// The end of the part that is stretched, where the rest is not: before the part times stay, after it they keep their distance
    /// from it.
    until: Option<f32>,
}

impl TimeMap {
    /// Returns the map that is the same at all times.
    pub(crate) fn linear(from: f32, about: f32, stretch: f32) -> Self {
        Self { from, about, stretch, until: None }
    }

    /// Returns the map that stretches the part between two times.
    pub(crate) fn of_part([from, to]: [f32; 2], stretch: f32) -> Self {
        Self { from, about: from, stretch, until: Some(to) }
    }

    /// Returns the new time.
    fn at(&self, time: f32) -> f32 {
        let inside = |time: f32| self.about + (time - self.from) * self.stretch;
        let new = match self.until {
            Some(_) if time <= self.from => time,
            Some(until) if time > until => inside(until) + (time - until),
            Some(_) | None => inside(time),
        };
        // Rounding, and a key within the tolerance of a cut, must not lead to a time before 0 s.
        if time >= 0.0 && (-SAME_TIME..0.0).contains(&new) { 0.0 } else { new }
    }

    /// Returns the factors by which time runs slower directly before a time and directly after it.
    fn stretches(&self, time: f32) -> [f32; 2] {
        let Some(until) = self.until else { return [self.stretch; 2] };
        let part = |is_inside: bool| if is_inside { self.stretch } else { 1.0 };
        let starts = time >= self.from - SAME_TIME && time < until - SAME_TIME;
        let ends = time > self.from + SAME_TIME && time <= until + SAME_TIME;
        [part(ends), part(starts)]
    }

    fn is_shift(&self) -> bool {
        self.stretch == 1.0
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
    let morphs: Vec<_> = slot
        .original
        .morphs
        .iter()
        .map(|track| morph::mapped(track, to, |time| map.stretches(time)))
        .collect();
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
    let content = if !backwards && (!spline || map.is_shift()) {
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
            let found = stretched(found, map.stretches(found.time));
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
