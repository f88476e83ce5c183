//! Takes whose start and length do not match their keys.

use crate::check::{Findings, TakeContext};

/// Tolerance in seconds, and as a fraction of the larger number, for the rounding of start plus length.
const TOLERANCE: f32 = 1e-5;

pub(crate) fn check(of: &TakeContext<'_>, findings: &mut Findings) {
    let take = of.take;
    let (mut first, mut last) = (f32::INFINITY, f32::NEG_INFINITY);
    let tracks = take
        .tracks
        .iter()
        .flat_map(|track| [&track.translation.times, &track.rotation.times, &track.scale.times]);
    for &time in tracks.chain(take.morphs.iter().map(|morph| &morph.times)).flat_map(|times| times.iter()) {
        (first, last) = (first.min(time), last.max(time));
    }
    if !take.start.is_finite() || !take.length.is_finite() || take.length < 0.0 {
        findings.add(|| (of.path(), format!("starts at {} s and is {} s long", take.start, take.length)));
        return;
    }
    let tolerance = TOLERANCE * first.abs().max(last.abs()).max(1.0);
    let off = (take.start - first).abs().max((take.end() - last).abs());
    // Infinite keys have a rule of their own; without keys there is nothing to compare.
    if first.is_finite() && last.is_finite() && off > tolerance {
        let text =
            || format!("from {} s to {} s, but its keys from {first} s to {last} s", take.start, take.end());
        findings.add(|| (of.path(), text()));
    }
}
