//! Moves a take in the list (thesis §2.2.2.4).

use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeRef};
use crate::adapter::EditError;
use crate::adapter::op::Op;
use crate::adapter::plan::Transaction;
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Moves a take to another index in the list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MoveTake {
    /// The take.
    pub take: TakeRef,
    /// Its new index; the last one where there are fewer takes.
    pub to: usize,
}

map_references!(MoveTake { take }, |edit, map| { to: map.take_place(edit.to, Some(&edit.take)) });

impl EditKind for MoveTake {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"move_take","take":"Stroll","to":2}"#,
        description: "Makes it the third take.",
    };

    fn label(&self) -> &'static str {
        "Move take"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let to = self.to.min(work.takes() - 1);
        if work.index(take) == to {
            return Err(EditError::Nothing("the take is there already"));
        }
        work.perform(Op::Move(take, to));
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), to: from.below(4) }
    }
}
