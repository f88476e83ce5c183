//! One property at one time: the four ways to find what lies between two keys.

use super::{Value, find_keys};
use crate::data::{Channel, Interpolation};

/// Value of `channel` at `time` seconds; clamped outside its keys, `rest` when it has no key.
///
/// | interpolation | between two keys |
/// |---|---|
/// | step | the key before |
/// | closest | the nearer key; half way, the later |
/// | linear | lerp; rotations slerp the short way |
/// | cubic spline | Hermite; rotations normalised |
///
/// On a key: its value, bit for bit. The result is finite when `rest` is (see the rules in [`super`]); a column shorter
/// than the times counts as rest values.
pub fn sample_channel<T: Value>(channel: &Channel<T>, rest: T, time: f32) -> T {
    let Some(keys) = find_keys(&channel.times, time) else { return rest };
    let value = |key| channel.value(key).map_or(rest, |value: T| value.healed(rest));
    let before = value(keys.before);
    if keys.mix == 0.0 {
        return before;
    }
    let mixed = match channel.interpolation {
        Interpolation::Step => before,
        Interpolation::Closest if keys.mix < 0.5 => before,
        Interpolation::Closest => value(keys.after),
        Interpolation::Linear => T::linear(before, value(keys.after), keys.mix),
        Interpolation::CubicSpline => {
            let span = channel.times[keys.after] - channel.times[keys.before];
            let out_tangent = tangent(channel, keys.before * 3 + 2);
            let in_tangent = tangent(channel, keys.after * 3);
            T::cubic(before, out_tangent, in_tangent, value(keys.after), span, keys.mix)
        }
    };
    if mixed.is_finite() { mixed } else { before }
}

/// The tangent stored at `position`; zero where it is missing or not finite.
fn tangent<T: Value>(channel: &Channel<T>, position: usize) -> T {
    channel.values.get(position).copied().filter(|tangent| tangent.is_finite()).unwrap_or(T::ZERO)
}
