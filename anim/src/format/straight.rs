//! Curves as keys with straight lines between them, for formats that have nothing else.

use crate::data::{Channel, Interpolation};
use crate::sample::{Value, sample_channel};
use glam::{Quat, Vec3};

/// Least number of keys per second of a curve that is no straight line.
const RATE: f32 = 60.0;

/// Largest number of keys per second of a curve.
const MOST_RATE: f32 = 240.0;

/// Angle in radians by which a rotation may be off its curve between two keys.
const ANGLE: f32 = 2e-4;

/// Share of its extent by which a vector may be off its curve between two keys.
const SHARE: f32 = 1e-4;

/// Places between two keys at which the distance to the curve is measured.
const BETWEEN: [f32; 3] = [0.25, 0.5, 0.75];

/// Most keys between two keys of a curve.
const MOST_BETWEEN: usize = 3_600;

/// Seconds before a jump at which its start has a key, in formats that count seconds.
pub(super) const JUMP: f32 = 1e-4;

/// A value between which straight lines are drawn.
pub(super) trait LineValue: Value {
    /// Returns how far two values of a channel are from each other.
    fn distance_to(self, other: Self) -> f32;

    /// Returns the distance that lines may have from the curve of a channel.
    fn tolerance(channel: &Channel<Self>) -> f32;
}

impl LineValue for Vec3 {
    fn distance_to(self, other: Self) -> f32 {
        self.distance(other)
    }

    fn tolerance(channel: &Channel<Self>) -> f32 {
        let keys = (0..channel.len()).filter_map(|key| channel.value(key));
        let [low, high] = [Vec3::min, Vec3::max].map(|of| keys.clone().reduce(of).unwrap_or_default());
        SHARE * high.distance(low)
    }
}

impl LineValue for Quat {
    fn distance_to(self, other: Self) -> f32 {
        let other = if self.dot(other) < 0.0 { -other } else { other };
        2.0 * (self - other).length()
    }

    fn tolerance(_channel: &Channel<Self>) -> f32 {
        ANGLE
    }
}

/// Returns the number of lines that follow a curve between two of its keys: the fewest with small distances, from 60 to 240 per second.
fn lines<T: LineValue>(channel: &Channel<T>, from: f32, to: f32) -> usize {
    let count = |rate: f32| (((to - from) * rate).ceil() as usize).clamp(1, MOST_BETWEEN);
    let (tolerance, most) = (T::tolerance(channel), count(MOST_RATE));
    let at = |time: f32| sample_channel(channel, T::ZERO, time);
    let mut parts = count(RATE);
    let is_near = |parts: usize| {
        let time = |part: f32| from + (to - from) * (part / parts as f32);
        (0..parts).all(|part| {
            let part = part as f32;
            let (start, end) = (at(time(part)), at(time(part + 1.0)));
            let off = |mix: &f32| at(time(part + mix)).distance_to(T::linear(start, end, *mix));
            BETWEEN.iter().all(|mix| off(mix) <= tolerance)
        })
    };
    while parts < most && !is_near(parts) {
        parts = (2 * parts).min(most);
    }
    parts
}

/// Returns the times of keys with which straight lines follow a channel: its own where it is linear. A jump takes `jump` seconds.
pub(super) fn straight_times<T: LineValue>(channel: &Channel<T>, jump: f32) -> Vec<f32> {
    let mut times = Vec::with_capacity(channel.times.len());
    for pair in channel.times.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        times.push(from);
        match channel.interpolation {
            Interpolation::Linear => {}
            Interpolation::CubicSpline => {
                let count = lines(channel, from, to);
                times.extend((1..count).map(|part| from + (to - from) * (part as f32 / count as f32)));
            }
            Interpolation::Step => times.push((to - jump).max(from + (to - from) * 0.5)),
            Interpolation::Closest => {
                let middle = from + (to - from) * 0.5;
                times.extend([(middle - jump).max(from + (to - from) * 0.25), middle]);
            }
        }
    }
    times.extend(channel.times.last());
    times.dedup();
    times
}

/// Returns whether keys alone are the whole curve.
pub(super) fn is_straight<T>(channel: &Channel<T>) -> bool {
    channel.interpolation == Interpolation::Linear || channel.times.len() < 2
}

/// Returns the times of several lists in ascending order, each once.
pub(super) fn union(lists: [Vec<f32>; 3]) -> Vec<f32> {
    let mut times = lists.concat();
    times.sort_by(f32::total_cmp);
    times.dedup();
    times
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_between_the_keys_follow_curves_of_every_kind() {
        for interpolation in
            [Interpolation::Linear, Interpolation::Step, Interpolation::Closest, Interpolation::CubicSpline]
        {
            let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
            let values: Vec<f32> = (0..3 * per_key).map(|index| (index * index % 7) as f32).collect();
            let values: Vec<glam::Vec3> = values.into_iter().map(glam::Vec3::splat).collect();
            let channel = Channel::new([0.0, 0.5, 2.0], values, interpolation);
            let times = straight_times(&channel, JUMP);
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
            let rest = glam::Vec3::ZERO;
            let keys: Vec<glam::Vec3> =
                times.iter().map(|&time| sample_channel(&channel, rest, time)).collect();
            let lines = Channel::new(times, keys, Interpolation::Linear);
            for step in 0..200 {
                let time = step as f32 * 0.01 + 0.0011;
                let off = sample_channel(&channel, rest, time).distance(sample_channel(&lines, rest, time));
                assert!(off < 0.02, "{interpolation:?} at {time}: {off}");
            }
            assert_eq!(is_straight(&channel), interpolation == Interpolation::Linear);
        }
    }
}
