//! Moves the keys of a take around its loop.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditedBones, Example, TakeRef};
use crate::adapter::op::Op;
use crate::adapter::plan::{Transaction, contacts, finite, moments, rewrite};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::loops::{ShiftSettings, shift_loop};
use dragonfly_anim::motion::Axis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Lets a take that repeats begin elsewhere in its loop: keys become later, and those after the end come back at the start. Channels
/// keep their interpolation, and get keys where the loop is cut.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShiftLoop {
    /// The take.
    pub take: TakeRef,
    /// Seconds by which keys become later; negative for earlier.
    pub by: f32,
    /// The bone that travels: its way is not interrupted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub travel: Option<BoneRef>,
    /// Frames per second: splines become linear keys at every frame. By default they stay splines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f32>,
}

map_references!(ShiftLoop { take, by, travel, rate });

impl EditKind for ShiftLoop {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"shift_loop","take":"Walk","by":0.25}"#,
        description: "Lets the walk begin with what it showed a quarter of a second before its end.",
    };

    const LAYERS: LayerUse = LayerUse::NoLayers;

    fn label(&self) -> &'static str {
        "Shift loop"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        None
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let id = work.take(&self.take)?;
        let by = finite("the shift", self.by)?;
        let take = Arc::clone(&work.slot(id).result);
        let travel = self.travel.as_ref().map(|bone| work.bone(bone)).transpose()?;
        let settings = ShiftSettings { by, rate: self.rate, travel, up: Axis::Y };
        let shifted = shift_loop(&take, work.skeleton(), &settings)?;
        let mut changed = rewrite::channels(work, id, &shifted)?;
        if work.slot(id).original.morphs != shifted.morphs {
            work.perform(Op::Morphs(id, shifted.morphs));
            changed = true;
        }
        if !changed {
            return Err(EditError::Nothing("the shift is a whole number of loops"));
        }
        let (start, length) = (take.start, take.length);
        contacts::follow(work, id, |track| track.shifted(start, length, by))?;
        let inside = |time: f32| (start..=start + length).contains(&time);
        moments::remap(work, id, |time| {
            Some(if inside(time) { start + (time - start + by).rem_euclid(length) } else { time })
        })
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let rate = from.optional(|from| from.between(5.0, 60.0));
        let travel = from.optional(Arbitrary::bone);
        Self { take: from.take(), by: from.between(-1.0, 2.0), travel, rate }
    }
}
