//! The pixel filter: the weight of light by its distance from the middle of a pixel.
//!
//! Each axis has the four-term window of Blackman and Harris (F. J. Harris, "On the Use of Windows for Harmonic Analysis with the Discrete
//! Fourier Transform", 1978) with a radius of 1.5 pixels, which Blender uses, too. Positions are drawn from the filter, so every sub-frame
//! has the same weight (M. Ernst, M. Stamminger, G. Greiner, "Filter Importance Sampling", 2006).

use std::f64::consts::PI;

/// Distance from the middle of a pixel at which light stops counting, pixels.
pub const FILTER_RADIUS: f64 = 1.5;

/// Factors of the constant term and of the cosines of 1, 2 and 3 half turns.
const TERMS: [f64; 4] = [0.358_75, 0.488_29, 0.141_28, 0.011_68];

/// Variance of the positions of the samples of a pixel along an axis, square pixels: ±1/8 and ±3/8.
const MULTISAMPLE_VARIANCE: f64 = 5.0 / 64.0;

/// Returns the weight at `at`, a part of the radius: 1 in the middle, 0 from 1 on.
pub fn blackman_harris(at: f64) -> f64 {
    if at.abs() >= 1.0 {
        return 0.0;
    }
    (0_u32..).zip(TERMS).map(|(turn, factor)| factor * (PI * f64::from(turn) * at).cos()).sum()
}

/// Returns the part of the weight of the filter that is before `at`.
fn cdf(at: f64) -> f64 {
    let [constant, cosines @ ..] = TERMS;
    let waves = (1_u32..).zip(cosines).map(|(turn, factor)| {
        let frequency = PI * f64::from(turn);
        factor * (frequency * at).sin() / frequency
    });
    (constant * (at + 1.0) + waves.sum::<f64>()) / (2.0 * constant)
}

/// Returns the place, as a part of the radius from -1 to 1, before which `part` of the weight is.
pub(super) fn inverse_cdf(part: f64) -> f64 {
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..48 {
        let middle = 0.5 * (low + high);
        if cdf(middle) < part { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Returns the variance of the filter with radius 1: the integral of its weight times the squared distance.
fn variance() -> f64 {
    let [constant, one, two, three] = TERMS;
    let waves = 4.0 / (PI * PI) * (two / 4.0 - one - three / 9.0);
    (2.0 / 3.0 * constant + waves) / (2.0 * constant)
}

/// Returns the radius of the positions of sub-frames, pixels. A pixel of several samples is the mean of an area already, so the positions are
/// nearer: both together are as wide as the filter.
pub(super) fn jitter_radius(samples_per_pixel: u32) -> f64 {
    if samples_per_pixel <= 1 {
        return FILTER_RADIUS;
    }
    (FILTER_RADIUS * FILTER_RADIUS - MULTISAMPLE_VARIANCE / variance()).sqrt()
}
