//! A whole take on another clock: backwards, faster, slower, earlier, later.

use super::super::kind::{Held, Kind, with_kind};
use super::super::op::{Op, Place};
use super::super::slot::{Content, TakeId};
use super::arrange::stretched;
use super::{EditError, Work, finite, morph, pending};
use crate::edit::{SAME_TIME, TakeRef};
use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::sample::Value;
use std::sync::Arc;

/// new time = `about` + (time - `from`) * `stretch`
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    pub(super) from: f32,
    pub(super) about: f32,
    pub(super) stretch: f32,
}

impl Clock {
    fn at(&self, time: f32) -> f32 {
        let new = self.about + (time - self.from) * self.stretch;
        // Rounding, and a key that counts as lying on a cut, must not lead before the begin of time.
        if time >= 0.0 && (-SAME_TIME..0.0).contains(&new) { 0.0 } else { new }
    }
}

/// A step channel keeps each key's value on its key, so reversing twice is the identity; between keys it then shows
/// the value of the other side.
pub(super) fn reverse(work: &mut Work, take: &TakeRef) -> Result<(), EditError> {
    let take = work.take(take)?;
    let (start, end) = (work.slot(take).original.start, work.slot(take).original.end());
    apply(work, take, Clock { from: start, about: end, stretch: -1.0 })
}

pub(super) fn retime(
    work: &mut Work,
    take: &TakeRef,
    start: Option<f32>,
    length: Option<f32>,
) -> Result<(), EditError> {
    let take = work.take(take)?;
    let (old_start, old_length) = (work.slot(take).original.start, work.slot(take).original.length);
    let start = finite("the start", start.unwrap_or(old_start))?;
    if start < old_start.min(0.0) {
        return Err(EditError::BeforeZero(start));
    }
    let length = finite("the length", length.unwrap_or(old_length))?;
    let stretch = match old_length {
        0.0 if length == 0.0 => 1.0,
        _ if length <= 0.0 => return Err(EditError::Number { what: "the length", value: length }),
        0.0 => return Err(EditError::Nothing("a take of one pose has no length to change")),
        old => length / old,
    };
    apply(work, take, Clock { from: old_start, about: start, stretch })
}

/// Puts every key of a take on another clock.
pub(super) fn apply(work: &mut Work, take: TakeId, clock: Clock) -> Result<(), EditError> {
    for place in work.channels(take, (&[], &[]))? {
        with_kind!(place.property, channel::<K>(work, place, clock))?;
    }
    for at in work.slot(take).pending() {
        finite("a time", clock.at(at.time))?;
    }
    pending::moved(work, take, |time| Some(clock.at(time)));
    let slot = work.slot(take);
    if slot.original.morphs.is_empty() {
        return Ok(());
    }
    let to = |time| Some(clock.at(time));
    let morphs: Vec<_> =
        slot.original.morphs.iter().map(|track| morph::mapped(track, to, clock.stretch)).collect();
    if slot.original.morphs.iter().zip(&morphs).any(|(old, new)| !apart(&old.times, &new.times)) {
        return Err(EditError::TooShort);
    }
    work.perform(Op::Morphs(take, morphs));
    Ok(())
}

/// Are keys still apart from each other, as far as they were before?
fn apart(old: &[f32], new: &[f32]) -> bool {
    let near = |times: &[f32]| times.windows(2).filter(|pair| pair[1] - pair[0] <= SAME_TIME).count();
    new.windows(2).all(|pair| pair[0] < pair[1]) && near(new) <= near(old)
}

fn channel<K: Kind>(work: &mut Work, place: Place, clock: Clock) -> Result<(), EditError> {
    let slot = work.slot(place.take);
    let Some(old) = slot.original_of::<K>(place.bone).filter(|old| !old.is_empty()) else { return Ok(()) };
    let backwards = clock.stretch < 0.0;
    let last = old.len() - 1;
    let from = |key: usize| if backwards { last - key } else { key };
    let times: Vec<f32> = (0..=last).map(|key| clock.at(old.times[from(key)])).collect();
    if !apart(&old.times, &times) {
        return Err(EditError::TooShort);
    }
    let old_times = Arc::clone(&old.times);
    let spline = old.interpolation == Interpolation::CubicSpline;
    // Without tangents and forwards the values stay where they are, and are shared.
    let content = if !backwards && (!spline || clock.stretch == 1.0) {
        let original = Channel { times: times.into(), ..old.clone() };
        Content {
            original: K::Value::wrap(original),
            changes: slot.changes(place.bone, place.property).to_vec(),
        }
    } else {
        let mut changes = Vec::new();
        let mut values = vec![K::Value::ZERO; old.values.len()];
        for key in 0..=last {
            let Some(found) = slot.key::<K>(place.property, place.bone, from(key)) else { continue };
            let found = stretched(found, clock.stretch);
            super::super::change::put::<K>(&mut values, old.interpolation, key, &found.original);
            changes.extend(found.change.map(|change| (key as u32, change)));
        }
        let original =
            Channel { times: times.into(), values: values.into(), interpolation: old.interpolation };
        Content { original: K::Value::wrap(original), changes }
    };
    work.replace::<K>(place, content, &old_times);
    Ok(())
}
