//! Curves as keys with straight lines between them, for formats that have nothing else.

use crate::data::{Channel, Interpolation};

/// Keys per second of a curve that is no straight line.
const RATE: f32 = 60.0;

/// Most keys between two keys of a curve.
const MOST_BETWEEN: usize = 3_600;

/// Seconds before a jump at which its start has a key, in formats that count seconds.
pub(super) const JUMP: f32 = 1e-4;

/// Returns the times of keys with which straight lines follow a channel: its own where it is linear. A jump takes `jump` seconds.
pub(super) fn straight_times<T>(channel: &Channel<T>, jump: f32) -> Vec<f32> {
    let mut times = Vec::with_capacity(channel.times.len());
    for pair in channel.times.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        times.push(from);
        match channel.interpolation {
            Interpolation::Linear => {}
            Interpolation::CubicSpline => {
                let count = (((to - from) * RATE).ceil() as usize).clamp(1, MOST_BETWEEN);
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
    use crate::sample::sample_channel;

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
