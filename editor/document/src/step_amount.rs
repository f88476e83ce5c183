//! The amount by which a step of the history moves, rotates or scales one bone.

use super::adapter::ModelAdapter;
use super::adapter::plan::PoseMode;
use super::edit::{BonePose, Edit};
use dragonfly_anim::data::{BoneIndex, Transform};
use dragonfly_anim::sample::{rest_pose, sample_track};
use glam::{Quat, Vec3};

/// The time of a step, and the amount by which it changes the only bone that it gives values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepAmount {
    /// Seconds; `None` where the step changes keys at several times.
    pub time: Option<f32>,
    /// The change; `None` where the step changes several bones or properties.
    pub change: Option<PoseChange>,
}

/// The change of one property of a bone, in the space of its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PoseChange {
    /// Distance in units of the model.
    Translation(Vec3),
    /// Rotation from the pose before to the pose after.
    Rotation(Quat),
    /// Factors per axis.
    Scale(Vec3),
}

/// The pose of a bone before a step, from which its amount is measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseBefore {
    bone: BoneIndex,
    pose: Transform,
}

impl PoseBefore {
    /// Returns the pose before an edit that sets the pose of one bone; `None` for other edits.
    pub(super) fn of(adapter: &ModelAdapter, edit: &Edit) -> Option<Self> {
        let (time, [pose], PoseMode::Set) = edit.values()? else { return None };
        let bone = adapter.bone(&pose.bone).ok()?;
        Some(Self { bone, pose: shown(adapter, edit, bone, time)? })
    }
}

impl StepAmount {
    /// Returns the amount of an edit that was applied to the document; `None` where it neither sets nor offsets poses.
    pub(super) fn of(adapter: &ModelAdapter, edit: &Edit, before: Option<PoseBefore>) -> Option<Self> {
        let (time, poses) = match edit.values() {
            Some((time, poses, PoseMode::Set)) => {
                let change = before.zip(only(poses)).and_then(|(before, given)| {
                    let after = shown(adapter, edit, before.bone, time)?;
                    Some(between(given, &before.pose, &after))
                });
                return Some(Self { time: Some(time), change: change.flatten() });
            }
            Some((time, poses, PoseMode::Offset)) => (Some(time), poses),
            None => (None, edit.offsets()?),
        };
        Some(Self { time, change: only(poses).and_then(given_offset) })
    }
}

/// Returns the pose that a take shows of a bone, with its layers.
fn shown(adapter: &ModelAdapter, edit: &Edit, bone: BoneIndex, time: f32) -> Option<Transform> {
    let take = adapter.base(edit.take()?).ok()?.shown();
    let at = adapter.skeleton().bones.get(bone as usize)?;
    Some(take.tracks.get(bone as usize).map_or_else(|| rest_pose(at), |track| sample_track(track, at, time)))
}

fn only(poses: &[BonePose]) -> Option<&BonePose> {
    if let [pose] = poses { Some(pose) } else { None }
}

/// Returns the change of the only property that a pose gives.
fn between(given: &BonePose, before: &Transform, after: &Transform) -> Option<PoseChange> {
    match (given.translation, given.rotation, given.scale) {
        (Some(_), None, None) => Some(PoseChange::Translation(after.translation - before.translation)),
        (None, Some(_), None) => Some(PoseChange::Rotation(after.rotation * before.rotation.inverse())),
        (None, None, Some(_)) => {
            let factors = after.scale / before.scale;
            factors.is_finite().then_some(PoseChange::Scale(factors))
        }
        _ => None,
    }
}

/// Returns the offset, where a pose offsets one property.
fn given_offset(given: &BonePose) -> Option<PoseChange> {
    match (given.translation, given.rotation, given.scale) {
        (Some(by), None, None) => Some(PoseChange::Translation(by.into())),
        (None, Some(by), None) => {
            let turn = Quat::from_array(by).normalize();
            turn.is_finite().then_some(PoseChange::Rotation(turn))
        }
        (None, None, Some(by)) => Some(PoseChange::Scale(by.into())),
        _ => None,
    }
}
