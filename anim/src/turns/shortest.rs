//! Signs of quaternions that agree.

use crate::data::{Channel, Interpolation};
use glam::Quat;

/// Returns the channel with each of its keys `chosen` having the sign nearer to the key before; see [the module](super). Rotations
/// stay the same. A channel whose columns do not fit together stays as it is.
pub fn shortest_way(channel: &Channel<Quat>, chosen: impl Fn(usize) -> bool) -> Channel<Quat> {
    let mut values = channel.values.to_vec();
    let per_key = channel.values_per_key();
    let middle = usize::from(channel.interpolation == Interpolation::CubicSpline);
    if values.len() != channel.len() * per_key {
        return channel.clone();
    }
    for key in (1..channel.len()).filter(|&key| chosen(key)) {
        let [before, now] = [key - 1, key].map(|key| values[key * per_key + middle].as_dquat());
        if before.dot(now) < 0.0 {
            values[key * per_key..(key + 1) * per_key].iter_mut().for_each(|value| *value = -*value);
        }
    }
    Channel { values: values.into(), ..channel.clone() }
}
