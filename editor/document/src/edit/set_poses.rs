//! Sets poses at several times.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::set_pose::pose_label;
use super::{Arbitrary, EditedBones, Example, PoseAt, TakeRef, cost};
use crate::adapter::plan::{PoseMode, Transaction, pose};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Gives bones poses at several times at once, as one step of the history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetPoses {
    /// The take.
    pub take: TakeRef,
    /// The times, each with its poses.
    pub at: Vec<PoseAt>,
    /// Makes channels linear first that consist of two equal keys with step interpolation, as exporters write channels
    /// that do not move. The bone then moves to the pose instead of jumping to it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unstep: bool,
}

map_references!(SetPoses { take, at, unstep });

impl EditKind for SetPoses {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set_many","take":"Walk","at":[{"time":0.25,"poses":[{"bone":"Head","translation":[0,1,0]}]},{"time":0.5,"poses":[{"bone":"Head","translation":[0,1.1,0]}]}]}"#,
        description: "Sets the position of the head at 0.25 s and at 0.5 s, in one step.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        self.at.first().map_or("Pose", |at| pose_label(&at.poses))
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        let poses = self.at.iter().flat_map(|at| &at.poses);
        EditedBones::named(poses.map(|pose| &pose.bone), skeleton)
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_poses(self.at.iter().map(|at| at.poses.len()).sum()))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        if self.at.is_empty() {
            return Err(EditError::Nothing("no pose is given"));
        }
        let mut each = self.at.iter();
        each.try_for_each(|at| {
            pose::pose_bones(work, &self.take, at.time, &at.poses, PoseMode::Set, self.unstep)
        })
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let at = (0..from.below(3)).map(|_| PoseAt { time: from.time(), poses: from.poses() }).collect();
        Self { take: from.take(), at, unstep: from.flag() }
    }
}
