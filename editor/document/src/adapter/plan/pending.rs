//! Poses that wait to be keyed: kept, keyed, dropped, taken along when a take gets another clock.

use super::super::kind::{Kind, Rotation, Scale, Translation, with_kind};
use super::super::op::{Op, Place};
use super::super::pending::{PendingAt, remapped};
use super::super::slot::TakeId;
use super::pose::{self, Way, rotation, vector};
use super::{EditError, Work, finite, key_time};
use crate::edit::{BonePose, BoneRef, Property, TakeRef};
use std::collections::BTreeSet;
use std::sync::Arc;

const NONE: EditError = EditError::Nothing("no pose is pending there");

pub(super) fn pend(work: &mut Work, take: &TakeRef, time: f32, poses: &[BonePose]) -> Result<(), EditError> {
    let take = work.take(take)?;
    key_time(time, work.slot(take))?;
    let mut at = match work.slot(take).pending_at(time) {
        Some(at) => PendingAt::clone(at),
        None => PendingAt { time, poses: Vec::new() },
    };
    let mut met = false;
    for pose in poses {
        let bone = work.bone(&pose.bone)?;
        if bone as usize >= work.slot(take).original.tracks.len() {
            return Err(EditError::NoTrack(bone));
        }
        let values = [
            pose.translation.map(|given| vector("a translation", given).map(Translation::numbers)),
            pose.rotation.map(|given| rotation(given).map(Rotation::numbers)),
            pose.scale.map(|given| vector("a scale", given).map(Scale::numbers)),
        ];
        for (property, value) in Property::ALL.into_iter().zip(values) {
            if let Some(value) = value {
                at.entry(bone).set(property, Some(value?));
                met = true;
            }
        }
    }
    if !met {
        return Err(EditError::Nothing("no pose is given"));
    }
    let time = at.time;
    work.perform(Op::Pending(take, time, Some(Arc::new(at))));
    Ok(())
}

/// Turns pending poses into keys, those at one time or all, of some bones or of all.
pub(super) fn key(
    work: &mut Work,
    take: &TakeRef,
    time: Option<f32>,
    bones: &[BoneRef],
    unstep: bool,
) -> Result<(), EditError> {
    let take = work.take(take)?;
    for at in meant(work, take, time, bones)? {
        for pose in &at.poses {
            for property in Property::ALL {
                if let Some(value) = pose.get(property) {
                    let place = Place { take, bone: pose.bone, property };
                    with_kind!(property, one::<K>(work, place, at.time, value, unstep))?;
                }
            }
        }
        forget(work, take, &at);
    }
    Ok(())
}

fn one<K: Kind>(
    work: &mut Work,
    place: Place,
    time: f32,
    value: [f32; 4],
    unstep: bool,
) -> Result<(), EditError> {
    pose::one::<K>(work, place, time, K::value(value), Way::Set, unstep)
}

pub(super) fn drop(
    work: &mut Work,
    take: &TakeRef,
    time: Option<f32>,
    bones: &[BoneRef],
) -> Result<(), EditError> {
    let take = work.take(take)?;
    for at in meant(work, take, time, bones)? {
        forget(work, take, &at);
    }
    Ok(())
}

/// The poses that are meant; at least one.
fn meant(
    work: &Work,
    take: TakeId,
    time: Option<f32>,
    bones: &[BoneRef],
) -> Result<Vec<PendingAt>, EditError> {
    let slot = work.slot(take);
    let wanted: BTreeSet<u32> = bones.iter().map(|bone| work.bone(bone)).collect::<Result<_, _>>()?;
    let there: Vec<&Arc<PendingAt>> = match time {
        Some(time) => slot.pending_at(finite("a time", time)?).into_iter().collect(),
        None => slot.pending().iter().collect(),
    };
    let part = |at: &Arc<PendingAt>| {
        let is_wanted = |bone: u32| bones.is_empty() || wanted.contains(&bone);
        let poses = at.poses.iter().filter(|pose| is_wanted(pose.bone)).copied().collect();
        PendingAt { time: at.time, poses }
    };
    let found: Vec<PendingAt> = there.into_iter().map(part).filter(|at| !at.poses.is_empty()).collect();
    if found.is_empty() { Err(NONE) } else { Ok(found) }
}

/// Takes poses away, all channels of their bones.
fn forget(work: &mut Work, take: TakeId, gone: &PendingAt) {
    let Some(at) = work.slot(take).pending_at(gone.time) else { return };
    let kept = at.poses.iter().filter(|pose| gone.of(pose.bone).is_none()).copied().collect();
    put(work, take, PendingAt { time: at.time, poses: kept });
}

/// Of channels that were given another pose nothing is pending any more: at this time the newest counts. Did anything?
pub(super) fn overwritten(work: &mut Work, take: TakeId, time: f32, channels: &[(u32, Property)]) -> bool {
    let Some(at) = work.slot(take).pending_at(time) else { return false };
    let mut at = PendingAt::clone(at);
    let mut met = false;
    for &(bone, property) in channels {
        let entry = at.entry(bone);
        met |= entry.get(property).is_some();
        entry.set(property, None);
    }
    if met {
        at.poses.retain(|pose| !pose.is_empty());
        put(work, take, at);
    }
    met
}

fn put(work: &mut Work, take: TakeId, at: PendingAt) {
    let time = at.time;
    let some = (!at.poses.is_empty()).then(|| Arc::new(at));
    work.perform(Op::Pending(take, time, some));
}

/// Takes pending poses along to other times; those of which `to` says `None` go.
pub(super) fn moved(work: &mut Work, take: TakeId, to: impl Fn(f32) -> Option<f32>) {
    let old = work.slot(take).pending().to_vec();
    let new = remapped(&old, to);
    if new == old {
        return;
    }
    for at in old {
        work.perform(Op::Pending(take, at.time, None));
    }
    for at in new {
        work.perform(Op::Pending(take, at.time, Some(at)));
    }
}
