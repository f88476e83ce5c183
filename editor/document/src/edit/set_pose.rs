//! Sets the pose of bones at a time.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BonePose, EditedBones, Example, TakeRef, cost};
use crate::adapter::plan::{PoseMode, Transaction, pose};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Gives bones a pose at a time. Where a channel has no key there, one is added that keeps the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetPose {
    /// The take.
    pub take: TakeRef,
    /// Seconds.
    pub time: f32,
    /// The wanted poses; one for each bone.
    pub poses: Vec<BonePose>,
    /// Makes channels linear first that consist of two equal keys with step interpolation, as exporters write channels
    /// that do not move. The bone then moves to the pose instead of jumping to it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unstep: bool,
}

map_references!(SetPose { take, time, poses, unstep });

impl EditKind for SetPose {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set","take":"Walk","time":0.5,"poses":[{"bone":"Head","rotation":[0,0.2588190,0,0.9659258]}]}"#,
        description: "Rotates the head 30° about the y axis of its parent at 0.5 s, exactly.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        pose_label(&self.poses)
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::named(self.poses.iter().map(|pose| &pose.bone), skeleton)
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_poses(self.poses.len()))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        pose::pose_bones(work, &self.take, self.time, &self.poses, PoseMode::Set, self.unstep)
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), time: from.time(), poses: from.poses(), unstep: from.flag() }
    }

    fn values(&self) -> Option<(f32, &[BonePose], PoseMode)> {
        Some((self.time, &self.poses, PoseMode::Set))
    }
}

/// Returns the label of poses: which of translation, rotation and scale they give.
pub(super) fn pose_label(poses: &[BonePose]) -> &'static str {
    let any = |has: fn(&BonePose) -> bool| poses.iter().any(has);
    let parts = (
        any(|pose| pose.translation.is_some()),
        any(|pose| pose.rotation.is_some()),
        any(|pose| pose.scale.is_some()),
    );
    match parts {
        (true, false, false) => "Move",
        (false, true, false) => "Rotate",
        (false, false, true) => "Scale",
        _ => "Pose",
    }
}
