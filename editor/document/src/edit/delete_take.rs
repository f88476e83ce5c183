//! Deletes a take (thesis §2.2.2.4).

use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeRef};
use crate::adapter::EditError;
use crate::adapter::op::Op;
use crate::adapter::plan::Transaction;
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Deletes a take. The last take of a model cannot be deleted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeleteTake {
    /// The take.
    pub take: TakeRef,
}

map_references!(DeleteTake { take });

impl EditKind for DeleteTake {
    const EXAMPLE: Example =
        Example { json: r#"{"edit":"delete_take","take":"Walk slowly"}"#, description: "Deletes a take." };

    fn label(&self) -> &'static str {
        "Delete take"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        if work.takes() == 1 {
            return Err(EditError::LastTake);
        }
        work.perform(Op::Remove(take));
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take() }
    }
}
