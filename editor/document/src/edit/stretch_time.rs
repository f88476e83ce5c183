//! Slows or quickens a part of a take.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, SAME_TIME, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{
    Transaction, finite,
    remap::{TimeMap, apply},
};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Slows or quickens a part of a take: keys in the part are scaled about its start, and everything after it moves, so that no key
/// comes between others. Contacts, events and layers of the take follow. Tangents keep their shape; between two keys of which one is in
/// the part, the curve is stretched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StretchTime {
    /// The take, or a layer of it, whose keys alone are then moved.
    pub take: TakeRef,
    /// Seconds: the start of the part.
    pub from: f32,
    /// Seconds: the end of the part.
    pub to: f32,
    /// New length divided by old length, 0.001 to 1000.
    pub factor: f32,
}

map_references!(StretchTime { take, from, to, factor });

impl EditKind for StretchTime {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"stretch_time","take":"Walk","from":0.2,"to":0.4,"factor":2}"#,
        description: "Slows a fifth of a second down to half speed, and moves all later keys.",
    };
    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        if self.factor > 1.0 { "Slow down a part" } else { "Quicken a part" }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::All
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let (from, to) = (finite("the time", self.from)?, finite("the time", self.to)?);
        if to - from <= SAME_TIME {
            return Err(EditError::Number { what: "an end before the start", value: to });
        }
        if !(1e-3..=1e3).contains(&self.factor) {
            return Err(EditError::Number { what: "the factor", value: self.factor });
        }
        let slot = work.slot(take);
        if self.factor == 1.0 || from >= slot.original.end() {
            return Err(EditError::Nothing("no key is in the part or after it"));
        }
        apply(work, take, TimeMap::of_part([from, to], self.factor))
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let start = from.time();
        let factor = from.choice([0.5, 2.0, 1.3, 0.01]);
        Self { take: from.take(), from: start, to: start + from.between(-0.1, 0.5), factor }
    }
}
