//! Weights that change over time.

use super::fraction;
use crate::data::Channel;
use crate::sample::sample_channel;

/// Returns the weight of a layer at `time` seconds, from a curve of weights: 0..=1.
///
/// A curve is a [`Channel`] like any other, with any interpolation, sampled by [`sample_channel`]: before its first and
/// after its last key the weight is constant. Without a key, and for a key that is not finite, the weight is `usual`;
/// where a spline overshoots 0 or 1 it is clamped. NaN counts as 0.
pub fn weight_at(curve: &Channel<f32>, usual: f32, time: f32) -> f32 {
    fraction(sample_channel(curve, fraction(usual), time))
}
