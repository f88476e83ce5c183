//! Channels that stand still in steps, before a pose is put on them.
//!
//! Exporters write a channel that does not move as two equal keys in steps, because that is the cheapest to play. It says
//! nothing about how the channel should move once it does: a pose that is keyed there would be jumped to.

use super::super::kind::{Held, Kind, Rotation, with_kind};
use super::super::op::Place;
use super::super::slot::{Content, TakeId};
use super::{EditError, Work};
use crate::document::edit::{BonePose, Property, TakeRef};
use dragonfly_anim::data::{Channel, Interpolation};
use std::sync::Arc;

/// What is no nearer than this moves.
const STILL: f32 = 1e-5;

/// The channels that `poses` give values to become linear where they stand still in steps. No pose differs for it.
pub(super) fn poses(work: &mut Work, take: &TakeRef, poses: &[BonePose]) -> Result<(), EditError> {
    let take = work.take(take)?;
    for pose in poses {
        let bone = work.bone(&pose.bone)?;
        let given = [pose.translation.is_some(), pose.rotation.is_some(), pose.scale.is_some()];
        for (property, _) in Property::ALL.into_iter().zip(given).filter(|(_, given)| *given) {
            channel(work, take, bone, property);
        }
    }
    Ok(())
}

/// The same for one channel.
pub(super) fn channel(work: &mut Work, take: TakeId, bone: u32, property: Property) {
    let place = Place { take, bone, property };
    with_kind!(property, of_kind::<K>(work, place));
}

fn of_kind<K: Kind>(work: &mut Work, place: Place) {
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
