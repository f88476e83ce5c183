//! Adds to the weights of shape keys at many keys.

use super::kind::EditKind;
use super::map_references::map_references;
use super::set_shapes::{arbitrary_weights, found, names};
use super::{Arbitrary, EditedBones, Example, OffsetFalloff, ShapeScope, ShapeWeight, TakeRef, cost};
use crate::adapter::plan::{Transaction, morph_offset};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Adds the same amount to the weights of shape keys at many keys. Tangents stay. Pending weights at these times are offset, too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OffsetShapes {
    /// The take.
    pub take: TakeRef,
    /// The shape keys with what is added to their weights; with `at`, the wanted weights.
    pub shapes: Vec<ShapeWeight>,
    /// Seconds: the weights are those wanted at this time, and the offsets lead to them from the weights that are shown there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<f32>,
    /// The keys.
    pub over: ShapeScope,
    /// How the offset fades out around the keys.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub falloff: Option<OffsetFalloff>,
}

map_references!(OffsetShapes { take, shapes, at, over, falloff });

impl EditKind for OffsetShapes {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"offset_shapes","take":"Talk","shapes":[{"mesh":"Face","shape":"smile","weight":0.2}],"over":"take"}"#,
        description: "Adds 20 % of the smile in the whole take.",
    };

    fn label(&self) -> &'static str {
        "Offset shape keys"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::Named(Default::default())
    }

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_shapes(adapter, &self.take))
    }

    fn detail(&self, adapter: &ModelAdapter) -> Option<String> {
        let mesh = |shape: &ShapeWeight| {
            adapter.shapes().find(shape.mesh.as_ref(), &shape.shape).map(|(mesh, _)| mesh.instance())
        };
        let meshes: Vec<u32> = self.shapes.iter().filter_map(mesh).collect();
        let keys = morph_offset::keys_of(adapter.take(&self.take).ok()?, &meshes, &self.over);
        let plural = if keys == 1 { "" } else { "s" };
        let over = match self.over {
            ShapeScope::Keys(_) => format!("{keys} selected key{plural}"),
            ShapeScope::Take => format!("{keys} key{plural} in the whole take"),
            ShapeScope::Range(_) => format!("{keys} key{plural} in the range"),
        };
        Some(names(&self.shapes).map_or(over.clone(), |names| format!("{names}, {over}")))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let shapes = found(work, &self.shapes)?;
        morph_offset::offset_shapes(work, self, shapes)
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let (take, shapes, at) = (from.take(), arbitrary_weights(from), from.optional(Arbitrary::time));
        let over = ShapeScope::arbitrary(from);
        Self { take, shapes, at, over, falloff: from.optional(OffsetFalloff::arbitrary) }
    }
}
