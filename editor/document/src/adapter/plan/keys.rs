//! Keys made and deleted (thesis §2.2.2.4).

use super::super::change::{KeyChange, Triple};
use super::super::kind::{Kind, with_kind};
use super::super::op::{Op, Place};
use super::super::slot::{Key, Slot};
use super::{EditError, Named, Work, key_at, key_time, rest};
use crate::edit::{KeySet, NewKey, TakeRef};
use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::sample::mix::hermite_slope;
use dragonfly_anim::sample::{find_keys, sample_channel};

pub(super) fn add(
    work: &mut Work,
    take: &TakeRef,
    time: f32,
    named: Named<'_>,
    value: NewKey,
    keyed_only: bool,
) -> Result<(), EditError> {
    let take = work.take(take)?;
    key_time(time, work.slot(take))?;
    let mut added = false;
    for place in work.channels(take, named)? {
        let times = work.slot(take).times(place.bone, place.property);
        // What does not move gets keys only when it is named.
        let wanted = !times.is_empty() || !(named.0.is_empty() || keyed_only);
        if wanted && key_at(times, time).is_err() {
            with_kind!(place.property, insert::<K>(work, place, time, value));
            added = true;
        }
    }
    if added { Ok(()) } else { Err(EditError::Nothing("there are keys at that time")) }
}

pub(super) fn delete(work: &mut Work, take: &TakeRef, sets: &[KeySet]) -> Result<(), EditError> {
    let take = work.take(take)?;
    let found = work.keys(take, sets)?;
    let gone: usize = found.iter().map(|(_, keys)| keys.len()).sum();
    // Weights of morph targets are no key-frame of a bone.
    let there: usize = work.slot(take).original.tracks.iter().map(|track| track.keys()).sum();
    if gone >= there {
        return Err(EditError::LastKey);
    }
    for (place, keys) in found {
        work.perform(Op::Splice(place, keys, Vec::new()));
    }
    Ok(())
}

/// Adds a key where none is; its position.
pub(super) fn insert<K: Kind>(work: &mut Work, place: Place, time: f32, value: NewKey) -> usize {
    let slot = work.slot(place.take);
    let at = slot.times(place.bone, place.property).partition_point(|&key| key < time);
    let key = match value {
        NewKey::Predecessor => slot.key::<K>(place.property, place.bone, at.saturating_sub(1)),
        NewKey::Current => None,
    };
    let key = key.unwrap_or_else(|| current::<K>(work, slot, place, time));
    work.perform(Op::Splice(place, Vec::new(), vec![(at as u32, Key { time, ..key })]));
    at
}

/// A key that holds what original and result show at `time`, so that both curves stay as they are.
pub(super) fn current<K: Kind>(work: &Work, slot: &Slot, place: Place, time: f32) -> Key {
    let rest = rest::<K>(work, place.bone);
    let shown = |channel: &Channel<K::Value>| -> Triple {
        let [arrive, leave] = slopes::<K>(channel, time);
        [arrive, K::numbers(K::as_key(sample_channel(channel, rest, time))), leave]
    };
    let (original, result) =
        (&slot.original.tracks[place.bone as usize], &slot.result.tracks[place.bone as usize]);
    let original = shown(K::channel(original));
    let change = match KeyChange::between::<K>(&original, &shown(K::channel(result))) {
        Some(change) => change,
        // No change leads there: the key before knows one that is near.
        None => {
            let times = slot.times(place.bone, place.property);
            let before = times.partition_point(|&key| key < time).saturating_sub(1);
            slot.key_change(place.bone, place.property, before)
        }
    };
    Key { time, original, change }
}

/// How fast a spline changes at `time`, a second: what a key there must have as tangents to leave the curve as it is.
/// Zero for everything that is no spline, and outside its keys on the far side.
fn slopes<K: Kind>(channel: &Channel<K::Value>, time: f32) -> [super::super::kind::Numbers; 2] {
    const NONE: [f32; 4] = [0.0; 4];
    let Some(keys) = find_keys(&channel.times, time) else { return [NONE; 2] };
    if channel.interpolation != Interpolation::CubicSpline || keys.before == keys.after {
        return [NONE; 2];
    }
    let at = |index: usize| channel.values.get(index).map_or(NONE, |&value| K::numbers(value));
    let span = channel.times[keys.after] - channel.times[keys.before];
    let (from, leave) = (at(keys.before * 3 + 1), at(keys.before * 3 + 2));
    let (arrive, to) = (at(keys.after * 3), at(keys.after * 3 + 1));
    let slope = std::array::from_fn(|axis| {
        hermite_slope(from[axis], leave[axis], arrive[axis], to[axis], span, keys.mix)
    });
    [slope, slope]
}
