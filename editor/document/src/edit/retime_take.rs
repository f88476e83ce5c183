//! Changes the start and the length of a take.

use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{
    Transaction, finite,
    remap::{TimeMap, apply},
};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Gives a take another start and another length: all keys are moved and scaled with it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RetimeTake {
    /// The take.
    pub take: TakeRef,
    /// Seconds; unchanged where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<f32>,
    /// Seconds, more than 0; unchanged where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<f32>,
}

map_references!(RetimeTake { take, start, length });

impl EditKind for RetimeTake {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"retime_take","take":"Walk","start":0,"length":2}"#,
        description: "Makes a take two seconds long.",
    };

    fn label(&self) -> &'static str {
        "Retime take"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let (old_start, old_length) = (work.slot(take).original.start, work.slot(take).original.length);
        let start = finite("the start", self.start.unwrap_or(old_start))?;
        if start < old_start.min(0.0) {
            return Err(EditError::BeforeZero(start));
        }
        let length = finite("the length", self.length.unwrap_or(old_length))?;
        let stretch = match old_length {
            0.0 if length == 0.0 => 1.0,
            _ if length <= 0.0 => return Err(EditError::Number { what: "the length", value: length }),
            0.0 => return Err(EditError::Nothing("a take of one pose has no length to change")),
            old => length / old,
        };
        apply(work, take, TimeMap::linear(old_start, start, stretch))
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let start = from.optional(|from| from.between(0.0, 0.5));
        let length = from.optional(|from| from.between(0.1, 2.0));
        Self { take: from.take(), start, length }
    }
}
