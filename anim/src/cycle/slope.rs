//! The value and the slope of a curve at a time.

use crate::data::{Channel, Interpolation};
use crate::sample::mix::hermite_slope;
use crate::sample::{Value, find_keys, sample_channel};
use std::ops::{Add, Mul, Sub};

/// Returns the value of a channel at a time, and its slope per second: zero where it is no spline, and outside the keys.
pub fn value_and_slope<T>(channel: &Channel<T>, rest: T, time: f32) -> [T; 2]
where
    T: Value + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>,
{
    let value = sample_channel(channel, rest, time);
    let keys = find_keys(&channel.times, time);
    let inside =
        keys.filter(|keys| channel.interpolation == Interpolation::CubicSpline && keys.before != keys.after);
    let Some(keys) = inside else { return [value, T::ZERO] };
    let at = |index: usize| channel.values.get(index).copied().unwrap_or(T::ZERO);
    let span = channel.times[keys.after] - channel.times[keys.before];
    let (from, leave) = (at(keys.before * 3 + 1), at(keys.before * 3 + 2));
    let (arrive, to) = (at(keys.after * 3), at(keys.after * 3 + 1));
    [value, hermite_slope(from, leave, arrive, to, span, keys.mix)]
}
