//! One take from a base and its layers.

use super::rule::{LayerRule, RotationRule, ScaleRule, TranslationRule};
use super::settings::{LayerMode, TakeLayer, played};
use super::{LayerChannel, seen};
use crate::data::{BoneIndex, Channel, Interpolation, Skeleton, Take, Track};
use crate::limits::KEYS_PER_CHANNEL;
use crate::sample::{Value, rest_pose, sample_channel};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Seconds between the two keys that stand for a jump of a channel with steps.
const JUMP: f32 = 1e-4;

/// Seconds: times that are nearer to each other are the same.
const SAME: f32 = 5e-5;

/// Radians or factors by which a channel may differ, between its keys, from what its layers give.
const TOLERANCE: f32 = 1e-4;

/// How often the time between two keys is halved at most.
const HALVINGS: u32 = 5;

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
    let mut flat = base.clone();
    let played = played(layers.iter().map(|layer| &layer.settings));
    let layers: Vec<&TakeLayer> =
        layers.iter().zip(played).filter(|(_, played)| *played).map(|(layer, _)| layer).collect();
    for (index, (track, bone)) in flat.tracks.iter_mut().zip(&skeleton.bones).enumerate() {
        let rest = rest_pose(bone);
        one::<TranslationRule>(track, index as BoneIndex, &layers, rest.translation);
        one::<RotationRule>(track, index as BoneIndex, &layers, rest.rotation);
        one::<ScaleRule>(track, index as BoneIndex, &layers, rest.scale);
    }
    let (start, end) = flat.range_of_keys().unwrap_or((0.0, 0.0));
    (flat.start, flat.length) = (start, end - start);
    flat
}

fn one<R: LayerRule>(track: &mut Track, bone: BoneIndex, layers: &[&TakeLayer], rest: R::Value) {
    let channels: Vec<LayerChannel<'_, R::Value>> = layers
        .iter()
        .filter(|layer| layer.settings.moves(bone))
        .filter_map(|layer| {
            let keys = R::channel(layer.take.tracks.get(bone as usize)?);
            Some(LayerChannel { settings: &layer.settings, keys })
        })
        .collect();
    if let Some(flat) = flatten_channel::<R>(R::channel(track), &channels, rest) {
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
    Some(in_lines::<R>(base, &layers, rest))
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
    let offsets: Vec<(R::Value, f32)> = layers
        .iter()
        .map(|layer| (sample_channel(layer.keys, R::IDENTITY, start), layer.settings.weight_at(start)))
        .collect();
    let per_key = base.values_per_key();
    let of = |(at, &value): (usize, &R::Value)| {
        let is_tangent = per_key == 3 && at % 3 != 1;
        offsets.iter().fold(value, |value, &(offset, weight)| match is_tangent {
            true => R::tangent(value, offset, weight),
            false => R::add(value, offset, weight),
        })
    };
    let values = base.values.iter().enumerate().map(of).collect();
    Channel { times: Arc::clone(&base.times), values, interpolation: base.interpolation }
}

fn in_lines<R: LayerRule>(
    base: &Channel<R::Value>,
    layers: &[LayerChannel<'_, R::Value>],
    rest: R::Value,
) -> Channel<R::Value> {
    let at = |time: f32| seen::<R>(sample_channel(base, rest, time), layers, time);
    let is_stepped =
        |channel: &Channel<R::Value>| channel.len() <= 1 || channel.interpolation == Interpolation::Step;
    let all_stepped = is_stepped(base)
        && layers.iter().all(|layer| is_stepped(layer.keys) && layer.settings.has_constant_weight());
    let times = all_times(base, layers, !all_stepped);
    let ends: Vec<R::Value> = times.iter().map(|&time| at(time)).collect();
    if all_stepped {
        return Channel { times: times.into(), values: ends.into(), interpolation: Interpolation::Step };
    }
    let way = ends.iter().fold(0.0_f32, |way, &value| way.max(R::distance(ends[0], value)));
    let tolerance = TOLERANCE * way.clamp(1e-3, 1.0);
    // A hostile file must not make a channel much longer than its sources.
    let mut room = KEYS_PER_CHANNEL.min(times.len() + 1000);
    let (mut all, mut values) = (Vec::with_capacity(times.len()), Vec::with_capacity(times.len()));
    for (index, (&time, &value)) in times.iter().zip(&ends).enumerate() {
        all.push(time);
        values.push(value);
        if let (Some(&next), Some(&after)) = (times.get(index + 1), ends.get(index + 1))
            && next - time > 2.0 * JUMP
            && bends(base, layers, time, next)
        {
            halve::<R>(
                &at,
                [(time, value), (next, after)],
                (tolerance, HALVINGS),
                &mut room,
                &mut all,
                &mut values,
            );
        }
    }
    Channel { times: all.into(), values: hemisphere::<R>(values), interpolation: Interpolation::Linear }
}

/// Puts keys between two times where a line is off by more than the tolerance.
fn halve<R: LayerRule>(
    at: &dyn Fn(f32) -> R::Value,
    [from, to]: [(f32, R::Value); 2],
    (tolerance, halvings): (f32, u32),
    room: &mut usize,
    times: &mut Vec<f32>,
    values: &mut Vec<R::Value>,
) {
    let middle = from.0 + (to.0 - from.0) * 0.5;
    let quarter = from.0 + (to.0 - from.0) * 0.25;
    if halvings == 0 || *room == 0 || middle - from.0 <= JUMP {
        return;
    }
    let seen = at(middle);
    let off = |time: f32, seen: R::Value| {
        R::distance(R::Value::linear(from.1, to.1, (time - from.0) / (to.0 - from.0)), seen) > tolerance
    };
    if !off(middle, seen) && !off(quarter, at(quarter)) {
        return;
    }
    *room -= 1;
    halve::<R>(at, [from, (middle, seen)], (tolerance, halvings - 1), room, times, values);
    times.push(middle);
    values.push(seen);
    halve::<R>(at, [(middle, seen), to], (tolerance, halvings - 1), room, times, values);
}

/// Returns whether the sum may be no line between two neighboring times: a spline, or a layer or its weight that changes there.
fn bends<T: Value + PartialEq>(
    base: &Channel<T>,
    layers: &[LayerChannel<'_, T>],
    from: f32,
    to: f32,
) -> bool {
    let within = |channel: &Channel<T>| {
        let (first, last) = (channel.times.first(), channel.times.last());
        channel.len() > 1 && first.is_some_and(|&first| first < to) && last.is_some_and(|&last| last > from)
    };
    let spline =
        |channel: &Channel<T>| channel.interpolation == Interpolation::CubicSpline && within(channel);
    spline(base)
        || layers.iter().any(|layer| {
            within(layer.keys)
                || layer.settings.weight_at(from) != layer.settings.weight_at(to)
                || (layer.settings.mode == LayerMode::Override && within(base))
        })
}

/// Returns the times of all keys, ascending; before jumps also the time just before, where `jumps` is set.
fn all_times<T: Value>(base: &Channel<T>, layers: &[LayerChannel<'_, T>], jumps: bool) -> Vec<f32> {
    // The keys of the base come first, so that their times stay as they are.
    let mut times: Vec<(f32, u8)> = base.times.iter().map(|&time| (time, 0)).collect();
    let mut leaps: Vec<f32> = Vec::new();
    let mut leap = |channel: &Channel<T>| match channel.interpolation {
        Interpolation::Step => leaps.extend(channel.times.iter().skip(1)),
        // Rounding decides on which side of the jump half way is; half a jump later is after it.
        Interpolation::Closest => {
            leaps.extend(channel.times.windows(2).map(|pair| pair[0].midpoint(pair[1]) + 0.5 * JUMP));
        }
        Interpolation::Linear | Interpolation::CubicSpline => {}
    };
    leap(base);
    for layer in layers {
        leap(layer.keys);
        times.extend(layer.keys.times.iter().map(|&time| (time, 1)));
        times.extend(layer.settings.weights.iter().map(|key| (key.time, 1)));
    }
    if jumps {
        let start = times.iter().map(|(time, _)| *time).fold(f32::INFINITY, f32::min);
        times.extend(
            leaps.iter().flat_map(|&time| [(time, 1), (time - JUMP, 2)]).filter(|(time, _)| *time > start),
        );
    }
    times.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut found: Vec<(f32, u8)> = Vec::with_capacity(times.len());
    for (time, rank) in times {
        match found.last_mut() {
            Some(last) if time - last.0 < SAME => {
                if rank < last.1 {
                    *last = (time, rank);
                }
            }
            _ => found.push((time, rank)),
        }
    }
    found.into_iter().map(|(time, _)| time).collect()
}

/// Returns the values with neighboring rotations in one hemisphere, as the importers have them.
fn hemisphere<R: LayerRule>(mut values: Vec<R::Value>) -> Arc<[R::Value]> {
    for key in 1..values.len() {
        values[key] = R::near(values[key], values[key - 1]);
    }
    values.into()
}
