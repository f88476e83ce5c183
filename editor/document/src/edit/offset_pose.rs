//! Moves, rotates and scales bones on top of their pose.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::set_pose::pose_label;
use super::{Arbitrary, BonePose, EditedBones, Example, TakeRef, cost};
use crate::adapter::plan::{PoseMode, Transaction, pose};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Moves, rotates and scales bones on top of the pose that they have at a time. Translations are added (parent space),
/// rotations multiplied from the left (parent space), scales multiplied.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OffsetPose {
    /// The take.
    pub take: TakeRef,
    /// Seconds.
    pub time: f32,
    /// The offsets; one for each bone.
    pub poses: Vec<BonePose>,
    /// Makes channels linear first that consist of two equal keys with step interpolation, as exporters write channels
    /// that do not move. The bone then moves to the pose instead of jumping to it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unstep: bool,
}

map_references!(OffsetPose { take, time, poses, unstep });

impl EditKind for OffsetPose {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"offset","take":0,"time":0.5,"poses":[{"bone":3,"translation":[0,0.1,0]}]}"#,
        description: "Lifts the fourth bone by 10 cm.",
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
        pose::pose_bones(work, &self.take, self.time, &self.poses, PoseMode::Offset, self.unstep)
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), time: from.time(), poses: from.poses(), unstep: from.flag() }
    }

    fn values(&self) -> Option<(f32, &[BonePose], PoseMode)> {
        Some((self.time, &self.poses, PoseMode::Offset))
    }
}
