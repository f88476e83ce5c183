//! Puts removed travel back.

use super::kept_travel::{TRAVEL, kept_travel, travel_text};
use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeRef};
use crate::adapter::op::Op;
use crate::adapter::plan::{Transaction, rewrite};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::motion::put_back;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Puts back the travel that was last removed from a take by `remove_travel`. Other changes made since then stay.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RestoreTravel {
    /// The take.
    pub take: TakeRef,
}

map_references!(RestoreTravel { take });

impl EditKind for RestoreTravel {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"restore_travel","take":"Walk"}"#,
        description: "Lets the figure walk again as far as it did before its travel was removed.",
    };

    fn label(&self) -> &'static str {
        "Put travel back"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    /// The bone that gets its travel back is known only to the take, so a locked bone is a reason to refuse.
    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::All
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        None
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let id = work.take(&self.take)?;
        let take = Arc::clone(&work.slot(id).result);
        let mut kept = kept_travel(&work.slot(id).original.extras);
        let motion = kept.pop().ok_or(EditError::Nothing("no travel was removed from this take"))?;
        let restored = put_back(&take, work.skeleton(), &motion)?;
        rewrite::channels(work, id, &restored)?;
        work.perform(Op::Extras(id, TRAVEL.to_owned(), travel_text(&kept)));
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take() }
    }
}
