//! Discards pending poses.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditedBones, Example, TakeRef, cost};
use crate::adapter::plan::{Transaction, pending};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Discards pending poses and weights of shape keys.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DropPending {
    /// The take.
    pub take: TakeRef,
    /// Seconds; all times where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<f32>,
    /// The bones; all where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bones: Vec<BoneRef>,
    /// Whether weights of shape keys are meant as well where bones are named; without bones they always are.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub shapes: bool,
}

map_references!(DropPending { take, time, bones, shapes });

impl EditKind for DropPending {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"drop_pending","take":"Walk","bones":["Head"]}"#,
        description: "Discards all pending poses of the head.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Discard pending poses"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::listed(&self.bones, skeleton)
    }

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_poses(adapter.pending_poses()))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.base(&self.take)?;
        for at in pending::selected(work, take, self.time, &self.bones, self.shapes)? {
            pending::remove(work, take, &at);
        }
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self {
            take: from.take(),
            time: from.optional(Arbitrary::time),
            bones: from.bones(),
            shapes: from.flag(),
        }
    }
}
