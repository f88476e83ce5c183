//! Pending poses: selected, removed, replaced by keys, and moved when the times of a take change.

use super::super::op::Op;
use super::super::pending::{PendingAt, remapped};
use super::super::slot::TakeId;
use super::{EditError, Transaction, finite};
use crate::edit::target::{BoneRef, Property};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Returns the pending poses at one time or at all times, of some bones or of all where none is named. Weights of shape keys are among
/// them if no bone is named, or with `shapes`.
///
/// # Errors
///
/// A bone does not exist, or no pose is pending there.
pub(crate) fn selected(
    work: &Transaction,
    take: TakeId,
    time: Option<f32>,
    bones: &[BoneRef],
    shapes: bool,
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
        let shapes = if shapes || bones.is_empty() { at.shapes.clone() } else { Vec::new() };
        PendingAt { time: at.time, poses, shapes }
    };
    let found: Vec<PendingAt> = there.into_iter().map(part).filter(|at| !at.is_empty()).collect();
    if found.is_empty() { Err(EditError::Nothing("no pose is pending there")) } else { Ok(found) }
}

/// Removes poses, all channels of their bones, and weights.
pub(crate) fn remove(work: &mut Transaction, take: TakeId, gone: &PendingAt) {
    let Some(at) = work.slot(take).pending_at(gone.time) else { return };
    let kept = at.poses.iter().filter(|pose| gone.of(pose.bone).is_none()).copied().collect();
    let mut kept = PendingAt { time: at.time, poses: kept, shapes: at.shapes.clone() };
    for shape in &gone.shapes {
        kept.set_shape(shape.instance, shape.shape, None);
    }
    put(work, take, kept);
}

/// Removes pending weights of shape keys, by mesh and index, that got another weight at this time.
pub(crate) fn shapes_overwritten(
    work: &mut Transaction,
    take: TakeId,
    time: f32,
    shapes: impl IntoIterator<Item = (u32, u32)>,
) {
    let Some(at) = work.slot(take).pending_at(time) else { return };
    let mut at = PendingAt::clone(at);
    let mut met = false;
    for (instance, shape) in shapes {
        met |= at.set_shape(instance, shape, None);
    }
    if met {
        put(work, take, at);
    }
}

/// Removes pending values of channels that got another value at this time. Returns whether there were any.
pub(crate) fn overwritten(
    work: &mut Transaction,
    take: TakeId,
    time: f32,
    channels: &[(u32, Property)],
) -> bool {
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

fn put(work: &mut Transaction, take: TakeId, at: PendingAt) {
    let time = at.time;
    let some = (!at.is_empty()).then(|| Arc::new(at));
    work.perform(Op::Pending(take, time, some));
}

/// Moves pending poses to the times that `to` returns, and removes those for which it returns `None`.
pub(crate) fn remap(work: &mut Transaction, take: TakeId, to: impl Fn(f32) -> Option<f32>) {
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
