//! Copied keys put in, each with exactly what it held.

use super::super::kind::{Held, Kind, Numbers, with_kind};
use super::super::op::{Op, Place};
use super::super::slot::{Content, Key};
use super::arrange::lay;
use super::pending::overwritten;
use super::pose::rotation;
use super::spline::slope;
use super::{EditError, Work, finite, key_at, key_time};
use crate::edit::{Between, CopiedChannel, CopiedKey, Property, SAME_TIME, TakeRef};
use dragonfly_anim::data::{Channel, Interpolation};
use std::sync::Arc;

pub(super) fn paste(
    work: &mut Work,
    take: &TakeRef,
    time: f32,
    channels: &[CopiedChannel],
) -> Result<(), EditError> {
    let take = work.take(take)?;
    key_time(time, work.slot(take))?;
    let (mut met, mut put_in) = (false, 0);
    for channel in channels {
        // What another model has and this one has not is passed over.
        let Ok(bone) = work.bone(&channel.bone) else { continue };
        met = true;
        if bone as usize >= work.slot(take).original.tracks.len() {
            return Err(EditError::NoTrack(bone));
        }
        let place = Place { take, bone, property: channel.property };
        put_in += with_kind!(channel.property, one::<K>(work, place, time, channel))?;
    }
    match (met, put_in) {
        _ if channels.is_empty() => Err(EditError::Nothing("no key is given")),
        (true, 0) => Err(EditError::Nothing("no key is given")),
        (true, _) => Ok(()),
        (false, _) => Err(EditError::Nothing("none of the bones is in this model")),
    }
}

/// A key to be, and which of its tangents were given.
struct Given {
    key: Key,
    tangents: [bool; 2],
}

/// Puts keys into a channel; how many.
fn one<K: Kind>(
    work: &mut Work,
    place: Place,
    time: f32,
    channel: &CopiedChannel,
) -> Result<usize, EditError> {
    let mut given =
        channel.keys.iter().map(|key| read(work, place, time, key)).collect::<Result<Vec<_>, EditError>>()?;
    given.sort_by(|a, b| a.key.time.total_cmp(&b.key.time));
    // Of neighbours at one time the last counts.
    given.reverse();
    given.dedup_by(|next, kept| (kept.key.time - next.key.time).abs() <= SAME_TIME);
    given.reverse();
    if given.is_empty() {
        return Ok(0);
    }
    if work.slot(place.take).times(place.bone, place.property).is_empty() {
        begin::<K>(work, place, channel.interpolation);
    }
    let spline = is_spline::<K>(work, place);
    if spline {
        on_one_side::<K>(work, place, &mut given);
    }
    lay(work, place, given.iter().map(|given| given.key).collect(), Vec::new());
    if spline {
        smooth::<K>(work, place, &given);
    }
    forget_pending(work, place, &given);
    Ok(given.len())
}

fn read(work: &Work, place: Place, time: f32, key: &CopiedKey) -> Result<Given, EditError> {
    let count = if place.property == Property::Rotation { 4 } else { 3 };
    let after = finite("a time", key.after as f32).and(Ok(key.after))?;
    let time = key_time((f64::from(time) + after) as f32, work.slot(place.take))?;
    let mut value = numbers("a value", &key.value, count)?;
    if place.property == Property::Rotation {
        value = rotation(value)?.to_array();
    }
    let tangent =
        |given: &Option<Vec<f32>>| given.as_ref().map(|given| numbers("a tangent", given, count)).transpose();
    let (arrive, leave) = (tangent(&key.arrive)?, tangent(&key.leave)?);
    let original = [arrive.unwrap_or_default(), value, leave.unwrap_or_default()];
    Ok(Given { key: Key { time, original, change: None }, tangents: [arrive.is_some(), leave.is_some()] })
}

fn numbers(what: &'static str, given: &[f32], wanted: usize) -> Result<Numbers, EditError> {
    if given.len() != wanted {
        return Err(EditError::Count { what, wanted, given: given.len() });
    }
    let mut numbers = [0.0; 4];
    for (number, &given) in numbers.iter_mut().zip(given) {
        *number = finite(what, given)?;
    }
    Ok(numbers)
}

/// A channel without keys gets the way of the keys that come.
fn begin<K: Kind>(work: &mut Work, place: Place, between: Between) {
    let interpolation = match between {
        Between::Step => Interpolation::Step,
        Between::Linear => Interpolation::Linear,
        Between::CubicSpline => Interpolation::CubicSpline,
    };
    let Some(old) = work.slot(place.take).original_of::<K>(place.bone).cloned() else { return };
    if old.interpolation != interpolation {
        let times = Arc::clone(&old.times);
        let original = K::Value::wrap(Channel { interpolation, ..old });
        work.replace::<K>(place, Content { original, changes: Vec::new() }, &times);
    }
}

fn is_spline<K: Kind>(work: &Work, place: Place) -> bool {
    let channel = work.slot(place.take).original_of::<K>(place.bone);
    channel.is_some_and(|channel| channel.interpolation == Interpolation::CubicSpline)
}

/// q and -q are one rotation, but a spline from one to the other turns the long way: all of the keys on the side of the
/// key before them, or behind.
fn on_one_side<K: Kind>(work: &Work, place: Place, given: &mut [Given]) {
    let slot = work.slot(place.take);
    let (Some(first), Some(last)) = (given.first(), given.last()) else { return };
    if place.property != Property::Rotation {
        return;
    }
    let times = slot.times(place.bone, place.property);
    let before = times.partition_point(|&time| time < first.key.time - SAME_TIME).checked_sub(1);
    let after = times.partition_point(|&time| time <= last.key.time + SAME_TIME);
    let (beside, own) = match before {
        Some(before) => (before, first.key.original[1]),
        None => (after, last.key.original[1]),
    };
    let Some(beside) = slot.key::<K>(place.property, place.bone, beside) else { return };
    let beside = beside.change.map_or(beside.original, |change| change.result::<K>(&beside.original))[1];
    if beside.iter().zip(own).map(|(a, b)| a * b).sum::<f32>() < 0.0 {
        for number in given.iter_mut().flat_map(|given| given.key.original.iter_mut().flatten()) {
            *number = -*number;
        }
    }
}

/// Gives the keys of a spline that came without tangents some along their way.
fn smooth<K: Kind>(work: &mut Work, place: Place, given: &[Given]) {
    let slot = work.slot(place.take);
    let Some(channel) = slot.result.tracks.get(place.bone as usize).map(K::channel) else { return };
    let wanting = given.iter().filter(|given| given.tangents != [true; 2]);
    let keys: Vec<(u32, Key)> = wanting
        .filter_map(|given| {
            let at = key_at(&channel.times, given.key.time).ok()?;
            let slope = slope::<K>(channel, at);
            let [arrive, value, leave] = given.key.original;
            let side = |was: Numbers, given: bool| if given { was } else { slope };
            let original = [side(arrive, given.tangents[0]), value, side(leave, given.tangents[1])];
            Some((at as u32, Key { original, ..given.key }))
        })
        .collect();
    if !keys.is_empty() {
        let remove = keys.iter().map(|(at, _)| *at).collect();
        work.perform(Op::Splice(place, remove, keys));
    }
}

/// Where a key comes, nothing is pending of its channel any more.
fn forget_pending(work: &mut Work, place: Place, given: &[Given]) {
    let waiting: Vec<f32> = work.slot(place.take).pending().iter().map(|at| at.time).collect();
    let times: Vec<f32> = given.iter().map(|given| given.key.time).collect();
    for time in waiting.into_iter().filter(|&time| key_at(&times, time).is_ok()) {
        overwritten(work, place.take, time, &[(place.bone, place.property)]);
    }
}
