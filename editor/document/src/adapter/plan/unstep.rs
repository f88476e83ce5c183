//! Channels that stand still in steps, before a pose is put on them.
//!
//! Exporters write a channel that does not move as two equal keys in steps, because that is the cheapest to play. It says
//! nothing about how the channel should move once it does: a pose that is keyed there would be jumped to.

use super::super::kind::{Held, Kind, Rotation};
use super::super::op::Place;
use super::super::slot::Content;
use super::Work;
use dragonfly_anim::data::{Channel, Interpolation};
use std::sync::Arc;

/// What is no nearer than this moves.
const STILL: f32 = 1e-5;

/// The channel becomes linear where it stands still in steps. No pose differs for it.
pub(super) fn channel<K: Kind>(work: &mut Work, place: Place) {
    let slot = work.slot(place.take);
    let Some(old) = slot.original_of::<K>(place.bone).cloned() else { return };
    let Some(result) = slot.result.tracks.get(place.bone as usize).map(K::channel) else { return };
    if old.interpolation != Interpolation::Step || !stands_still::<K>(&old) || !stands_still::<K>(result) {
        return;
    }
    let changes = slot.changes(place.bone, place.property).to_vec();
    let old_times = Arc::clone(&old.times);
    let original = K::Value::wrap(Channel { interpolation: Interpolation::Linear, ..old });
    work.replace::<K>(place, Content { original, changes }, &old_times);
}

/// More keys that are alike were put there one by one, for poses that hold; they stay steps.
fn stands_still<K: Kind>(channel: &Channel<K::Value>) -> bool {
    let [first, last] = channel.values[..] else { return false };
    let [first, last] = [first, last].map(K::numbers);
    // What an exporter computed twice differs by a last digit; q and -q are one rotation.
    let apart = |sign: f32| {
        let pairs = first.iter().zip(last);
        pairs.map(|(a, b)| (a - sign * b).abs() / (1.0 + a.abs())).fold(0.0, f32::max)
    };
    let turn = K::IDENTITY == Rotation::IDENTITY;
    apart(1.0) <= STILL || (turn && apart(-1.0) <= STILL)
}
