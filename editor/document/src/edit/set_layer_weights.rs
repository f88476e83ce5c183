//! Replaces the keys of the weight of a layer.

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

/// Replaces the keys of the weight of a layer. The weight is linear between its keys; without keys it is the one that `set_layer`
/// sets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetLayerWeights {
    /// The layer.
    pub take: TakeRef,
    /// All keys, in any order, at different times.
    #[serde(default)]
    pub keys: Vec<LayerWeightKey>,
}

/// A key of the weight of a layer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LayerWeightKey {
    /// Seconds.
    pub time: f32,
    /// The weight, 0 to 10.
    pub weight: f32,
}

/// Largest number of keys of a weight.
const MOST: usize = 10_000;

map_references!(SetLayerWeights { take, keys });

impl EditKind for SetLayerWeights {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set_layer_weights","take":{"take":"Walk","layer":"Arm up"},"keys":[{"time":0,"weight":0},{"time":0.25,"weight":1}]}"#,
        description: "The layer fades in within a quarter of a second.",
    };
    const LAYERS: LayerUse = LayerUse::LayerOnly;

    fn label(&self) -> &'static str {
        if self.keys.is_empty() { "Delete keys of layer weight" } else { "Set keys of layer weight" }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let (base, index) = layer::place(work, &self.take)?;
        if self.keys.len() > MOST {
            return Err(EditError::Nothing("the weight of a layer has at most 10,000 keys"));
        }
        let key = |key: &LayerWeightKey| {
            let time = finite("a time", key.time)?;
            if time.abs() > CLIP_SECONDS {
                return Err(EditError::TooLate(time));
            }
            Ok(WeightKey { time, weight: layer::weight(key.weight)? })
        };
        let mut keys = self.keys.iter().map(key).collect::<Result<Vec<_>, _>>()?;
        keys.sort_by(|a, b| a.time.total_cmp(&b.time));
        if keys.windows(2).any(|pair| pair[1].time - pair[0].time <= SAME_TIME) {
            return Err(EditError::Nothing("two keys of the weight are at the same time"));
        }
        layer::set(work, base, index, |settings| settings.weights = keys)
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let key =
            |from: &mut Arbitrary<'_>| LayerWeightKey { time: from.time(), weight: from.between(0.0, 2.0) };
        Self { take: from.layer(), keys: (0..from.below(4)).map(|_| key(from)).collect() }
    }
}
