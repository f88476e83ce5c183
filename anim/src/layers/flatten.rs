//! One take from a base and its layers.

use super::rule::{LayerRule, RotationRule, ScaleRule, TranslationRule};
use super::settings::{LayerMode, TakeLayer, played};
use super::{AddedKeys, LayerChannel, lines};
use crate::data::{BoneIndex, Channel, Skeleton, Take, Track};
use crate::sample::{Value, rest_pose, sample_channel};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// The channels of one bone with all layers over them; `None` where no layer moves them.
#[derive(Clone, Debug, Default)]
pub struct FlatChannels {
    /// Meters, parent space.
    pub translation: Option<Channel<Vec3>>,
    /// Unit quaternions, parent space.
    pub rotation: Option<Channel<Quat>>,
    /// Factors per axis.
    pub scale: Option<Channel<Vec3>>,
}

/// Returns the take that `base` and `layers` give together, the lowest layer first.
///
/// Channels that no layer moves are those of the base, shared. Name, morph weights and extras are those of the base; start and
/// length are those of the keys. See [`flatten_channel`] for the keys.
pub fn flatten(base: &Take, layers: &[TakeLayer], skeleton: &Skeleton) -> Take {
    flatten_with(base, layers, skeleton, AddedKeys::Halfway)
}

/// Returns the take that `base` and `layers` give together, as [`flatten`] does, with keys added only at the times that `added` allows.
pub fn flatten_with(base: &Take, layers: &[TakeLayer], skeleton: &Skeleton, added: AddedKeys) -> Take {
    let mut flat = base.clone();
    let played = played(layers.iter().map(|layer| &layer.settings));
    let layers: Vec<&TakeLayer> =
        layers.iter().zip(played).filter(|(_, played)| *played).map(|(layer, _)| layer).collect();
    for (index, (track, bone)) in flat.tracks.iter_mut().zip(&skeleton.bones).enumerate() {
        let rest = rest_pose(bone);
        one::<TranslationRule>(track, index as BoneIndex, &layers, rest.translation, added);
        one::<RotationRule>(track, index as BoneIndex, &layers, rest.rotation, added);
        one::<ScaleRule>(track, index as BoneIndex, &layers, rest.scale, added);
    }
    let (start, end) = flat.range_of_keys().unwrap_or((0.0, 0.0));
    (flat.start, flat.length) = (start, end - start);
    flat
}

fn one<R: LayerRule>(
    track: &mut Track,
    bone: BoneIndex,
    layers: &[&TakeLayer],
    rest: R::Value,
    added: AddedKeys,
) {
    let channels: Vec<LayerChannel<'_, R::Value>> = layers
        .iter()
        .filter(|layer| layer.settings.moves(bone))
        .filter_map(|layer| {
            let keys = R::channel(layer.take.tracks.get(bone as usize)?);
            Some(LayerChannel { settings: &layer.settings, keys })
        })
        .collect();
    if let Some(flat) = flatten_channel_with::<R>(R::channel(track), &channels, rest, added) {
        *R::channel_mut(track) = flat;
    }
}

/// Returns the channel that `base` gives with these layers over it, the lowest first; `None` where no layer has keys. `rest` is
/// the value of a base without keys.
///
/// * Additive layers that do not change over time are added to the keys: times, interpolation and number of keys stay, and the
///   result is exact between them, too.
/// * Channels of steps alone give steps.
/// * Everything else gives linear keys: at all keys of base, layers and weights, and between them where a line
///   would be off by more than 1e-4 (radians, factors, or part of the way that the channel goes). A step is two keys, a tenth of a
///   millisecond apart.
pub fn flatten_channel<R: LayerRule>(
    base: &Channel<R::Value>,
    layers: &[LayerChannel<'_, R::Value>],
    rest: R::Value,
) -> Option<Channel<R::Value>> {
    flatten_channel_with::<R>(base, layers, rest, AddedKeys::Halfway)
}

/// Returns the channel that `base` gives with these layers over it, as [`flatten_channel`] does, with keys added only at the times that
/// `added` allows.
pub fn flatten_channel_with<R: LayerRule>(
    base: &Channel<R::Value>,
    layers: &[LayerChannel<'_, R::Value>],
    rest: R::Value,
    added: AddedKeys,
) -> Option<Channel<R::Value>> {
    let layers: Vec<_> = layers.iter().filter(|layer| !layer.keys.is_empty()).copied().collect();
    if layers.is_empty() {
        return None;
    }
    let is_constant = |layer: &LayerChannel<'_, R::Value>| {
        layer.settings.mode == LayerMode::Additive
            && layer.settings.has_constant_weight()
            && is_still::<R>(layer.keys)
    };
    if !base.is_empty() && layers.iter().all(is_constant) {
        return Some(with_constants::<R>(base, &layers));
    }
    Some(lines::in_lines::<R>(base, &layers, rest, added))
}

/// Returns whether the channel has the same value at all times.
fn is_still<R: LayerRule>(channel: &Channel<R::Value>) -> bool {
    let per_key = channel.values_per_key();
    let middle = per_key / 2;
    let value = |key: usize| channel.values.get(key * per_key + middle).copied();
    (1..channel.len()).all(|key| value(key) == value(0))
        && (per_key == 1
            || channel.len() <= 1
            || (0..channel.len()).all(|key| {
                [0, 2].into_iter().all(|side| channel.values.get(key * 3 + side) == Some(&R::Value::ZERO))
            }))
}

fn with_constants<R: LayerRule>(
    base: &Channel<R::Value>,
    layers: &[LayerChannel<'_, R::Value>],
) -> Channel<R::Value> {
    let start = base.times.first().copied().unwrap_or(0.0);
    let part = |layer: &LayerChannel<'_, R::Value>| {
        R::part(sample_channel(layer.keys, R::IDENTITY, start), layer.settings.weight_at(start))
    };
    let parts: Vec<R::Value> = layers.iter().map(part).collect();
    let per_key = base.values_per_key();
    let of = |(at, &value): (usize, &R::Value)| {
        let is_tangent = per_key == 3 && at % 3 != 1;
        parts.iter().fold(value, |value, &part| match is_tangent {
            true => R::tangent(value, part),
            false => R::add(value, part),
        })
    };
    let values = base.values.iter().enumerate().map(of).collect();
    Channel { times: Arc::clone(&base.times), values, interpolation: base.interpolation }
}
