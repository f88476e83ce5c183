//! Layers over a take: keys of their own that change what is played, while the keys of the take stay as they are.
//!
//! The take below is the *base*. Each layer has a take of keys for the bones that it moves; a channel without keys moves
//! nothing. From the lowest to the highest, with `b` for the value below, `k` for the value of the layer and `w` for its weight at
//! that time:
//!
//! ```text
//!               additive (k is an offset)       override (k is a pose)
//! translation   b + w * k                       lerp(b, k, w)
//! rotation      k^w * b, in parent space        slerp(b, k, w), the short way
//! scale         b * (1 + w * (k - 1))           lerp(b, k, w)
//! ```
//!
//! The additive rules are those of [`crate::blend::add`]. [`flatten`] computes the one take that programs without layers
//! play; [`key_for`] answers which key a layer needs so that a given pose is seen.

mod flatten;
mod lines;
mod rule;
mod settings;
mod stack;
mod times;

pub use flatten::{FlatChannels, flatten, flatten_channel, flatten_channel_with, flatten_with};
pub use rule::{LayerRule, LayerSum, RotationRule, ScaleRule, TranslationRule};
pub use settings::{LayerMode, LayerSettings, TakeLayer, WeightKey, played};

use crate::data::Channel;
use crate::sample::sample_channel;

/// The times at which one take gets keys between those of base, layers and weights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AddedKeys {
    /// Halfway between two keys, and halfway again, until the tolerance is met. For a take that other programs play.
    Halfway,
    /// On whole frames at this rate, frames per second: for keys that an animator edits. Between two frames the result may be further off. A
    /// rate that is not positive adds none.
    OnFrames(f32),
}

/// A layer with its keys of one channel.
#[derive(Clone, Copy, Debug)]
pub struct LayerChannel<'a, T> {
    /// Mode and weight.
    pub settings: &'a LayerSettings,
    /// The keys; none where the layer does not move the channel.
    pub keys: &'a Channel<T>,
}

impl<T: Copy> LayerChannel<'_, T> {
    /// Returns the value at `time` seconds over `below`.
    fn over<R: LayerRule<Value = T>>(&self, below: T, time: f32) -> T
    where
        T: crate::sample::Value,
    {
        if self.keys.is_empty() {
            return below;
        }
        let weight = self.settings.weight_at(time);
        match self.settings.mode {
            LayerMode::Additive => {
                R::add(below, R::part(sample_channel(self.keys, R::IDENTITY, time), weight))
            }
            LayerMode::Override => R::mix(below, sample_channel(self.keys, below, time), weight.min(1.0)),
        }
    }
}

/// Returns what is seen at `time` seconds: `below` with all layers over it, the lowest first.
pub fn seen<R: LayerRule>(below: R::Value, layers: &[LayerChannel<'_, R::Value>], time: f32) -> R::Value {
    layers.iter().fold(below, |below, layer| layer.over::<R>(below, time))
}

/// Returns the value of the key that the layer at `index` needs at `time` seconds so that `wanted` is seen.
///
/// `below` is the value of the base. `None` where no key does that: the weight of the layer is nearly 0 there, a layer
/// above it hides it, it would have to rotate by more than half a turn, or a scale of 0 would have to become another one.
pub fn key_for<R: LayerRule>(
    below: R::Value,
    layers: &[LayerChannel<'_, R::Value>],
    index: usize,
    time: f32,
    wanted: R::Value,
) -> Option<R::Value> {
    let (under, rest) = layers.split_at_checked(index)?;
    let (own, over) = rest.split_first()?;
    let mut target = wanted;
    for layer in over.iter().rev().filter(|layer| !layer.keys.is_empty()) {
        let weight = layer.settings.weight_at(time);
        target = match layer.settings.mode {
            LayerMode::Additive => {
                R::subtract(target, R::part(sample_channel(layer.keys, R::IDENTITY, time), weight))?
            }
            LayerMode::Override => {
                let key = sample_channel(layer.keys, target, time);
                let left = 1.0 - weight.min(1.0);
                if left < LEAST_WEIGHT {
                    return None;
                }
                // target = mix(x, key, weight), so x is beyond target, seen from key.
                R::beyond(key, target, left)?
            }
        };
    }
    let below = seen::<R>(below, under, time);
    let weight = own.settings.weight_at(time);
    if weight < LEAST_WEIGHT {
        return None;
    }
    match own.settings.mode {
        LayerMode::Additive => R::offset(below, target, weight),
        LayerMode::Override => R::beyond(below, target, weight.min(1.0)),
    }
}

/// A weight below this is no weight: a key would have to be a thousand times as far away as what is seen.
const LEAST_WEIGHT: f32 = 1e-3;
