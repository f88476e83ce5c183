//! Adds an interpolation that the library does not have: a curve through the keys without tangents (Catmull–Rom).
//!
//! `cargo run -p dragonfly-anim --example own_interpolation`

use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::sample::{Between, Value, sample_channel, sample_channel_with};
use glam::{Quat, Vec3};

/// Interpolation for `sample_channel_with`, for any [`Value`]: translations, rotations and scales.
///
/// The tangent at a key is the slope from the key before it to the key after it; at the first and the last key, the key
/// itself replaces the missing neighbor.
fn smooth<T: Value>(channel: &Channel<T>, between: Between<T>, slope: impl Fn(T, T, f32) -> T) -> T {
    let Between { before, after, seconds, keys } = between;
    let last = channel.len() - 1;
    let around = |key: usize| {
        let (from, to) = (key.saturating_sub(1), (key + 1).min(last));
        let value = |key| channel.value(key).unwrap_or(before).healed(before);
        slope(value(from), value(to), channel.times[to] - channel.times[from])
    };
    T::cubic(before, around(keys.before), around(keys.after), after, seconds, keys.mix)
}

/// Change of a vector per second.
fn of_vectors(from: Vec3, to: Vec3, seconds: f32) -> Vec3 {
    (to - from) / seconds
}

/// Change of a rotation per second; keys of one track are in one hemisphere.
fn of_rotations(from: Quat, to: Quat, seconds: f32) -> Quat {
    (to - from) * (1.0 / seconds)
}

pub(crate) fn main() {
    let times = [0.0, 0.5, 1.0, 1.5];
    let places = [Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0), Vec3::new(2.0, 0.0, 0.0), Vec3::new(3.0, 1.0, 0.0)];
    let moves = Channel::new(times, places, Interpolation::Linear);
    let turns = Channel::new(times, [0.0, 1.0, 1.5, 0.5].map(Quat::from_rotation_z), Interpolation::Linear);

    for step in 0..=30 {
        let time = step as f32 * 0.05;
        let straight = sample_channel(&moves, Vec3::ZERO, time);
        let place = sample_channel_with(&moves, Vec3::ZERO, time, |keys| smooth(&moves, keys, of_vectors));
        let turn =
            sample_channel_with(&turns, Quat::IDENTITY, time, |keys| smooth(&turns, keys, of_rotations));
        println!(
            "{time:.2} s: {place:.3} (straight: {straight:.3}), turned by {:.3}",
            turn.to_scaled_axis().z
        );
        assert!(turn.is_normalized());
        // On a key its value is exact, with any interpolation.
        if let Some(key) = times.iter().position(|&key| key == time) {
            assert_eq!(place, places[key]);
        }
    }
}
