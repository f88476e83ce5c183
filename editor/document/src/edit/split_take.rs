//! Splits a take in two.

use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, SAME_TIME, TakeRef};
use crate::adapter::op::Op;
use crate::adapter::plan::{
    Transaction,
    cut::cut,
    finite,
    remap::{TimeMap, apply},
};
use crate::adapter::{EditError, ModelAdapter, take_name};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Splits a take in two: the part after the time becomes a new take, next in the list, that starts at 0 s.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SplitTake {
    /// The take.
    pub take: TakeRef,
    /// Seconds; both parts get a key there.
    pub time: f32,
    /// Name of the second part.
    pub name: String,
}

map_references!(SplitTake { take, time, name });

impl EditKind for SplitTake {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"split_take","take":"Walk","time":1,"name":"Walk, end"}"#,
        description: "Splits a take in two at 1 s.",
    };

    fn label(&self) -> &'static str {
        "Split take"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let time = finite("the time", self.time)?;
        let (start, end) = (work.slot(take).original.start, work.slot(take).original.end());
        if !(time > start + SAME_TIME && time < end - SAME_TIME) {
            return Err(EditError::Outside { time, start, end });
        }
        let second = work.copy_of(take);
        let id = second.id;
        let next = work.index(take) + 1;
        work.perform(Op::Insert(next, Arc::new(second)));
        work.perform(Op::Name(id, self.name.clone()));
        cut(work, take, start, time)?;
        cut(work, id, time, end)?;
        apply(work, id, TimeMap::linear(time, 0.0, 1.0))
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), time: from.time(), name: from.name() }
    }

    fn allowed(&self, adapter: &ModelAdapter) -> Result<(), EditError> {
        take_name(adapter.slots(), &self.name, None)
    }
}
