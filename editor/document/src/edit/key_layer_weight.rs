//! Sets or removes a key of the weight of a layer.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, SAME_TIME, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{Transaction, finite, layer};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::layers::WeightKey;
use dragonfly_anim::limits::CLIP_SECONDS;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sets a key of the weight of a layer, or removes it. The weight is linear between its keys.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KeyLayerWeight {
    /// The layer.
    pub take: TakeRef,
    /// Seconds.
    pub time: f32,
    /// The weight, 0 to 10; without it, the key is removed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weight: Option<f32>,
}

map_references!(KeyLayerWeight { take, time, weight });

impl EditKind for KeyLayerWeight {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"key_layer_weight","take":{"take":"Walk","layer":"Arm up"},"time":0.5,"weight":1}"#,
        description: "The layer has its whole effect at half a second; other keys of its weight let it fade in and out.",
    };
    const LAYERS: LayerUse = LayerUse::LayerOnly;

    fn label(&self) -> &'static str {
        if self.weight.is_some() { "Key layer weight" } else { "Delete key of layer weight" }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let (base, index) = layer::place(work, &self.take)?;
        let time = finite("a time", self.time)?;
        if time.abs() > CLIP_SECONDS {
            return Err(EditError::TooLate(time));
        }
        let weight = self.weight.map(layer::weight).transpose()?;
        layer::set(work, base, index, |settings| {
            let at = settings.weights.iter().position(|key| (key.time - time).abs() <= SAME_TIME);
            match (at, weight) {
                (Some(at), Some(weight)) => settings.weights[at].weight = weight,
                (Some(at), None) => {
                    settings.weights.remove(at);
                }
                (None, Some(weight)) => {
                    let after = settings.weights.partition_point(|key| key.time < time);
                    settings.weights.insert(after, WeightKey { time, weight });
                }
                (None, None) => {}
            }
        })
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.layer(), time: from.time(), weight: from.optional(|from| from.between(0.0, 2.0)) }
    }
}
