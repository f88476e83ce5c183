//! Keeps data with a take, or removes it.

use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeRef};
use crate::adapter::EditError;
use crate::adapter::LAYERS;
use crate::adapter::op::Op;
use crate::adapter::plan::Transaction;
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::sync::Arc;

/// Longest text, in bytes.
const LONGEST: usize = 1 << 20;

/// Keeps a JSON value with a take, for scripts and other programs. A glTF file has it in the `extras` of the animation, in
/// the object `dragonfly`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetExtras {
    /// The take.
    pub take: TakeRef,
    /// The name of the value.
    pub name: String,
    /// The value; none or null removes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<Value>,
}

map_references!(SetExtras { take, name, value });

impl EditKind for SetExtras {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set_extras","take":"Walk","name":"notes","value":{"reviewed":true,"by":"Ada"}}"#,
        description: "Keeps notes with the take in the file; without \"value\" they are removed.",
    };

    fn label(&self) -> &'static str {
        "Set extras"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        if self.name == LAYERS {
            return Err(EditError::Nothing("layers have edits of their own"));
        }
        if self.name.is_empty() {
            return Err(EditError::Nothing("the extras need a name"));
        }
        let text = self.value.as_ref().map(|value| Arc::<str>::from(value.to_string()));
        if text.as_ref().is_some_and(|text| text.len() > LONGEST) {
            return Err(EditError::Nothing("extras of a take have at most 1 MiB"));
        }
        if work.slot(take).original.extras.get(&self.name) == text.as_ref() {
            return Err(EditError::Nothing("the take has these extras already"));
        }
        work.perform(Op::Extras(take, self.name.clone(), text));
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let value = from.flag().then(|| from.choice([1, 2, 3]).into());
        Self { take: from.take(), name: from.choice(["notes", "rate"]).to_owned(), value }
    }
}
