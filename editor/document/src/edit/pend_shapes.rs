//! Sets pending weights of shape keys.

use super::kind::EditKind;
use super::map_references::map_references;
use super::set_shapes::{arbitrary_weights, found, names};
use super::{Arbitrary, EditedBones, Example, ShapeWeight, TakeRef, cost};
use crate::adapter::PendingAt;
use crate::adapter::op::Op;
use crate::adapter::plan::{Transaction, key_time};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Shows shape keys with weights at a time without adding keys. Pending weights are part of the document and of undo, but they are not
/// in a saved file until they are keyed, together with the pending poses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PendShapes {
    /// The take.
    pub take: TakeRef,
    /// Seconds.
    pub time: f32,
    /// The shape keys with their wanted weights. Of one that occurs twice, the last weight counts.
    pub shapes: Vec<ShapeWeight>,
}

map_references!(PendShapes { take, time, shapes });

impl EditKind for PendShapes {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"pend_shapes","take":"Talk","time":0.5,"shapes":[{"mesh":"Face","shape":"jawOpen","weight":0.8}]}"#,
        description: "Shows the jaw open by 80 % at 0.5 s, without a key.",
    };

    fn label(&self) -> &'static str {
        "Set shape keys (pending)"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::Named(Default::default())
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_poses(self.shapes.len()))
    }

    fn detail(&self, _adapter: &ModelAdapter) -> Option<String> {
        names(&self.shapes)
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let time = key_time(self.time, work.slot(take))?;
        let shapes = found(work, &self.shapes)?;
        let now = work.slot(take).pending_at(time);
        let mut at = now.map_or_else(|| PendingAt::none(time), |at| PendingAt::clone(at));
        for (instance, (shape, weight)) in shapes {
            at.set_shape(instance, shape as u32, Some(weight));
        }
        work.perform(Op::Pending(take, at.time, Some(Arc::new(at))));
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), time: from.time(), shapes: arbitrary_weights(from) }
    }
}
