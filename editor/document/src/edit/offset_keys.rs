//! Offsets many keys at once.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::set_pose::pose_label;
use super::{Arbitrary, BonePose, BoneRef, EditedBones, Example, OffsetFalloff, OffsetScope, TakeRef, cost};
use crate::adapter::plan::{Transaction, offset};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::{BoneIndex, Skeleton};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Offsets the keys of bones by the same amount. Translations are added (parent space), rotations multiplied from the left
/// (parent space), scales multiplied; tangents follow. Pending poses at these times are offset, too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OffsetKeys {
    /// The take.
    pub take: TakeRef,
    /// The offsets, one for each bone; with `at`, the wanted poses.
    pub poses: Vec<BonePose>,
    /// Seconds: the poses are those wanted at this time, and the offsets lead to them from the poses that are shown there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<f32>,
    /// The keys.
    pub over: OffsetScope,
    /// How the offset fades out around the keys.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub falloff: Option<OffsetFalloff>,
}

impl OffsetKeys {
    /// Returns the bones that it names by index.
    pub fn bones_named(&self) -> Vec<BoneIndex> {
        let index = |pose: &BonePose| match pose.bone {
            BoneRef::Index(bone) => Some(bone),
            BoneRef::Name(_) => None,
        };
        self.poses.iter().filter_map(index).collect()
    }
}

map_references!(OffsetKeys { take, poses, at, over, falloff });

impl EditKind for OffsetKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"offset_keys","take":"Walk","poses":[{"bone":"Arm.L","rotation":[0,0,0.1736482,0.9848078]}],"over":"take"}"#,
        description: "Raises the left arm by 20° in the whole take.",
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

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        let columns = cost::of_columns(adapter, &self.take, &self.bones(adapter.skeleton()))?;
        let keys = offset::keys_of(adapter, &self.take, &self.poses, &self.over);
        Some(columns + keys + cost::of_poses(self.poses.len()))
    }

    fn detail(&self, adapter: &ModelAdapter) -> Option<String> {
        let keys = offset::keys_of(adapter, &self.take, &self.poses, &self.over);
        let plural = if keys == 1 { "" } else { "s" };
        Some(match self.over {
            OffsetScope::Keys(_) => format!("{keys} selected key{plural}"),
            OffsetScope::Take => format!("{keys} key{plural} in the whole take"),
            OffsetScope::Range(_) => format!("{keys} key{plural} in the range"),
        })
    }

    fn offsets(&self) -> Option<&[BonePose]> {
        Some(&self.poses)
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        offset::offset_keys(work, self)
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let at = from.optional(Arbitrary::time);
        let (take, poses, over) = (from.take(), from.poses(), OffsetScope::arbitrary(from));
        Self { take, poses, at, over, falloff: from.optional(OffsetFalloff::arbitrary) }
    }
}
