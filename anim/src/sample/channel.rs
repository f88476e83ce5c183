//! One property at one time: the four ways to find what lies between two keys.

use super::{Keys, Value, find_keys};
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
    match find_keys(&channel.times, time) {
        Some(keys) => sample_between(channel, rest, keys),
        None => rest,
    }
}

/// The value of `channel` between two of its keys, whichever they are: what [`sample_channel`] does once it knows them.
///
/// Key reduction asks it about keys that are not neighbours yet, and so gets what the shorter channel will give, bit
/// for bit.
pub(crate) fn sample_between<T: Value>(channel: &Channel<T>, rest: T, keys: Keys) -> T {
    let value = |key| key_value(channel, rest, key);
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
            let time = |key| channel.times.get(key).copied().unwrap_or(0.0);
            let span = time(keys.after) - time(keys.before);
            let (leave, arrive) = (out_tangent(channel, keys.before), in_tangent(channel, keys.after));
            T::cubic(before, leave, arrive, value(keys.after), span, keys.mix)
        }
    };
    if mixed.is_finite() { mixed } else { before }
}

/// The value of key number `key` as sampling uses it: usable, and `rest` where there is none.
pub(crate) fn key_value<T: Value>(channel: &Channel<T>, rest: T, key: usize) -> T {
    channel.value(key).map_or(rest, |value: T| value.healed(rest))
}

/// The tangent with which a cubic spline arrives at key number `key`; zero where it is missing or not finite.
pub(crate) fn in_tangent<T: Value>(channel: &Channel<T>, key: usize) -> T {
    tangent(channel, key.saturating_mul(3))
}

/// The tangent with which a cubic spline leaves key number `key`; zero where it is missing or not finite.
pub(crate) fn out_tangent<T: Value>(channel: &Channel<T>, key: usize) -> T {
    tangent(channel, key.saturating_mul(3).saturating_add(2))
}

/// The tangent stored at `position`; zero where it is missing or not finite.
fn tangent<T: Value>(channel: &Channel<T>, position: usize) -> T {
    channel.values.get(position).copied().filter(|tangent| tangent.is_finite()).unwrap_or(T::ZERO)
}
