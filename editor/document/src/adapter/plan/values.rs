//! New values for keys that stay at their times.

use super::super::change::{KeyChange, add, subtract};
use super::super::kind::{ChannelKind, ChannelNumbers, RotationChannel, with_kind};
use super::super::op::{ChannelAddress, Op};
use super::super::slot::{KeyContent, TakeId};
use super::pose::changed;
use super::spline::slope;
use super::{EditError, Transaction, finite, morph, rest};
use crate::edit::target::KeySet;
use dragonfly_anim::data::{Channel, Interpolation, MorphTrack};
use dragonfly_anim::sample::Value;
use std::sync::Arc;

/// A tool that gives keys new values.
pub(crate) trait ValueTool {
    /// Returns new values for the `chosen` keys of a channel of a bone; `None` where they stay. `values` are those of all keys.
    fn bone_values<K: ChannelKind>(
        &self,
        work: &Transaction,
        address: ChannelAddress,
        values: &[K::Value],
        chosen: &[u32],
    ) -> Result<Option<Vec<K::Value>>, EditError>;

    /// Returns new weights for the `chosen` keys of one target of a track; `None` where they stay. `weights` are those of all keys.
    fn shape_weights(
        &self,
        work: &Transaction,
        track: &MorphTrack,
        target: usize,
        weights: &[f32],
        chosen: &[u32],
    ) -> Result<Option<Vec<f32>>, EditError>;
}

/// Gives new values to keys of bones, and to keys of morph targets in stretches of time.
pub(crate) fn change_values(
    work: &mut Transaction,
    take: TakeId,
    keys: &[KeySet],
    shapes: &[[f32; 2]],
    tool: &impl ValueTool,
) -> Result<(), EditError> {
    if !keys.is_empty() || shapes.is_empty() {
        for (address, chosen) in work.keys(take, keys)? {
            with_kind!(address.property, of_channel::<K>(work, address, &chosen, tool))?;
        }
    }
    morph::change_weights(work, take, shapes, keys.is_empty(), tool)
}

fn of_channel<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    chosen: &[u32],
    tool: &impl ValueTool,
) -> Result<(), EditError> {
    let slot = Arc::clone(work.slot(address.take));
    let Some(channel) = slot.result.tracks.get(address.bone as usize).map(K::channel) else { return Ok(()) };
    let rest = rest::<K>(work, address);
    let mut values: Vec<K::Value> =
        (0..channel.len()).map(|key| channel.value(key).map_or(rest, |value| value.healed(rest))).collect();
    let Some(wanted) = tool.bone_values::<K>(work, address, &values, chosen)? else { return Ok(()) };
    let times = Arc::clone(&channel.times);
    let numbers =
        |values: &[K::Value]| Channel::new(Arc::clone(&times), values.to_vec(), Interpolation::Linear);
    let spline = channel.interpolation == Interpolation::CubicSpline;
    let old = spline.then(|| numbers(&values));
    let mut changes: Vec<(u32, Option<KeyChange>)> = Vec::new();
    for (&key, wanted) in chosen.iter().zip(wanted) {
        if wanted == values[key as usize] {
            continue;
        }
        let Some(found) = slot.key::<K>(address.property, address.bone, key as usize) else { continue };
        let change = changed::<K>(address.bone, &found, |_| wanted)?;
        values[key as usize] = K::value(result::<K>(change, &found)[1]);
        changes.push((key, change));
    }
    if changes.is_empty() {
        return Ok(());
    }
    if let Some(old) = old {
        let new = numbers(&values);
        let mut changed = changes.into_iter().peekable();
        changes = Vec::new();
        for &key in chosen {
            let Some(found) = slot.key::<K>(address.property, address.bone, key as usize) else { continue };
            let change = changed.next_if(|(other, _)| *other == key);
            let slopes = [&old, &new].map(|channel| slope::<K>(channel, key as usize));
            if change.is_some() || slopes[0] != slopes[1] {
                let change = change.map_or(found.change, |(_, change)| change);
                changes.push((key, with_slope::<K>(&found, change, slopes)?));
            }
        }
    }
    work.perform(Op::Changes(address, changes));
    Ok(())
}

fn result<K: ChannelKind>(change: Option<KeyChange>, found: &KeyContent) -> [ChannelNumbers; 3] {
    change.map_or(found.original, |change| change.result::<K>(&found.original))
}

/// Returns the change with tangents that change as the slope at the key does. A tangent of a rotation is turned with its value first.
fn with_slope<K: ChannelKind>(
    found: &KeyContent,
    change: Option<KeyChange>,
    [old_slope, new_slope]: [ChannelNumbers; 2],
) -> Result<Option<KeyChange>, EditError> {
    let before = result::<K>(found.change, found);
    let after = result::<K>(change, found);
    let turns = K::IDENTITY == RotationChannel::IDENTITY && before[1] != after[1];
    let turn = if turns {
        RotationChannel::change(RotationChannel::value(before[1]), RotationChannel::value(after[1]))
    } else {
        None
    };
    let carried = |tangent: ChannelNumbers| match turn {
        Some(turn) => {
            RotationChannel::numbers(RotationChannel::tangent(RotationChannel::value(tangent), turn))
        }
        None => tangent,
    };
    let more = subtract(new_slope, carried(old_slope));
    let change = change.unwrap_or(KeyChange::identity::<K>());
    let plain = KeyChange { arrive: [0.0; 4], leave: [0.0; 4], ..change }.result::<K>(&found.original);
    let added = |side: usize| subtract(add(carried(before[side]), more), plain[side]);
    let change = KeyChange { arrive: added(0), leave: added(2), ..change };
    let numbers = change.result::<K>(&found.original);
    let largest = numbers.iter().flatten().fold(0.0_f32, |largest, number| largest.max(number.abs()));
    finite("the result", largest)?;
    Ok(change.some::<K>())
}
