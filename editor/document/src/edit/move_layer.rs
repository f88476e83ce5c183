//! Moves a layer up or down, or to another take.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{Transaction, layer};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Moves a layer to another place among the layers, or with all its keys to another take.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MoveLayer {
    /// The layer.
    pub take: TakeRef,
    /// Its new index, from 0 for the lowest.
    pub to: usize,
    /// The take that gets it; without it, it stays in its take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to_take: Option<TakeRef>,
}

map_references!(MoveLayer { take, to_take }, |edit, map| {
    to: map.layer_place(edit.to_take.as_ref().unwrap_or(&edit.take), edit.to, Some(&edit.take)),
});

impl EditKind for MoveLayer {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"move_layer","take":{"take":"Walk","layer":"Arm up"},"to":0,"to_take":"Run"}"#,
        description: "Moves the layer to another take, below its layers.",
    };
    const LAYERS: LayerUse = LayerUse::LayerOnly;

    fn label(&self) -> &'static str {
        if self.to_take.is_some() { "Move layer to take" } else { "Move layer" }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let (base, index) = layer::place(work, &self.take)?;
        let target = self.to_take.as_ref().map_or(Ok(base), |take| work.base(take))?;
        let count = work.slot(target).layers().len();
        let to = self.to.min(if target == base { count - 1 } else { count });
        if target == base && to == index {
            return Err(EditError::Nothing("the layer is there already"));
        }
        let moved = work.slot(base).layers()[index].clone();
        layer::replace(work, base, |layers| {
            layers.remove(index);
        })?;
        layer::replace(work, target, |layers| layers.insert(to, moved))
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.layer(), to: from.below(3), to_take: from.optional(Arbitrary::take) }
    }
}
