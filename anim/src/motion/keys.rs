//! Insertion of keys that leaves a curve unchanged.

use crate::data::{Channel, Interpolation};
use crate::sample::mix::hermite_slope;
use crate::sample::{Value, find_keys, sample_channel};
use glam::{Quat, Vec3};
use std::sync::Arc;

/// Returns all times of several lists, ascending, each once; those that are not finite are left out.
pub(super) fn union<'a>(lists: impl IntoIterator<Item = &'a [f32]>) -> Vec<f32> {
    let mut times: Vec<f32> = lists.into_iter().flatten().copied().filter(|time| time.is_finite()).collect();
    times.sort_by(f32::total_cmp);
    times.dedup();
    times
}

/// Returns whether `channel` has a key at each of `times`.
fn has_all<T>(channel: &Channel<T>, times: &[f32]) -> bool {
    let has = |time: &f32| channel.times.binary_search_by(|key| key.total_cmp(time)).is_ok();
    times.iter().all(has)
}

/// A type of value whose curves can be cut into more pieces.
pub(super) trait Refine: Value {
    /// Returns the same curve with keys at `times` (ascending, finite) as well; `rest` at all of them where it had
    /// none.
    ///
    /// Step and linear: the sampled values. Closest becomes step, which changes half way between the old keys. Cubic
    /// splines of vectors are cut exactly; those of rotations are not changed.
    fn refined(channel: &Channel<Self>, rest: Self, times: &[f32]) -> Channel<Self>;
}

impl Refine for Vec3 {
    fn refined(channel: &Channel<Self>, rest: Self, times: &[f32]) -> Channel<Self> {
        if channel.interpolation != Interpolation::CubicSpline || channel.is_empty() {
            return sampled(channel, rest, times);
        }
        if has_all(channel, times) {
            return channel.clone();
        }
        let (first, last) = channel.range().unwrap_or_default();
        let times = union([&channel.times, times]);
        let mut values = Vec::with_capacity(times.len() * 3);
        for &time in &times {
            let [before, after] = slopes(channel, rest, time);
            // Outside its keys the channel is constant, whatever the outer tangents are.
            let before = if time > first { before } else { Vec3::ZERO };
            let after = if time < last { after } else { Vec3::ZERO };
            values.extend([before, sample_channel(channel, rest, time), after]);
        }
        Channel { times: times.into(), values: values.into(), interpolation: Interpolation::CubicSpline }
    }
}

impl Refine for Quat {
    fn refined(channel: &Channel<Self>, rest: Self, times: &[f32]) -> Channel<Self> {
        if channel.interpolation == Interpolation::CubicSpline && !channel.is_empty() {
            return channel.clone();
        }
        sampled(channel, rest, times)
    }
}

/// Refines channels other than splines; see [`Refine::refined`].
fn sampled<T: Value>(channel: &Channel<T>, rest: T, times: &[f32]) -> Channel<T> {
    if has_all(channel, times) {
        return channel.clone();
    }
    let stepped;
    let source = if channel.interpolation == Interpolation::Closest {
        stepped = as_step(channel, rest);
        &stepped
    } else {
        channel
    };
    let times = union([&source.times, times]);
    let values: Vec<T> = times.iter().map(|&time| sample_channel(source, rest, time)).collect();
    let interpolation = match source.interpolation {
        Interpolation::CubicSpline => Interpolation::Linear,
        other => other,
    };
    Channel { times: times.into(), values: values.into(), interpolation }
}

/// Converts "closest key" to "last key": each key starts half way after the one before it.
fn as_step<T: Value>(channel: &Channel<T>, rest: T) -> Channel<T> {
    let (mut times, mut values): (Vec<f32>, Vec<T>) = (Vec::new(), Vec::new());
    for (index, &time) in channel.times.iter().enumerate() {
        let half = index.checked_sub(1).map_or(time, |before| half_way(channel.times[before], time));
        if times.last().is_some_and(|&last| half <= last) {
            times.pop();
            values.pop();
        }
        times.push(half);
        values.push(channel.value(index).map_or(rest, |value| value.healed(rest)));
    }
    Channel { times: times.into(), values: values.into(), interpolation: Interpolation::Step }
}

/// Returns the first time at which the later of two keys is the closest one, exactly as in sampling.
fn half_way(before: f32, after: f32) -> f32 {
    let later = |time: f32| find_keys(&[before, after], time).is_some_and(|keys| keys.mix >= 0.5);
    let mut half = before * 0.5 + after * 0.5;
    // Corrects rounding by a step or two.
    for _ in 0..4 {
        if !later(half) {
            half = half.next_up();
        } else if later(half.next_down()) {
            half = half.next_down();
        }
    }
    half.min(after)
}

/// Returns the derivative of the channel just before and just after `time`, in units per second.
///
/// On a key of a spline: its tangents. Between keys of a spline: the derivative of the Hermite polynomial. Elsewhere:
/// the difference quotient over a millisecond.
pub(super) fn slopes(channel: &Channel<Vec3>, rest: Vec3, time: f32) -> [Vec3; 2] {
    if let Some(tangents) = stored(channel, time) {
        return tangents;
    }
    if channel.interpolation != Interpolation::CubicSpline {
        return quotients(time, |time| sample_channel(channel, rest, time));
    }
    let Some(keys) = find_keys(&channel.times, time).filter(|keys| keys.mix > 0.0) else {
        return [Vec3::ZERO; 2];
    };
    let value = |key| channel.value(key).map_or(rest, |value: Vec3| value.healed(rest));
    let tangent = |at: usize| channel.values.get(at).copied().filter(|tangent| tangent.is_finite());
    let span = channel.times[keys.after] - channel.times[keys.before];
    let leave = tangent(keys.before * 3 + 2).unwrap_or(Vec3::ZERO);
    let arrive = tangent(keys.after * 3).unwrap_or(Vec3::ZERO);
    let slope = hermite_slope(value(keys.before), leave, arrive, value(keys.after), span, keys.mix);
    [slope; 2]
}

/// Returns [`slopes`] of rotations, as differences of quaternions.
pub(super) fn spins(channel: &Channel<Quat>, time: f32) -> [Quat; 2] {
    let tangents = stored(channel, time);
    tangents.unwrap_or_else(|| quotients(time, |time| sample_channel(channel, Quat::IDENTITY, time)))
}

/// Returns in-tangent and out-tangent where `time` is on a key of a spline.
fn stored<T: Value>(channel: &Channel<T>, time: f32) -> Option<[T; 2]> {
    if channel.interpolation != Interpolation::CubicSpline {
        return None;
    }
    let key = channel.times.binary_search_by(|key| key.total_cmp(&time)).ok()?;
    let tangent = |at: usize| channel.values.get(at).copied().filter(|tangent| tangent.is_finite());
    Some([tangent(key * 3).unwrap_or(T::ZERO), tangent(key * 3 + 2).unwrap_or(T::ZERO)])
}

/// Returns the difference quotients on both sides of `time`.
fn quotients<T>(time: f32, value: impl Fn(f32) -> T) -> [T; 2]
where
    T: Copy + std::ops::Sub<Output = T> + std::ops::Div<f32, Output = T>,
{
    let (before, after) = (time - 1e-3, time + 1e-3);
    let here = value(time);
    let quotient = |difference: T, span: f32| difference / span.max(1e-6);
    [quotient(here - value(before), time - before), quotient(value(after) - here, after - time)]
}

/// Returns a channel of changed values at the same times.
pub(super) fn with_values<T: Copy>(channel: &Channel<T>, values: Vec<T>) -> Channel<T> {
    Channel { times: Arc::clone(&channel.times), values: values.into(), interpolation: channel.interpolation }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spline() -> Channel<Vec3> {
        let x = |value: f32| Vec3::new(value, -value, 0.5);
        let values = [x(9.0), x(1.0), x(4.0), x(-2.0), x(5.0), x(1.0), x(0.5), x(2.0), x(9.0)];
        Channel::new([1.0, 3.0, 3.5], values, Interpolation::CubicSpline)
    }

    #[test]
    fn a_refined_curve_is_the_same_curve() {
        let more = [0.5, 1.25, 2.0, 3.0, 3.4, 4.0];
        for interpolation in
            [Interpolation::CubicSpline, Interpolation::Linear, Interpolation::Step, Interpolation::Closest]
        {
            let mut channel = spline();
            if interpolation != Interpolation::CubicSpline {
                channel = Channel::new([1.0, 3.0, 3.5], [Vec3::X, Vec3::Y, Vec3::Z], interpolation);
            }
            let refined = Vec3::refined(&channel, Vec3::ZERO, &more);
            assert!(refined.len() >= 8, "{interpolation:?}");
            for step in 0..=450 {
                let time = step as f32 * 0.01 + 0.001;
                let [old, new] = [&channel, &refined].map(|one| sample_channel(one, Vec3::ZERO, time));
                assert!(old.distance(new) < 2e-6, "{interpolation:?} {time}: {old} {new}");
            }
        }
    }

    #[test]
    fn slopes_are_the_tangents_on_a_key_and_the_derivative_between_keys() {
        let channel = spline();
        assert_eq!(slopes(&channel, Vec3::ZERO, 3.0), [channel.values[3], channel.values[5]]);
        let got = slopes(&channel, Vec3::ZERO, 2.2)[0];
        let [before, after] = [2.19, 2.21].map(|time| sample_channel(&channel, Vec3::ZERO, time));
        assert!((got - (after - before) / 0.02).length() < 1e-2, "{got}");
    }
}
