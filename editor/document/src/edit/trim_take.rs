//! Trims a take.

use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, SAME_TIME, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{
    Transaction,
    cut::cut,
    finite,
    remap::{TimeMap, apply},
};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Deletes the keys before and after a range of time. Keys are added at both ends, so the motion in the range stays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrimTake {
    /// The take.
    pub take: TakeRef,
    /// Seconds.
    pub from: f32,
    /// Seconds, not before `from`.
    pub to: f32,
    /// Moves the remaining keys to where the take started.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub to_start: bool,
}

map_references!(TrimTake { take, from, to, to_start });

impl EditKind for TrimTake {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"trim_take","take":"Walk","from":0.2,"to":0.8}"#,
        description: "Keeps the 0.6 s from 0.2 s to 0.8 s.",
    };

    fn label(&self) -> &'static str {
        "Trim take"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let (take, from, to) = (work.take(&self.take)?, self.from, self.to);
        let (start, end) = (work.slot(take).original.start, work.slot(take).original.end());
        for time in [from, to] {
            finite("the time", time)?;
            if !(time >= start - SAME_TIME && time <= end + SAME_TIME) {
                return Err(EditError::Outside { time, start, end });
            }
        }
        if to < from {
            return Err(EditError::Number { what: "an end before the start", value: to });
        }
        cut(work, take, from.max(start), to.min(end))?;
        if self.to_start {
            return apply(work, take, TimeMap::linear(from.max(start), start, 1.0));
        }
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let time = from.time();
        Self { take: from.take(), from: time * 0.5, to: time, to_start: from.flag() }
    }
}
