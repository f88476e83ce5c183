//! Weights of morph targets at one time.

use super::{Keys, find_keys, mix};
use crate::data::{Interpolation, MorphTrack, Take};

/// Samples the weights of the morph targets of instance number `instance` at `time` seconds, into `out` (one per
/// target).
///
/// Where `take` does not animate them: `rest`, the instance's own weights; zero where `rest` is shorter. The rules of
/// [`super::sample_channel`] apply to each weight by itself. Allocates nothing.
pub fn sample_morph_weights(take: Option<&Take>, instance: u32, rest: &[f32], time: f32, out: &mut [f32]) {
    let track = take.and_then(|take| take.morphs.iter().find(|track| track.instance == instance));
    let animated = track.and_then(|track| Some((track, find_keys(&track.times, time)?)));
    for (target, weight) in out.iter_mut().enumerate() {
        let rest = rest.get(target).copied().filter(|weight| weight.is_finite()).unwrap_or(0.0);
        *weight = animated.as_ref().map_or(rest, |(track, keys)| sample_weight(track, keys, target, rest));
    }
}

/// Samples one weight; a file stores the weights of a key next to each other.
fn sample_weight(track: &MorphTrack, keys: &Keys, target: usize, rest: f32) -> f32 {
    let targets = track.targets as usize;
    if target >= targets {
        return rest;
    }
    let parts = if track.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    // The parts of a key of a cubic spline: 0 in-tangents, 1 values, 2 out-tangents. Other keys have one part, the
    // values.
    let stored = |key: usize, part: usize, fallback: f32| {
        let row = key.saturating_mul(parts).saturating_add(part);
        let position = row.saturating_mul(targets).saturating_add(target);
        track.weights.get(position).copied().filter(|weight| weight.is_finite()).unwrap_or(fallback)
    };
    let value = |key| stored(key, parts / 2, rest);
    let before = value(keys.before);
    if keys.mix == 0.0 {
        return before;
    }
    let mixed = match track.interpolation {
        Interpolation::Step => before,
        Interpolation::Closest if keys.mix < 0.5 => before,
        Interpolation::Closest => value(keys.after),
        Interpolation::Linear => mix::lerp(before, value(keys.after), keys.mix),
        Interpolation::CubicSpline => {
            let span = track.times[keys.after] - track.times[keys.before];
            let (leave, arrive) = (stored(keys.before, 2, 0.0), stored(keys.after, 0, 0.0));
            mix::hermite(before, leave, arrive, value(keys.after), span, keys.mix)
        }
    };
    if mixed.is_finite() { mixed } else { before }
}
