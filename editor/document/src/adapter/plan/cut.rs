//! A take cut in two, and a take of which a part is left.

use super::super::kind::{Kind, with_kind};
use super::super::op::{Op, Place};
use super::super::slot::{Key, TakeId};
use super::keys::current;
use super::remap::{Clock, apply};
use super::{EditError, Work, finite, morph, pending};
use crate::edit::{SAME_TIME, TakeRef};
use std::sync::Arc;

pub(super) fn split(work: &mut Work, take: &TakeRef, time: f32, name: &str) -> Result<(), EditError> {
    let take = work.take(take)?;
    finite("the time", time)?;
    let (start, end) = (work.slot(take).original.start, work.slot(take).original.end());
    if !(time > start + SAME_TIME && time < end - SAME_TIME) {
        return Err(EditError::Outside { time, start, end });
    }
    let id = work.adapter.new_id();
    let second = work.slot(take).copied(id);
    let behind = work.index(take) + 1;
    work.perform(Op::Insert(behind, Arc::new(second)));
    work.perform(Op::Name(id, name.to_owned()));
    cut(work, take, start, time)?;
    cut(work, id, time, end)?;
    apply(work, id, Clock { from: time, about: 0.0, stretch: 1.0 })
}

pub(super) fn trim(
    work: &mut Work,
    take: &TakeRef,
    from: f32,
    to: f32,
    to_start: bool,
) -> Result<(), EditError> {
    let take = work.take(take)?;
    let (start, end) = (work.slot(take).original.start, work.slot(take).original.end());
    for time in [from, to] {
        finite("the time", time)?;
        if !(time >= start - SAME_TIME && time <= end + SAME_TIME) {
            return Err(EditError::Outside { time, start, end });
        }
    }
    if to < from {
        return Err(EditError::Number { what: "an end before the begin", value: to });
    }
    cut(work, take, from.max(start), to.min(end))?;
    if to_start {
        return apply(work, take, Clock { from: from.max(start), about: start, stretch: 1.0 });
    }
    Ok(())
}

/// Leaves what lies between two times in all channels.
fn cut(work: &mut Work, take: TakeId, from: f32, to: f32) -> Result<(), EditError> {
    for place in work.channels(take, (&[], &[]))? {
        with_kind!(place.property, channel::<K>(work, place, from, to));
    }
    let inside = |time: f32| time >= from - SAME_TIME && time <= to + SAME_TIME;
    pending::moved(work, take, |time| inside(time).then_some(time));
    let slot = work.slot(take);
    if !slot.original.morphs.is_empty() {
        let morphs = slot.original.morphs.iter().map(|track| morph::between(track, from, to)).collect();
        work.perform(Op::Morphs(take, morphs));
    }
    Ok(())
}

/// Keys outside go; where the channel went on there, a key at the cut holds what it showed. A channel without a key
/// inside keeps one.
fn channel<K: Kind>(work: &mut Work, place: Place, from: f32, to: f32) {
    let slot = work.slot(place.take);
    let times = slot.times(place.bone, place.property);
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else { return };
    let inside = |time: f32| time >= from - SAME_TIME && time <= to + SAME_TIME;
    let on = |wanted: f32| times.iter().any(|&time| (time - wanted).abs() <= SAME_TIME);
    let remove: Vec<u32> = (0..times.len() as u32).filter(|&key| !inside(times[key as usize])).collect();
    let kept = times.len() - remove.len();
    let mut insert: Vec<(u32, Key)> = Vec::new();
    if !on(from) && (first < from || kept == 0) {
        insert.push((0, current::<K>(work, slot, place, from)));
    }
    // Where both cuts are one, one key holds the pose.
    if !on(to) && first < to && last > to && to - from > SAME_TIME {
        insert.push(((kept + insert.len()) as u32, current::<K>(work, slot, place, to)));
    }
    if !remove.is_empty() || !insert.is_empty() {
        work.perform(Op::Splice(place, remove, insert));
    }
}
