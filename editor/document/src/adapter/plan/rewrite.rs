//! Channels that an algorithm computed as a whole: as keys with their originals and changes.

use super::super::change::{KeyChange, triple};
use super::super::kind::{ChannelKind, ChannelValue, with_kind};
use super::super::op::ChannelAddress;
use super::super::slot::{ChannelContent, TakeId};
use super::keys::current;
use super::{EditError, Transaction, finite, key_time, list};
use crate::edit::target::Property;
use dragonfly_anim::data::{Channel, Take};
use std::sync::Arc;

/// Gives the take the channels of `wanted`. Channels that are equal already are left alone. Returns whether one changed.
///
/// A key at the time of an earlier one keeps its original; the difference becomes its change. A new key has the original
/// curve at its time as its original. Where the interpolation changes, the original is replaced.
pub(crate) fn channels(work: &mut Transaction, take: TakeId, wanted: &Take) -> Result<bool, EditError> {
    let mut changed = false;
    for track in &wanted.tracks {
        for property in Property::ALL {
            let address = ChannelAddress { take, bone: track.bone, property };
            changed |= with_kind!(property, channel::<K>(work, address, track))?;
        }
    }
    Ok(changed)
}

fn channel<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    track: &dragonfly_anim::data::Track,
) -> Result<bool, EditError> {
    let wanted = K::channel(track);
    let slot = Arc::clone(work.slot(address.take));
    let shown = slot.result.tracks.get(address.bone as usize).map(K::channel);
    let Some(shown) = shown else {
        return if wanted.is_empty() { Ok(false) } else { Err(EditError::NoTrack(address.bone)) };
    };
    if shown == wanted {
        return Ok(false);
    }
    for &time in wanted.times.iter() {
        key_time(time, &slot)?;
    }
    for &value in wanted.values.iter() {
        for number in K::numbers(value) {
            finite("the result", number)?;
        }
    }
    work.room_for(address, wanted.len().saturating_sub(shown.len()))?;
    let content = if shown.interpolation == wanted.interpolation || shown.is_empty() {
        kept::<K>(work, address, wanted)?
    } else {
        ChannelContent { original: K::Value::wrap(wanted.clone()), changes: Vec::new() }
    };
    let old_times = Arc::clone(slot.times(address.bone, address.property));
    work.replace::<K>(address, content, &old_times);
    Ok(true)
}

/// Returns the wanted keys as originals and changes.
fn kept<K: ChannelKind>(
    work: &Transaction,
    address: ChannelAddress,
    wanted: &Channel<K::Value>,
) -> Result<ChannelContent, EditError> {
    let slot = work.slot(address.take);
    let times = slot.times(address.bone, address.property);
    let mut values = list(wanted.values.len())?;
    let mut changes = Vec::new();
    for (key, &time) in wanted.times.iter().enumerate() {
        let result = triple::<K>(wanted, key);
        let at = times.partition_point(|&other| other < time);
        let old = (times.get(at) == Some(&time))
            .then(|| slot.key::<K>(address.property, address.bone, at))
            .flatten()
            .map(|found| found.original);
        let original = match old {
            Some(original) => original,
            None if times.is_empty() => result,
            None => current::<K>(work, slot, address, time).original,
        };
        let (original, change) = match KeyChange::between::<K>(&original, &result) {
            Some(change) => (original, change),
            None => (result, None),
        };
        changes.extend(change.map(|change| (key as u32, change)));
        let [arrive, value, leave] = original.map(K::value);
        if wanted.values_per_key() == 3 {
            values.extend([arrive, value, leave]);
        } else {
            values.push(value);
        }
    }
    let original = Channel {
        times: Arc::clone(&wanted.times),
        values: values.into(),
        interpolation: wanted.interpolation,
    };
    Ok(ChannelContent { original: K::Value::wrap(original), changes })
}
