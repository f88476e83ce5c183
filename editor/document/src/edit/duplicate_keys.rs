//! Copies keys to other times.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, KeySet, SAME_TIME, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{KeyMove, Transaction, finite, timing::move_keys};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Copies keys to other times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DuplicateKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys of bones.
    pub keys: Vec<KeySet>,
    /// Stretches of time, start and end in seconds, in which keys of shape keys are copied.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<[f32; 2]>,
    /// Seconds from each key to its copy.
    pub by: f32,
}

map_references!(DuplicateKeys { take, shapes, by }, |edit, map| {
    keys: map.any(&edit.keys, !edit.shapes.is_empty())?,
});

impl EditKind for DuplicateKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"duplicate_keys","take":"Walk","keys":[{"bones":["Head"],"at":[0]}],"by":1}"#,
        description: "Copies the head's first keys to one second later.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Duplicate keys"
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
        if self.by.abs() <= SAME_TIME {
            return Err(EditError::Number { what: "the distance", value: self.by });
        }
        let copied = KeyMove { copy: true, ..KeyMove::PLAIN };
        move_keys(work, &self.take, (&self.keys, &self.shapes), copied, |time| time + self.by)
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), keys: from.keys(), shapes: from.shapes(), by: from.between(-0.2, 0.5) }
    }
}
