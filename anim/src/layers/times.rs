//! The times at which the sum of a base and its layers needs keys.

use super::LayerChannel;
use crate::data::{Channel, Interpolation};
use crate::sample::Value;

/// Seconds between the two keys of a jump of a channel with steps.
pub(super) const JUMP: f32 = 1e-4;

/// Seconds: times that are nearer to each other are the same.
const SAME: f32 = 5e-5;

/// Returns the times of all keys, ascending; before jumps also the time just before, where `jumps` is set.
pub(super) fn all_times<T: Value>(
    base: &Channel<T>,
    layers: &[LayerChannel<'_, T>],
    jumps: bool,
) -> Vec<f32> {
    // The keys of the base come first, so that their times stay as they are.
    let mut times: Vec<(f32, u8)> = base.times.iter().map(|&time| (time, 0)).collect();
    let mut leaps: Vec<f32> = Vec::new();
    let mut leap = |channel: &Channel<T>| match channel.interpolation {
        Interpolation::Step => leaps.extend(channel.times.iter().skip(1)),
        // Rounding decides on which side of the jump half way is; half a jump later is after it.
        Interpolation::Closest => {
            leaps.extend(channel.times.windows(2).map(|pair| pair[0].midpoint(pair[1]) + 0.5 * JUMP));
        }
        Interpolation::Linear | Interpolation::CubicSpline => {}
    };
    leap(base);
    for layer in layers {
        leap(layer.keys);
        times.extend(layer.keys.times.iter().map(|&time| (time, 1)));
        times.extend(layer.settings.weights.iter().map(|key| (key.time, 1)));
    }
    if jumps {
        let start = times.iter().map(|(time, _)| *time).fold(f32::INFINITY, f32::min);
        times.extend(
            leaps.iter().flat_map(|&time| [(time, 1), (time - JUMP, 2)]).filter(|(time, _)| *time > start),
        );
    }
    times.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut found: Vec<(f32, u8)> = Vec::with_capacity(times.len());
    for (time, rank) in times {
        match found.last_mut() {
            Some(last) if time - last.0 < SAME => {
                if rank < last.1 {
                    *last = (time, rank);
                }
            }
            _ => found.push((time, rank)),
        }
    }
    found.into_iter().map(|(time, _)| time).collect()
}
