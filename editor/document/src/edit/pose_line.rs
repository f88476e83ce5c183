//! Lays bones along a line that was drawn.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{
    Arbitrary, BonePose, EditedBones, Example, OffsetFalloff, OffsetKeys, OffsetScope, SetPending, SetPose,
    TakeRef, cost,
};
use crate::adapter::plan::{PoseMode, Transaction};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Gives a chain of bones a pose along a line. It changes what `set`, `pend` or `offset_keys` would change, under a name of its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PoseLine {
    /// The take.
    pub take: TakeRef,
    /// Seconds.
    pub time: f32,
    /// The poses along the line; one for each bone.
    pub poses: Vec<BonePose>,
    /// Makes pending poses instead of keys.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub pending: bool,
    /// Makes channels linear first that consist of two equal keys with step interpolation, as exporters write channels
    /// that do not move. The bone then moves to the pose instead of jumping to it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unstep: bool,
    /// Offsets these keys of the bones by as much as the poses change at the time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<OffsetScope>,
    /// How the offset fades out around the keys.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub falloff: Option<OffsetFalloff>,
}

map_references!(PoseLine { take, time, poses, pending, unstep, over, falloff });

impl PoseLine {
    /// Returns whether it makes pending poses, and changes nothing else.
    pub(crate) fn makes_pending(&self) -> bool {
        self.over.is_none() && self.pending
    }
}

impl EditKind for PoseLine {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"pose_line","take":"Walk","time":0.5,"poses":[{"bone":"Tail.1","rotation":[0,0,0.1736482,0.9848078]},{"bone":"Tail.2","rotation":[0,0,0.1736482,0.9848078]}]}"#,
        description: "Bends two bones of the tail by 20° each, as along a line.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        if self.makes_pending() { "Pose line (pending)" } else { "Pose line" }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::named(self.poses.iter().map(|pose| &pose.bone), skeleton)
    }

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        let columns = match self.over {
            Some(_) => cost::of_columns(adapter, &self.take, &self.bones(adapter.skeleton()))?,
            None => 0,
        };
        // Each of the keys in the scope is offset.
        Some(columns * 16 + cost::of_poses(self.poses.len()))
    }

    fn detail(&self, _adapter: &ModelAdapter) -> Option<String> {
        self.over.as_ref().map(|over| over.keys_text().to_owned())
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let Self { take, time, poses, unstep, .. } = self.clone();
        match self.over.clone() {
            Some(over) => OffsetKeys { take, poses, at: Some(time), over, falloff: self.falloff }.plan(work),
            None if self.pending => SetPending { take, time, poses }.plan(work),
            None => SetPose { take, time, poses, unstep }.plan(work),
        }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let [pending, unstep] = [(); 2].map(|()| from.flag());
        let over = from.optional(OffsetScope::arbitrary);
        let falloff = from.optional(OffsetFalloff::arbitrary);
        Self { take: from.take(), time: from.time(), poses: from.poses(), pending, unstep, over, falloff }
    }

    fn values(&self) -> Option<(f32, &[BonePose], PoseMode)> {
        let sets_keys = self.over.is_none() && !self.pending;
        sets_keys.then_some((self.time, &self.poses, PoseMode::Set))
    }
}
