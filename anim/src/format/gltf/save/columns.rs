//! Converts a channel to glTF: times and values as bytes, and the name of the interpolation.

use super::super::target_path::TargetPath;
use super::error::SaveError;
use crate::data::{Channel, Interpolation, MorphTrack};
use crate::limits::{CLIP_SECONDS, KEYS_PER_CHANNEL};
use crate::sample::find_keys;
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Largest deviation of a rotation's length from one (the Khronos validator's tolerance).
const ROTATION_TOLERANCE: f64 = 0.00769;

/// The keys of one target, of whatever type.
#[derive(Clone, Copy)]
pub(in crate::format::gltf) enum KeyColumns<'a> {
    Vector(&'a Channel<Vec3>),
    Rotation(&'a Channel<Quat>),
    Weights(&'a MorphTrack),
}

impl KeyColumns<'_> {
    pub(in crate::format::gltf) fn times(&self) -> &Arc<[f32]> {
        match self {
            Self::Vector(channel) => &channel.times,
            Self::Rotation(channel) => &channel.times,
            Self::Weights(track) => &track.times,
        }
    }

    fn interpolation(&self) -> Interpolation {
        match self {
            Self::Vector(channel) => channel.interpolation,
            Self::Rotation(channel) => channel.interpolation,
            Self::Weights(track) => track.interpolation,
        }
    }

    /// Returns all numbers of all values.
    fn numbers(&self) -> Vec<f32> {
        match self {
            Self::Vector(channel) => channel.values.iter().flat_map(|value| value.to_array()).collect(),
            Self::Rotation(channel) => channel.values.iter().flat_map(|value| value.to_array()).collect(),
            Self::Weights(track) => track.weights.to_vec(),
        }
    }

    /// Returns the number of components of one value.
    fn width(&self) -> usize {
        match self {
            Self::Vector(_) => 3,
            Self::Rotation(_) => 4,
            Self::Weights(track) => track.targets as usize,
        }
    }

    fn shape(&self) -> &'static str {
        match self {
            Self::Vector(_) => "VEC3",
            Self::Rotation(_) => "VEC4",
            Self::Weights(_) => "SCALAR",
        }
    }

    /// Returns whether these are its numbers, bit for bit.
    pub(super) fn holds(&self, numbers: &[f32]) -> bool {
        !numbers.is_empty() && same_bits(&self.numbers(), numbers)
    }

    /// Returns whether all bits are the same. Two channels without keys are the same, whatever their other fields.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        if self.times().is_empty() && other.times().is_empty() {
            return true;
        }
        let shared = match (self, other) {
            (Self::Vector(a), Self::Vector(b)) => Arc::ptr_eq(&a.values, &b.values),
            (Self::Rotation(a), Self::Rotation(b)) => Arc::ptr_eq(&a.values, &b.values),
            (Self::Weights(a), Self::Weights(b)) => {
                Arc::ptr_eq(&a.weights, &b.weights) && a.targets == b.targets
            }
            _ => false,
        };
        self.interpolation() == other.interpolation()
            && (Arc::ptr_eq(self.times(), other.times()) || same_bits(self.times(), other.times()))
            && (shared || (self.width() == other.width() && same_bits(&self.numbers(), &other.numbers())))
    }
}

fn same_bits(a: &[f32], b: &[f32]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

/// Keys ready to be written.
#[derive(Clone, Debug)]
pub(in crate::format::gltf) struct EncodedKeys {
    /// Seconds, strictly ascending; shared between channels where possible.
    pub(super) times: Arc<[f32]>,
    /// Components of the values, tangents included.
    pub(super) values: Vec<f32>,
    /// Type of a value: `VEC3`, `VEC4` or `SCALAR`.
    pub(super) shape: &'static str,
    /// Interpolation: `STEP`, `LINEAR` or `CUBICSPLINE`.
    pub(super) interpolation: &'static str,
}

impl EncodedKeys {
    /// Returns the key times in seconds, strictly ascending.
    pub(in crate::format::gltf) fn times(&self) -> &Arc<[f32]> {
        &self.times
    }

    /// Returns the components of the values, tangents included.
    pub(in crate::format::gltf) fn values(&self) -> &[f32] {
        &self.values
    }

    /// Returns the type of a value: `VEC3`, `VEC4` or `SCALAR`.
    pub(in crate::format::gltf) fn shape(&self) -> &'static str {
        self.shape
    }

    /// Returns the name of the interpolation.
    pub(in crate::format::gltf) fn interpolation(&self) -> &'static str {
        self.interpolation
    }

    /// Returns the number of elements of the output accessor.
    pub(super) fn value_count(&self) -> usize {
        self.values.len() / shape_width(self.shape)
    }
}

pub(super) fn shape_width(shape: &str) -> usize {
    match shape {
        "VEC3" => 3,
        "VEC4" => 4,
        _ => 1,
    }
}

/// Owner of the keys, for error messages.
#[derive(Clone, Copy)]
pub(in crate::format::gltf) struct KeysOwner<'a> {
    pub(in crate::format::gltf) take: &'a str,
    pub(in crate::format::gltf) bone: &'a str,
    pub(in crate::format::gltf) path: TargetPath,
}

impl KeysOwner<'_> {
    fn refuse<T>(&self, reason: impl Into<String>) -> Result<T, SaveError> {
        Err(SaveError::Keys {
            take: self.take.to_owned(),
            bone: self.bone.to_owned(),
            path: self.path.name(),
            reason: reason.into(),
        })
    }
}

/// Checks a channel with keys and converts it to what glTF can represent.
///
/// * Closest-key interpolation becomes an exact step: a step at each time from which on the next key is the nearest,
///   and one more at the end, so that the take keeps its length.
/// * A spline of one key is written as that key with linear interpolation, because glTF requires two keys of a spline.
pub(in crate::format::gltf) fn keys(
    column: KeyColumns<'_>,
    owner: KeysOwner<'_>,
) -> Result<EncodedKeys, SaveError> {
    let interpolation = column.interpolation();
    let numbers = column.numbers();
    check_times(column.times(), owner)?;
    let count = column.times().len();
    let parts = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let per_key = column.width() * parts;
    if per_key == 0 || count.checked_mul(per_key) != Some(numbers.len()) {
        return owner.refuse(format!("{} numbers for {count} keys of {per_key}", numbers.len()));
    }
    if let Some(odd) = numbers.iter().position(|number| !number.is_finite()) {
        return owner.refuse(format!("key {} is not finite", odd / per_key));
    }
    let keys = EncodedKeys {
        times: column.times().clone(),
        values: numbers,
        shape: column.shape(),
        interpolation: "LINEAR",
    };
    let keys = match interpolation {
        Interpolation::Step => EncodedKeys { interpolation: "STEP", ..keys },
        Interpolation::Linear => keys,
        Interpolation::CubicSpline if count == 1 => {
            let width = column.width();
            EncodedKeys { values: keys.values[width..2 * width].to_vec(), ..keys }
        }
        Interpolation::CubicSpline => EncodedKeys { interpolation: "CUBICSPLINE", ..keys },
        Interpolation::Closest => stepped(&keys, column.width()),
    };
    check_rotations(&keys, owner)?;
    Ok(keys)
}

fn check_times(times: &[f32], owner: KeysOwner<'_>) -> Result<(), SaveError> {
    if times.len() > KEYS_PER_CHANNEL {
        return owner.refuse(format!("{} keys, at most {KEYS_PER_CHANNEL}", times.len()));
    }
    for (key, &time) in times.iter().enumerate() {
        if !time.is_finite() {
            return owner.refuse(format!("the time of key {key} is {time}"));
        }
        if time.abs() > CLIP_SECONDS {
            return owner.refuse(format!("key {key} is at {time} s, at most {CLIP_SECONDS} s"));
        }
        if key > 0 && times[key - 1] >= time {
            return owner.refuse(format!("key {key} at {time} s is not later than the key before it"));
        }
    }
    Ok(())
}

/// Refuses rotations that are not of unit length, because readers differ in how they treat them.
fn check_rotations(keys: &EncodedKeys, owner: KeysOwner<'_>) -> Result<(), SaveError> {
    if owner.path != TargetPath::Rotation {
        return Ok(());
    }
    let spline = keys.interpolation == "CUBICSPLINE";
    for (index, value) in keys.values.chunks_exact(4).enumerate() {
        if spline && index % 3 != 1 {
            continue;
        }
        let length = value.iter().map(|&number| f64::from(number).powi(2)).sum::<f64>().sqrt();
        if (length - 1.0).abs() > ROTATION_TOLERANCE {
            let key = if spline { index / 3 } else { index };
            return owner.refuse(format!("the rotation of key {key} has length {length}, not 1"));
        }
    }
    Ok(())
}

/// Converts closest-key interpolation to steps.
fn stepped(keys: &EncodedKeys, width: usize) -> EncodedKeys {
    let value = |key: usize| &keys.values[key * width..][..width];
    let last = keys.times.len() - 1;
    let mut times = vec![keys.times[0]];
    let mut values = value(0).to_vec();
    for key in 1..=last {
        times.push(nearest_from(keys.times[key - 1], keys.times[key]));
        values.extend(value(key));
    }
    if last > 0 && times[last] < keys.times[last] {
        times.push(keys.times[last]);
        values.extend(value(last));
    }
    EncodedKeys { times: times.into(), values, shape: keys.shape, interpolation: "STEP" }
}

/// Returns the first time after `before` at which sampling finds `after` the nearer of the two.
fn nearest_from(before: f32, after: f32) -> f32 {
    let is_after =
        |time: f32| time >= after || find_keys(&[before, after], time).is_some_and(|keys| keys.mix >= 0.5);
    // The share between two keys never decreases with time, so a binary search finds the first time.
    let (mut low, mut high) = (before, after);
    while low.next_up() < high {
        let middle = low + (high - low) * 0.5;
        let middle = if middle > low && middle < high { middle } else { low.next_up() };
        if is_after(middle) { high = middle } else { low = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::sample_channel;

    #[test]
    fn closest_key_converted_to_step_has_the_same_value_at_every_time() {
        let times: [f32; 5] = [0.0, 0.1, 0.3, 7.7, 7.700_001];
        let values: Vec<Vec3> = (0..5).map(|key| Vec3::splat(key as f32)).collect();
        let closest = Channel::new(times, values, Interpolation::Closest);
        let owner = KeysOwner { take: "", bone: "", path: TargetPath::Translation };
        let keys = keys(KeyColumns::Vector(&closest), owner).unwrap();
        assert_eq!(keys.interpolation, "STEP");
        assert!(keys.times.windows(2).all(|pair| pair[0] < pair[1]), "{:?}", keys.times);
        assert_eq!(keys.times.last(), times.last());
        let values: Vec<Vec3> = keys.values.chunks_exact(3).map(Vec3::from_slice).collect();
        let step = Channel::new(keys.times.clone(), values, Interpolation::Step);
        let mut probes: Vec<f32> = keys.times.iter().flat_map(|t| [t.next_down(), *t, t.next_up()]).collect();
        probes.extend((0..10_000).map(|n| n as f32 * 0.000_9 - 0.5));
        for time in probes {
            let (a, b) =
                (sample_channel(&closest, Vec3::ZERO, time), sample_channel(&step, Vec3::ZERO, time));
            assert_eq!(a, b, "at {time}");
        }
    }
}
