//! Sampling of one property at one time: the four kinds of interpolation.

use super::{Keys, Value, find_keys};
use crate::data::{Channel, Interpolation};

/// Returns the value of `channel` at `time` seconds; clamped outside its keys, `rest` when it has no key.
///
/// | interpolation | between two keys |
/// |---|---|
/// | step | the key before |
/// | closest | the nearer key; half way, the later |
/// | linear | lerp; rotations slerp the short way |
/// | cubic spline | Hermite; rotations normalized |
///
/// On a key: its value, bit for bit. The result is finite when `rest` is (see the rules in [`super`]); a column shorter
/// than the times counts as rest values.
pub fn sample_channel<T: Value>(channel: &Channel<T>, rest: T, time: f32) -> T {
    match find_keys(&channel.times, time) {
        Some(keys) => sample_between(channel, rest, keys),
        None => rest,
    }
}

/// Returns the value of `channel` between any two of its keys: the second half of [`sample_channel`].
///
/// Key reduction calls it with keys that are not neighbors yet, and so gets the value of the shorter channel, bit for
/// bit.
pub(crate) fn sample_between<T: Value>(channel: &Channel<T>, rest: T, keys: Keys) -> T {
    interpolated(channel, rest, keys, |between| match channel.interpolation {
        Interpolation::Step => between.before,
        Interpolation::Closest if keys.mix < 0.5 => between.before,
        Interpolation::Closest => between.after,
        Interpolation::Linear => T::linear(between.before, between.after, keys.mix),
        Interpolation::CubicSpline => {
            let (leave, arrive) = (out_tangent(channel, keys.before), in_tangent(channel, keys.after));
            T::cubic(between.before, leave, arrive, between.after, between.seconds, keys.mix)
        }
    })
}

/// Input of an interpolation: a time strictly between two keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between<T> {
    /// Value of the key before the time, without tangents; usable, see [`Value::healed`].
    pub before: T,
    /// Value of the key after the time, without tangents; usable, see [`Value::healed`].
    pub after: T,
    /// Seconds from one key to the other.
    pub seconds: f32,
    /// The two keys and the fraction between them; an interpolation that uses further keys finds their neighbors by
    /// [`Channel::value`].
    pub keys: Keys,
}

/// Returns the value of `channel` at `time` seconds by the caller's own interpolation (thesis §2.1.5.2: any other is
/// valid too); [`Channel::interpolation`] only determines how the columns are laid out.
///
/// `interpolate` is called only strictly between two keys. Everything else is as in [`sample_channel`], which is this
/// function with the four of [`Interpolation`]: on a key and outside the keys the key's value, without keys `rest`, and
/// where the result is not finite the key before. A rotation has to be returned with unit length.
///
/// ```
/// use dragonfly_anim::data::{Channel, Interpolation};
/// use dragonfly_anim::sample::{Value, sample_channel_with};
/// let channel = Channel::new([0.0, 1.0], [2.0, 4.0], Interpolation::Linear);
/// // Ease in: the square of the fraction.
/// let slow = sample_channel_with(&channel, 0.0, 0.5, |between| {
///     f32::linear(between.before, between.after, between.keys.mix * between.keys.mix)
/// });
/// assert_eq!(slow, 2.5);
/// ```
pub fn sample_channel_with<T: Value>(
    channel: &Channel<T>,
    rest: T,
    time: f32,
    interpolate: impl FnOnce(Between<T>) -> T,
) -> T {
    match find_keys(&channel.times, time) {
        Some(keys) => interpolated(channel, rest, keys, interpolate),
        None => rest,
    }
}

fn interpolated<T: Value>(
    channel: &Channel<T>,
    rest: T,
    keys: Keys,
    interpolate: impl FnOnce(Between<T>) -> T,
) -> T {
    let value = |key| key_value(channel, rest, key);
    let before = value(keys.before);
    if keys.mix == 0.0 {
        return before;
    }
    let time = |key| channel.times.get(key).copied().unwrap_or(0.0);
    let seconds = time(keys.after) - time(keys.before);
    let mixed = interpolate(Between { before, after: value(keys.after), seconds, keys });
    if mixed.is_finite() { mixed } else { before }
}

/// Returns the value of key number `key` as sampling uses it: usable, and `rest` where there is none.
pub(crate) fn key_value<T: Value>(channel: &Channel<T>, rest: T, key: usize) -> T {
    channel.value(key).map_or(rest, |value: T| value.healed(rest))
}

/// Returns the in-tangent of a cubic spline at key number `key`; zero where it is missing or not finite.
pub(crate) fn in_tangent<T: Value>(channel: &Channel<T>, key: usize) -> T {
    tangent(channel, key.saturating_mul(3))
}

/// Returns the out-tangent of a cubic spline at key number `key`; zero where it is missing or not finite.
pub(crate) fn out_tangent<T: Value>(channel: &Channel<T>, key: usize) -> T {
    tangent(channel, key.saturating_mul(3).saturating_add(2))
}

/// Returns the tangent stored at `position`; zero where it is missing or not finite.
fn tangent<T: Value>(channel: &Channel<T>, position: usize) -> T {
    channel.values.get(position).copied().filter(|tangent| tangent.is_finite()).unwrap_or(T::ZERO)
}
