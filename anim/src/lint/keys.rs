//! Measures of keys: keys without need, and keys outside of the range of the take.
//!
//! A key is spare if it lies on the line between its neighbors, within the tolerance:
//!
//! ```text
//! | x(k) − mix(x(k−1), x(k+1)) | ≤ tolerance        mix at the time of k
//! ```
//!
//! Only linear channels with a key on each frame are measured: a few spare keys elsewhere were set by an animator.

use super::{LintReport, LintThresholds};
use crate::data::{Channel, Interpolation, Take};
use crate::sample::Value;
use glam::{Quat, Vec3};

/// Fewest keys of a channel that is measured.
const FEWEST: usize = 8;

pub(super) fn spare(take: &Take, rate: f32, thresholds: &LintThresholds, add: LintReport<'_>) {
    let tolerance = thresholds.key_tolerance;
    let length = tolerance / thresholds.contacts.meters_per_unit.max(f32::MIN_POSITIVE);
    let vectors = |a: Vec3, b: Vec3| a.distance(b) <= length;
    let factors = |a: Vec3, b: Vec3| a.distance(b) <= tolerance;
    let rotations = |a: Quat, b: Quat| (a - b).length().min((a + b).length()) <= tolerance;
    for track in &take.tracks {
        let shares = [
            share(&track.translation, rate, vectors),
            share(&track.rotation, rate, rotations),
            share(&track.scale, rate, factors),
        ];
        // A channel that does not move counts like any other: exporters write it with a key on each frame.
        let most = shares.into_iter().flatten().max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((time, share)) = most {
            add(track.bone, time, share);
        }
    }
}

/// Returns the time of the first spare key, and the share of spare keys in percent; `None` where the channel is not measured.
fn share<T: Value>(channel: &Channel<T>, rate: f32, same: impl Fn(T, T) -> bool) -> Option<(f32, f32)> {
    let (times, values) = (&channel.times, &channel.values);
    let frame = 1.5 / rate;
    let dense = times.windows(2).all(|pair| pair[1] - pair[0] <= frame);
    if channel.interpolation != Interpolation::Linear || times.len() < FEWEST || !dense {
        return None;
    }
    let is_spare = |&key: &usize| {
        let mix = (times[key] - times[key - 1]) / (times[key + 1] - times[key - 1]);
        same(values[key], T::linear(values[key - 1], values[key + 1], mix))
    };
    let spare: Vec<usize> = (1..times.len() - 1).filter(is_spare).collect();
    let first = *spare.first()?;
    Some((times[first], 100.0 * spare.len() as f32 / times.len() as f32))
}

pub(super) fn outside(take: &Take, add: LintReport<'_>) {
    for track in &take.tracks {
        let beyond = |time: f32| (take.start - time).max(time - take.end()) * 1000.0;
        let keys = track.key_times().into_iter();
        if let Some(time) = keys.max_by(|a, b| beyond(*a).total_cmp(&beyond(*b))) {
            add(track.bone, time, beyond(time));
        }
    }
}
