//! Step channels that do not move, before they get a pose.
//!
//! Exporters write a channel that does not move as two equal keys with step interpolation, because that is the
//! cheapest to play. That interpolation is not meant for a channel that moves: the bone would jump to a pose that is
//! keyed there.

use super::super::kind::{ChannelKind, ChannelValue, RotationChannel};
use super::super::op::ChannelAddress;
use super::super::slot::ChannelContent;
use super::Transaction;
use dragonfly_anim::data::{Channel, Interpolation};
use std::sync::Arc;

/// Relative difference below which two keys are equal.
const STILL: f32 = 1e-5;

/// Makes a step channel linear if it does not move. No pose changes by that.
pub(crate) fn channel<K: ChannelKind>(work: &mut Transaction, address: ChannelAddress) {
    let slot = work.slot(address.take);
    let Some(old) = slot.original_of::<K>(address.bone).cloned() else { return };
    let Some(result) = slot.result.tracks.get(address.bone as usize).map(K::channel) else { return };
    if old.interpolation != Interpolation::Step || !stands_still::<K>(&old) || !stands_still::<K>(result) {
        return;
    }
    let changes = slot.changes(address.bone, address.property).to_vec();
    let old_times = Arc::clone(&old.times);
    let original = K::Value::wrap(Channel { interpolation: Interpolation::Linear, ..old });
    work.replace::<K>(address, ChannelContent { original, changes }, &old_times);
}

/// Returns whether a channel consists of two equal keys. More equal keys were set one by one to hold a pose, and stay steps.
fn stands_still<K: ChannelKind>(channel: &Channel<K::Value>) -> bool {
    let [first, last] = channel.values[..] else { return false };
    let [first, last] = [first, last].map(K::numbers);
    // A value that an exporter computed twice differs in its last digit; q and -q are the same rotation.
    let apart = |sign: f32| {
        let pairs = first.iter().zip(last);
        pairs.map(|(a, b)| (a - sign * b).abs() / (1.0 + a.abs())).fold(0.0, f32::max)
    };
    let turn = K::IDENTITY == RotationChannel::IDENTITY;
    apart(1.0) <= STILL || (turn && apart(-1.0) <= STILL)
}
