//! Keys moved, scaled, copied, snapped, and room made between them.

use super::super::kind::with_kind;
use super::super::op::{Op, Place};
use super::super::slot::TakeId;
use super::arrange::{Moving, arrange};
use super::{EditError, Work, finite, key_time, morph, pending};
use crate::edit::{KeySet, SAME_TIME, TakeRef};

pub(super) fn shift(work: &mut Work, take: &TakeRef, sets: &[KeySet], by: f32) -> Result<(), EditError> {
    finite("the distance", by)?;
    moved(work, take, sets, Moving::WHOLE, |time| time + by)
}

pub(super) fn duplicate(work: &mut Work, take: &TakeRef, sets: &[KeySet], by: f32) -> Result<(), EditError> {
    finite("the distance", by)?;
    if by.abs() <= SAME_TIME {
        return Err(EditError::Number { what: "the distance", value: by });
    }
    moved(work, take, sets, Moving { copy: true, ..Moving::WHOLE }, |time| time + by)
}

pub(super) fn scale(
    work: &mut Work,
    take: &TakeRef,
    sets: &[KeySet],
    about: f32,
    factor: f32,
) -> Result<(), EditError> {
    finite("the time", about)?;
    finite("the factor", factor)?;
    if factor == 0.0 {
        return Err(EditError::Number { what: "the factor", value: factor });
    }
    moved(work, take, sets, Moving { copy: false, stretch: factor }, |time| about + (time - about) * factor)
}

pub(super) fn snap(work: &mut Work, take: &TakeRef, sets: &[KeySet], rate: f32) -> Result<(), EditError> {
    if !(1.0..=1000.0).contains(&rate) {
        return Err(EditError::Number { what: "the frame rate", value: rate });
    }
    let rate = f64::from(rate);
    moved(work, take, sets, Moving::WHOLE, |time| ((f64::from(time) * rate).round() / rate) as f32)
}

/// Puts keys at the times that `to` says.
fn moved(
    work: &mut Work,
    take: &TakeRef,
    sets: &[KeySet],
    moving: Moving,
    to: impl Fn(f32) -> f32,
) -> Result<(), EditError> {
    let take = work.take(take)?;
    for (place, keys) in work.keys(take, sets)? {
        let slot = work.slot(take);
        let times = slot.times(place.bone, place.property);
        let chosen = keys
            .into_iter()
            .map(|key| Ok((key, key_time(to(times[key as usize]), slot)?)))
            .collect::<Result<Vec<_>, EditError>>()?;
        put(work, place, &chosen, moving);
    }
    Ok(())
}

fn put(work: &mut Work, place: Place, chosen: &[(u32, f32)], moving: Moving) {
    with_kind!(place.property, arrange::<K>(work, place, chosen, moving));
}

pub(super) fn ripple(work: &mut Work, take: &TakeRef, from: f32, by: f32) -> Result<(), EditError> {
    let take = work.take(take)?;
    finite("the time", from)?;
    finite("the distance", by)?;
    let mut met = false;
    for place in work.channels(take, (&[], &[]))? {
        let slot = work.slot(take);
        let times = slot.times(place.bone, place.property);
        let first = times.partition_point(|&time| time < from - SAME_TIME) as u32;
        // Closing a gap takes away what lies in it.
        let gone = times.partition_point(|&time| time < from + by - SAME_TIME).min(first as usize) as u32;
        let chosen = (first..times.len() as u32)
            .map(|key| Ok((key, key_time(times[key as usize] + by, slot)?)))
            .collect::<Result<Vec<_>, EditError>>()?;
        if chosen.is_empty() {
            continue;
        }
        met = true;
        if gone < first {
            work.perform(Op::Splice(place, (gone..first).collect(), Vec::new()));
            let chosen: Vec<(u32, f32)> =
                chosen.into_iter().map(|(key, time)| (key - (first - gone), time)).collect();
            put(work, place, &chosen, Moving::WHOLE);
        } else {
            put(work, place, &chosen, Moving::WHOLE);
        }
    }
    let to = |time: f32| rippled(time, from, by);
    for at in work.slot(take).pending() {
        key_time(to(at.time).unwrap_or_default(), work.slot(take))?;
    }
    pending::moved(work, take, to);
    met |= ripple_morphs(work, take, from, by)?;
    if met { Ok(()) } else { Err(EditError::Nothing("no key lies there or later")) }
}

/// Where a time goes: what lies at `from` or later moves, and a gap that is closed takes away what is in it.
fn rippled(time: f32, from: f32, by: f32) -> Option<f32> {
    match time {
        _ if time >= from - SAME_TIME => Some(time + by),
        _ if time >= from + by - SAME_TIME => None,
        _ => Some(time),
    }
}

/// The same for morph weights, which have no channel of a bone.
fn ripple_morphs(work: &mut Work, take: TakeId, from: f32, by: f32) -> Result<bool, EditError> {
    let slot = work.slot(take);
    let late = |times: &[f32]| times.last().is_some_and(|&last| last >= from - SAME_TIME);
    if !slot.original.morphs.iter().any(|morph| late(&morph.times)) {
        return Ok(false);
    }
    let times = slot.original.morphs.iter().flat_map(|morph| morph.times.iter());
    for &time in times.filter(|&&time| time >= from - SAME_TIME) {
        key_time(time + by, slot)?;
    }
    let to = |time: f32| rippled(time, from, by);
    let morphs = slot.original.morphs.iter().map(|track| morph::mapped(track, to, 1.0)).collect();
    work.perform(Op::Morphs(take, morphs));
    Ok(true)
}
