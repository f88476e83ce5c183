//! Renames a take (thesis §2.2.2.4).

use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeRef};
use crate::about::shortened;
use crate::adapter::op::Op;
use crate::adapter::plan::Transaction;
use crate::adapter::{EditError, ModelAdapter, take_name};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Renames a take.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RenameTake {
    /// The take.
    pub take: TakeRef,
    /// Its new name.
    pub name: String,
}

map_references!(RenameTake { take, name });

impl EditKind for RenameTake {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"rename_take","take":0,"name":"Stroll"}"#,
        description: "Renames the first take.",
    };

    fn label(&self) -> &'static str {
        "Rename take"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        if work.slot(take).original.name == self.name {
            return Err(EditError::Nothing("the take has that name already"));
        }
        work.perform(Op::Name(take, self.name.clone()));
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), name: from.name() }
    }

    fn take_title(&self, adapter: &ModelAdapter) -> Option<String> {
        let before = &adapter.take(&self.take).ok()?.original.name;
        Some(format!("{} → {}", shortened(before), shortened(&self.name)))
    }

    fn allowed(&self, adapter: &ModelAdapter) -> Result<(), EditError> {
        take_name(adapter.slots(), &self.name, Some(adapter.take(&self.take)?.id))
    }
}
