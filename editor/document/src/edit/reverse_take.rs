//! Reverses a take.

use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{
    Transaction,
    remap::{TimeMap, apply},
};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Reverses a take: it plays from its end. Its start and its length stay.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReverseTake {
    /// The take.
    pub take: TakeRef,
}

map_references!(ReverseTake { take });

impl EditKind for ReverseTake {
    const EXAMPLE: Example =
        Example { json: r#"{"edit":"reverse_take","take":"Walk"}"#, description: "Reverses a take." };

    fn label(&self) -> &'static str {
        "Reverse take"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        // A step channel keeps the value of each key on its key, so reversing twice is the identity. Between
        // keys it then shows the value of the key on the other side.
        let take = work.take(&self.take)?;
        let (start, end) = (work.slot(take).original.start, work.slot(take).original.end());
        apply(work, take, TimeMap::linear(start, end, -1.0))
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take() }
    }
}
