//! A part of a channel as keys of its own, which show the same motion.
//!
//! A key is added at each end of the part. Where an end cuts a cubic spline, the key there has the value and the slope of the curve, so
//! that the spline of the part is the same polynomial. The spline of a rotation is normalized, and a key of it is a unit
//! quaternion: the curve through the key at the cut is then another one, by the fourth power of the time between the keys.
//! Further keys are added between the cut and its neighbor where the difference would be seen.

use crate::data::{Channel, Interpolation};
use crate::sample::{Value, find_keys, in_tangent, key_value, mix, out_tangent, sample_channel};
use glam::{Quat, Vec3};
use std::ops::{Add, Mul, Sub};

/// Seconds within which two keys are at the same time.
pub(super) const SAME: f32 = 2e-5;

/// Largest difference of two rotations, as four numbers, that is not seen.
const UNSEEN: f32 = 1e-6;

/// Largest number of times that the spline next to a cut is halved.
const MOST_HALVES: u32 = 8;

/// A value that can be cut out of a spline.
pub(super) trait Cuttable:
    Value + Add<Output = Self> + Sub<Output = Self> + Mul<f32, Output = Self>
{
    /// Whether the value of a spline is normalized.
    const IS_NORMALIZED: bool = false;

    /// Returns the value and the slope of a key on the curve from those of the polynomial.
    fn on_curve(value: Self, slope: Self) -> (Self, Self) {
        (value, slope)
    }

    /// Returns the distance of two values; only of those that are normalized.
    fn apart(_a: Self, _b: Self) -> f32 {
        0.0
    }
}

impl Cuttable for f32 {}
impl Cuttable for Vec3 {}

impl Cuttable for Quat {
    const IS_NORMALIZED: bool = true;

    fn on_curve(value: Self, slope: Self) -> (Self, Self) {
        let length = value.length();
        if !(1e-6..1e6).contains(&length) {
            return (value, slope);
        }
        let unit = value / length;
        (unit, (slope - unit * unit.dot(slope)) / length)
    }

    fn apart(a: Self, b: Self) -> f32 {
        (a - b).length()
    }
}

/// A key with its tangents, which only a spline has.
#[derive(Clone, Copy, Debug)]
pub(super) struct PartKey<T> {
    pub(super) time: f32,
    pub(super) arrive: T,
    pub(super) value: T,
    pub(super) leave: T,
}

impl<T: Cuttable> PartKey<T> {
    fn still(time: f32, value: T) -> Self {
        Self { time, arrive: T::ZERO, value, leave: T::ZERO }
    }
}

/// Returns keys that show what a channel with keys shows from `from` to `to`, the first at `from`, the last at `to`.
pub(super) fn part<T: Cuttable>(channel: &Channel<T>, rest: T, from: f32, to: f32) -> Vec<PartKey<T>> {
    let inside = |time: f32| time > from + SAME && time < to - SAME;
    let keys = (0..channel.len()).filter(|&key| inside(channel.times[key]));
    let mut part = vec![border(channel, rest, from)];
    part.extend(keys.map(|key| stored(channel, rest, key)));
    part.push(border(channel, rest, to));
    match channel.interpolation {
        Interpolation::Step | Interpolation::Linear => part,
        Interpolation::Closest => with_switches(channel, part),
        Interpolation::CubicSpline if T::IS_NORMALIZED => refined(channel, rest, part),
        Interpolation::CubicSpline => part,
    }
}

/// Returns a key as it is stored. Where the channel is held before the first or after the last key, it has no slope there.
fn stored<T: Cuttable>(channel: &Channel<T>, rest: T, key: usize) -> PartKey<T> {
    let (time, value) = (channel.times[key], channel.value(key).unwrap_or(rest));
    let mut stored = PartKey::still(time, value);
    if channel.interpolation == Interpolation::CubicSpline {
        if key > 0 {
            stored.arrive = in_tangent(channel, key);
        }
        if key + 1 < channel.len() {
            stored.leave = out_tangent(channel, key);
        }
    }
    stored
}

/// Returns the key at an end of a part: one that is there, or a new one on the curve.
fn border<T: Cuttable>(channel: &Channel<T>, rest: T, time: f32) -> PartKey<T> {
    let near = channel.times.iter().position(|key| (key - time).abs() <= SAME);
    if let Some(key) = near {
        return PartKey { time, ..stored(channel, rest, key) };
    }
    let keys = find_keys(&channel.times, time).filter(|keys| keys.mix > 0.0);
    let Some(keys) = keys.filter(|_| channel.interpolation == Interpolation::CubicSpline) else {
        return PartKey::still(time, sample_channel(channel, rest, time));
    };
    let (a, b) = (key_value(channel, rest, keys.before), key_value(channel, rest, keys.after));
    let (leave, arrive) = (out_tangent(channel, keys.before), in_tangent(channel, keys.after));
    let seconds = channel.times[keys.after] - channel.times[keys.before];
    let value = mix::hermite(a, leave, arrive, b, seconds, keys.mix);
    let slope = mix::hermite_slope(a, leave, arrive, b, seconds, keys.mix);
    let (value, slope) = T::on_curve(value, slope);
    PartKey { time, arrive: slope, value, leave: slope }
}

/// Returns the part with keys that are as far after the switch from one closest key to the next as the cut is before it, so that the
/// switch stays where it was.
fn with_switches<T: Cuttable>(channel: &Channel<T>, part: Vec<PartKey<T>>) -> Vec<PartKey<T>> {
    let is_key = |time: f32| channel.times.iter().any(|key| (key - time).abs() <= SAME);
    let switch = |time: f32| {
        let after = channel.times.iter().position(|key| *key > time).filter(|after| *after > 0)?;
        Some(0.5 * (channel.times[after - 1] + channel.times[after]))
    };
    let mut all: Vec<PartKey<T>> = Vec::with_capacity(part.len() + 2);
    for (index, key) in part.iter().enumerate() {
        all.push(*key);
        let Some(next) = part.get(index + 1) else { continue };
        let cuts = [(key.time, next.value), (next.time, key.value)];
        for (cut, value) in cuts.into_iter().filter(|(cut, _)| !is_key(*cut)) {
            let Some(switch) = switch(cut) else { continue };
            let mirrored = 2.0 * switch - cut;
            let is_between = |time: f32| time > key.time + SAME && time < next.time - SAME;
            if is_between(switch) && is_between(mirrored) {
                all.push(PartKey::still(mirrored, value));
            }
        }
    }
    all
}

/// Returns the part with keys between those at a cut and their neighbors, where the spline would be another one without them.
fn refined<T: Cuttable>(channel: &Channel<T>, rest: T, part: Vec<PartKey<T>>) -> Vec<PartKey<T>> {
    let mut all: Vec<PartKey<T>> = Vec::with_capacity(part.len());
    let last = part.len() - 1;
    for (index, key) in part.iter().enumerate() {
        // Only the first and the last key of a part are new.
        if index == 1 || (index > 1 && index == last) {
            refine(channel, rest, &part[index - 1], key, MOST_HALVES, &mut all);
        }
        all.push(*key);
    }
    all
}

fn refine<T: Cuttable>(
    channel: &Channel<T>,
    rest: T,
    from: &PartKey<T>,
    to: &PartKey<T>,
    halves: u32,
    all: &mut Vec<PartKey<T>>,
) {
    let seconds = to.time - from.time;
    if halves == 0 || seconds < 8.0 * SAME {
        return;
    }
    let is_seen = [0.25, 0.5, 0.75].into_iter().any(|part| {
        let [a, b] = [from.value.healed(rest), to.value.healed(rest)];
        let shown = T::cubic(a, from.leave, to.arrive, b, seconds, part);
        let wanted = sample_channel(channel, rest, from.time + part * seconds);
        T::apart(shown, wanted) > UNSEEN
    });
    if !is_seen {
        return;
    }
    let middle = border(channel, rest, from.time + 0.5 * seconds);
    refine(channel, rest, from, &middle, halves - 1, all);
    all.push(middle);
    refine(channel, rest, &middle, to, halves - 1, all);
}
