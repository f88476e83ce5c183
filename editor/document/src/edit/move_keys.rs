//! Moves keys in time.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, KeySet, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{KeyMove, Transaction, finite, timing::move_keys};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Moves keys in time. A key that is already at the new time is overwritten.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MoveKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys of bones.
    pub keys: Vec<KeySet>,
    /// Stretches of time, start and end in seconds, in which keys of shape keys are moved.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<[f32; 2]>,
    /// Seconds; negative is earlier.
    pub by: f32,
}

map_references!(MoveKeys { take, shapes, by }, |edit, map| {
    keys: map.any(&edit.keys, !edit.shapes.is_empty())?,
});

impl EditKind for MoveKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"move_keys","take":"Walk","keys":[{"at":[0.5]}],"by":0.1}"#,
        description: "Moves all keys at 0.5 s by 0.1 s.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Move keys"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::of_keys(&self.keys, skeleton)
    }

    fn keys(&self) -> &[KeySet] {
        &self.keys
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        finite("the distance", self.by)?;
        move_keys(work, &self.take, (&self.keys, &self.shapes), KeyMove::PLAIN, |time| time + self.by)
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), keys: from.keys(), shapes: from.shapes(), by: from.between(-0.2, 0.4) }
    }
}
