//! Deletes a layer.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{Transaction, layer};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Deletes a layer with its keys.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeleteLayer {
    /// The layer.
    pub take: TakeRef,
}

map_references!(DeleteLayer { take });

impl EditKind for DeleteLayer {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"delete_layer","take":{"take":"Walk","layer":"Arm up"}}"#,
        description: "Deletes a layer; the take below it is as it was.",
    };
    const LAYERS: LayerUse = LayerUse::LayerOnly;

    fn label(&self) -> &'static str {
        "Delete layer"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let (base, index) = layer::place(work, &self.take)?;
        layer::replace(work, base, |layers| {
            layers.remove(index);
        })
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.layer() }
    }
}
