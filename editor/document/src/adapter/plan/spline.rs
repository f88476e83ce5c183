//! How channels run between their keys.

use super::super::change::{KeyChange, Triple, add, put, subtract, triple};
use super::super::kind::{Held, Kind, Numbers, with_kind};
use super::super::op::{Op, Place};
use super::super::slot::Content;
use super::{EditError, Named, Work, finite, key_at};
use crate::edit::{Between, BoneRef, Property, TakeRef};
use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::sample::Value;
use std::sync::Arc;

pub(super) fn interpolate(
    work: &mut Work,
    take: &TakeRef,
    named: Named<'_>,
    between: Between,
) -> Result<(), EditError> {
    let take = work.take(take)?;
    let wanted = match between {
        Between::Step => Interpolation::Step,
        Between::Linear => Interpolation::Linear,
        Between::CubicSpline => Interpolation::CubicSpline,
    };
    let mut done = false;
    for place in work.channels(take, named)? {
        done |= with_kind!(place.property, channel::<K>(work, place, wanted));
    }
    if done { Ok(()) } else { Err(EditError::Nothing("the channels are like that already")) }
}

fn channel<K: Kind>(work: &mut Work, place: Place, wanted: Interpolation) -> bool {
    let slot = work.slot(place.take);
    let Some(old) = slot.original_of::<K>(place.bone).cloned() else { return false };
    if old.is_empty() || old.interpolation == wanted {
        return false;
    }
    let old_changes = slot.changes(place.bone, place.property).to_vec();
    let result = slot.result.tracks.get(place.bone as usize).map(K::channel).cloned().unwrap_or_default();
    let was_spline = old.interpolation == Interpolation::CubicSpline;
    let is_spline = wanted == Interpolation::CubicSpline;
    let old_times = Arc::clone(&old.times);
    let (original, changes) = if is_spline {
        (smooth::<K>(&old), tangent_changes::<K>(&old, &result, &old_changes))
    } else if was_spline {
        let values: Vec<K::Value> = (0..old.len()).filter_map(|key| old.value(key)).collect();
        let flat = |change: KeyChange| KeyChange::of_value(change.value).some::<K>();
        let changes = old_changes.iter().filter_map(|&(key, change)| Some((key, flat(change)?))).collect();
        (Channel { values: values.into(), interpolation: wanted, ..old }, changes)
    } else {
        (Channel { interpolation: wanted, ..old }, old_changes)
    };
    work.replace::<K>(place, Content { original: K::Value::wrap(original), changes }, &old_times);
    true
}

/// The same keys with tangents along the way from the key before to the key after (Catmull and Rom, for uneven times).
fn smooth<K: Kind>(channel: &Channel<K::Value>) -> Channel<K::Value> {
    let mut values = vec![K::Value::ZERO; channel.len() * 3];
    for key in 0..channel.len() {
        let slope = slope::<K>(channel, key);
        put::<K>(&mut values, Interpolation::CubicSpline, key, &[slope, value::<K>(channel, key), slope]);
    }
    Channel {
        times: Arc::clone(&channel.times),
        values: values.into(),
        interpolation: Interpolation::CubicSpline,
    }
}

fn value<K: Kind>(channel: &Channel<K::Value>, key: usize) -> Numbers {
    triple::<K>(channel, key)[1]
}

/// Units a second at a key: the way from its neighbours, at either end the way from or to the only one.
pub(super) fn slope<K: Kind>(channel: &Channel<K::Value>, key: usize) -> Numbers {
    let (before, after) = (key.saturating_sub(1), (key + 1).min(channel.len() - 1));
    let seconds = channel.times[after] - channel.times[before];
    let middle = value::<K>(channel, key);
    // Rotations: q and -q are one; both neighbours on the side of this key.
    let near = |numbers: Numbers| {
        let dot: f32 = numbers.iter().zip(middle).map(|(a, b)| a * b).sum();
        let turn = K::IDENTITY == [0.0, 0.0, 0.0, 1.0];
        if turn && dot < 0.0 { numbers.map(|number| -number) } else { numbers }
    };
    let way = subtract(near(value::<K>(channel, after)), near(value::<K>(channel, before)));
    if seconds > 0.0 { way.map(|number| number / seconds) } else { [0.0; 4] }
}

/// Changes of a channel that becomes a spline: the result gets the tangents of its own way.
fn tangent_changes<K: Kind>(
    original: &Channel<K::Value>,
    result: &Channel<K::Value>,
    changes: &[(u32, KeyChange)],
) -> Vec<(u32, KeyChange)> {
    if changes.is_empty() {
        return Vec::new();
    }
    let changed = |key: usize| changes.binary_search_by_key(&(key as u32), |(key, _)| *key).ok();
    let change = |key: usize| {
        let change = changed(key).map_or(KeyChange::identity::<K>(), |at| changes[at].1);
        let wanted = slope::<K>(result, key);
        let own = slope::<K>(original, key);
        let [arrive, _, leave] = change.result::<K>(&[own, value::<K>(original, key), own]);
        let change = KeyChange {
            arrive: add(change.arrive, subtract(wanted, arrive)),
            leave: add(change.leave, subtract(wanted, leave)),
            ..change
        };
        Some((key as u32, change.some::<K>()?))
    };
    // A changed key bends the way through its neighbours, too.
    let near = |key: &usize| {
        let around = key.saturating_sub(1)..=(key + 1);
        around.into_iter().any(|key| changed(key).is_some())
    };
    (0..original.len()).filter(near).filter_map(change).collect()
}

pub(super) fn tangents(
    work: &mut Work,
    take: &TakeRef,
    time: f32,
    bone: &BoneRef,
    property: Property,
    wanted: [Option<&[f32]>; 2],
) -> Result<(), EditError> {
    let take = work.take(take)?;
    finite("a time", time)?;
    let bone = work.bone(bone)?;
    if bone as usize >= work.slot(take).original.tracks.len() {
        return Err(EditError::NoTrack(bone));
    }
    let count = if property == Property::Rotation { 4 } else { 3 };
    let [arrive, leave] = wanted.map(|numbers| numbers.map(|numbers| numbers_of(numbers, count)).transpose());
    let (arrive, leave) = (arrive?, leave?);
    if arrive.is_none() && leave.is_none() {
        return Err(EditError::Nothing("no tangent is given"));
    }
    let place = Place { take, bone, property };
    let key = key_at(work.slot(take).times(bone, property), time).map_err(|_| EditError::NoKey {
        bone,
        property,
        time,
    })?;
    with_kind!(property, set_tangents::<K>(work, place, key, arrive, leave))
}

fn numbers_of(given: &[f32], wanted: usize) -> Result<Numbers, EditError> {
    if given.len() != wanted {
        return Err(EditError::Count { what: "a tangent", wanted, given: given.len() });
    }
    let mut numbers = [0.0; 4];
    for (number, &given) in numbers.iter_mut().zip(given) {
        *number = finite("a tangent", given)?;
    }
    Ok(numbers)
}

fn set_tangents<K: Kind>(
    work: &mut Work,
    place: Place,
    key: usize,
    arrive: Option<Numbers>,
    leave: Option<Numbers>,
) -> Result<(), EditError> {
    let slot = work.slot(place.take);
    let spline = slot
        .original_of::<K>(place.bone)
        .is_some_and(|channel| channel.interpolation == Interpolation::CubicSpline);
    if !spline {
        return Err(EditError::NoSpline { bone: place.bone, property: place.property });
    }
    let Some(found) = slot.key::<K>(place.property, place.bone, key) else { return Ok(()) };
    let now: Triple = found.change.map_or(found.original, |change| change.result::<K>(&found.original));
    let before = found.change.unwrap_or(KeyChange::identity::<K>());
    let plain = KeyChange { arrive: [0.0; 4], leave: [0.0; 4], ..before }.result::<K>(&found.original);
    let more = |wanted: Option<Numbers>, side: usize, old: Numbers| match wanted {
        Some(wanted) if wanted != now[side] => subtract(wanted, plain[side]),
        _ => old,
    };
    let change =
        KeyChange { arrive: more(arrive, 0, before.arrive), leave: more(leave, 2, before.leave), ..before };
    work.perform(Op::Changes(place, vec![(key as u32, change.some::<K>())]));
    Ok(())
}
