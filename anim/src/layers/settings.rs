//! The settings of a layer: everything but its keys.

use crate::data::{BoneIndex, Take};
use std::sync::Arc;

/// How the keys of a layer change the values below.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LayerMode {
    /// The keys are offsets in parent space.
    #[default]
    Additive,
    /// The keys are poses, which replace the values below.
    Override,
}

/// A key of the weight of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeightKey {
    /// Seconds.
    pub time: f32,
    /// 0: the layer does nothing, 1: all of it; more exaggerates an additive layer.
    pub weight: f32,
}

/// A layer without its keys.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerSettings {
    /// Name for the list of layers.
    pub name: String,
    /// How it changes the values below.
    pub mode: LayerMode,
    /// The weight where it has no keys.
    pub weight: f32,
    /// Keys of the weight, ascending in time; linear between them, constant outside.
    pub weights: Vec<WeightKey>,
    /// The bones that it may move, ascending; `None`: all.
    pub bones: Option<Arc<[BoneIndex]>>,
    /// Whether it does nothing.
    pub is_muted: bool,
    /// Whether only layers of which this is true do something.
    pub is_solo: bool,
    /// Color in the list of layers and over its keys: red, green, blue.
    pub color: [u8; 3],
}

impl Default for LayerSettings {
    /// Returns an additive layer of weight 1 for all bones.
    fn default() -> Self {
        Self {
            name: String::new(),
            mode: LayerMode::Additive,
            weight: 1.0,
            weights: Vec::new(),
            bones: None,
            is_muted: false,
            is_solo: false,
            color: [90, 160, 220],
        }
    }
}

impl LayerSettings {
    /// Returns the weight at `time` seconds, at least 0.
    pub fn weight_at(&self, time: f32) -> f32 {
        let after = self.weights.partition_point(|key| key.time <= time);
        let weight = match (after.checked_sub(1).map(|at| self.weights[at]), self.weights.get(after)) {
            (Some(a), Some(b)) => {
                let mix = ((time - a.time) / (b.time - a.time)).min(1.0);
                a.weight * (1.0 - mix) + b.weight * mix
            }
            (Some(only), None) => only.weight,
            (None, Some(only)) => only.weight,
            (None, None) => self.weight,
        };
        if weight > 0.0 { weight } else { 0.0 }
    }

    /// Returns whether the weight is the same at all times.
    pub fn has_constant_weight(&self) -> bool {
        self.weights.windows(2).all(|pair| pair[0].weight == pair[1].weight)
    }

    /// Returns whether it may move this bone.
    pub fn moves(&self, bone: BoneIndex) -> bool {
        self.bones.as_ref().is_none_or(|bones| bones.binary_search(&bone).is_ok())
    }
}

/// A layer: settings and keys. A track of its take without keys moves nothing; the values of an additive layer are offsets.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeLayer {
    /// Everything but the keys.
    pub settings: LayerSettings,
    /// The keys, one track per bone.
    pub take: Arc<Take>,
}

/// Returns for each layer whether it does something: those that are not muted and, where some are solo, are one of these.
pub fn played<'a>(layers: impl Iterator<Item = &'a LayerSettings> + Clone) -> Vec<bool> {
    let is_any_solo = layers.clone().any(|layer| layer.is_solo && !layer.is_muted);
    layers.map(|layer| !layer.is_muted && (layer.is_solo || !is_any_solo)).collect()
}
