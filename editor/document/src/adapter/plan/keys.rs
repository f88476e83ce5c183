//! New keys of a channel.

use super::super::change::{KeyChange, Triple};
use super::super::kind::{ChannelKind, ChannelNumbers};
use super::super::op::{ChannelAddress, Op};
use super::super::slot::{KeyContent, TakeVersions};
use super::{Transaction, layer, rest};
use crate::edit::NewKey;
use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::sample::mix::hermite_slope;
use dragonfly_anim::sample::{find_keys, sample_channel};

/// Adds a key at a time without one, and returns its position.
pub(crate) fn insert<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    time: f32,
    value: NewKey,
) -> usize {
    let slot = work.slot(address.take);
    let at = slot.times(address.bone, address.property).partition_point(|&key| key < time);
    let key = match value {
        NewKey::Predecessor => slot.key::<K>(address.property, address.bone, at.saturating_sub(1)),
        NewKey::Current => None,
    };
    let key = key.unwrap_or_else(|| current::<K>(work, slot, address, time));
    work.perform(Op::Splice(address, Vec::new(), vec![(at as u32, KeyContent { time, ..key })]));
    at
}

/// Returns a key with the values of original and result at `time`, so that both curves stay as they are.
pub(crate) fn current<K: ChannelKind>(
    work: &Transaction,
    slot: &TakeVersions,
    address: ChannelAddress,
    time: f32,
) -> KeyContent {
    let rest = layer::below::<K>(work, address, time).unwrap_or_else(|| rest::<K>(work, address));
    let shown = |channel: &Channel<K::Value>| -> Triple {
        let [arrive, leave] = slopes::<K>(channel, time);
        [arrive, K::numbers(K::as_key(sample_channel(channel, rest, time))), leave]
    };
    let (original, result) =
        (&slot.original.tracks[address.bone as usize], &slot.result.tracks[address.bone as usize]);
    let original = shown(K::channel(original));
    let change = match KeyChange::between::<K>(&original, &shown(K::channel(result))) {
        Some(change) => change,
        // No change turns the original into the result; the change of the key before comes close to it.
        None => {
            let times = slot.times(address.bone, address.property);
            let before = times.partition_point(|&key| key < time).saturating_sub(1);
            slot.key_change(address.bone, address.property, before)
        }
    };
    KeyContent { time, original, change }
}

/// Returns the slope of a spline at `time`, per second: the tangents that a key there needs to leave the curve as it is. Zero for other
/// interpolations and outside the keys.
fn slopes<K: ChannelKind>(channel: &Channel<K::Value>, time: f32) -> [ChannelNumbers; 2] {
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
