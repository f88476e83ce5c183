//! The points by which a sub-frame differs from the others: they cover pixel, lens, light and time evenly, for any number of sub-frames.
//!
//! A low-discrepancy set in place of random numbers, because 16 sub-frames have to look like many:
//!
//! * pixel: the set of Hammersley, `(i / N, radical inverse of i in base 2)` (J. M. Hammersley, 1960; T.-T. Wong, W.-S. Luk, P.-A. Heng,
//!   "Sampling with Hammersley and Halton Points", 1997), mapped to the pixel filter;
//! * lens and light: spirals as of H. Vogel, `radius √(i / N), angle i · golden angle` ("A better way to construct the sunflower head",
//!   1979), that of the light with another angle;
//! * time and threshold: `i / N`.
//!
//! So that these are independent of each other, each takes the sub-frames in an order of its own: `i · step mod N`, a lattice of rank 1
//! with steps near irrational parts of N (M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).

use super::pixel_filter::inverse_cdf;
use glam::Vec2;
use std::f64::consts::TAU;

/// A sub-frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SubFrame {
    /// Distance by which the image is moved, pixels, to the right and down.
    pub pixel: Vec2,
    /// Point of the lens, within a circle of radius 1.
    pub lens: Vec2,
    /// Part of the time that the shutter is open, from 0 to 1.
    pub shutter: f64,
    /// Point of each light that is no point, which is the sun, within a circle of radius 1: shadows add up to soft ones.
    pub light: Vec2,
    /// Alpha up to which a mask is not drawn, between 0 and 1: the sub-frames add up to its alpha.
    pub threshold: f32,
}

/// Steps of the orders in which pixel, lens, light and threshold take the sub-frames, as parts of their number: powers of the reciprocals of
/// the golden number and of the root of x⁴ = x + 1. Of such numbers these leave the least correlation for 8 to 128 sub-frames.
const STEPS: [f64; 4] = [0.618_033_988_75, 0.236_067_977_5, 0.549_700_477_9, 0.819_172_513_4];

/// Parts of a full turn between two points of the spirals of the lens and of the light.
const TURNS: [f64; 2] = [0.381_966_011_25, 0.236_067_977_5];

impl SubFrame {
    /// Returns sub-frame `index` of `count`; its position in the pixel follows the pixel filter of this radius. A single one is in the middle
    /// of everything.
    pub fn new(index: u32, count: u32, radius: f64) -> Self {
        if count <= 1 {
            let middle = Vec2::ZERO;
            return Self { pixel: middle, lens: middle, shutter: 0.5, light: middle, threshold: 0.5 };
        }
        let [pixel, lens, light, threshold] = STEPS.map(|part| index_in_order(index, count, part));
        let along = |number: f64| (inverse_cdf(number) * radius) as f32;
        let half = 0.5 / f64::from(count);
        Self {
            pixel: Vec2::new(along(middle_of(pixel, count)), along((radical_inverse(pixel) + half).fract())),
            lens: spiral(lens, count, TURNS[0]),
            shutter: middle_of(index, count),
            light: spiral(light, count, TURNS[1]),
            threshold: middle_of(threshold, count) as f32,
        }
    }
}

/// Returns the middle of part `index` of `count` equal parts of 0..1.
fn middle_of(index: u32, count: u32) -> f64 {
    (f64::from(index) + 0.5) / f64::from(count)
}

/// Returns the binary digits of `index` in reverse order, after the point.
fn radical_inverse(index: u32) -> f64 {
    f64::from(index.reverse_bits()) / (f64::from(u32::MAX) + 1.0)
}

/// Returns point `index` of `count` of a spiral in which neighbors are `turn` apart.
fn spiral(index: u32, count: u32, turn: f64) -> Vec2 {
    let radius = middle_of(index, count).sqrt();
    let (sin, cos) = (TAU * (turn * f64::from(index)).fract()).sin_cos();
    Vec2::new((radius * cos) as f32, (radius * sin) as f32)
}

/// Returns the index of a sub-frame in another order, whose step is about `part` of their number.
fn index_in_order(index: u32, count: u32, part: f64) -> u32 {
    let wanted = (f64::from(count) * part).round() as u32;
    // Every index occurs once if step and number have no common divisor.
    let mut near = (0..count).flat_map(|away| [wanted.saturating_sub(away), wanted + away]);
    let step = near.find(|step| greatest_common_divisor(*step, count) == 1).unwrap_or(1);
    (u64::from(index) * u64::from(step) % u64::from(count)) as u32
}

fn greatest_common_divisor(mut a: u32, mut b: u32) -> u32 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}
