//! Slerp of eight rotations with one mix, without a sine.
//!
//! The weights of slerp are `sin(t θ) / sin θ` for the second rotation and the same with `1 - t` for the first. As a
//! series in `d = cos θ - 1` (D. Eberly, "A Fast and Accurate Algorithm for Computing SLERP", 2011):
//!
//! ```text
//! sin(t θ) / sin θ = t (1 + b₁ d (1 + b₂ d (1 + b₃ d …)))      bᵢ = (t² - i²) / (i (2 i + 1))
//! ```
//!
//! # How many terms
//!
//! Keys are near each other: at thirty per second, a bone that turns once in half a second turns by 24° from one to the
//! next. For `-0.03 ≤ d ≤ 0` (rotations up to 28° apart) two terms are enough:
//!
//! ```text
//! weight = t + c₁ d + c₂ d²        c₁ = t b₁        c₂ = t b₁ b₂
//! ```
//!
//! What is left out is `t b₁ b₂ b₃ d³ (1 + b₄ d (1 + …))`. On 0 ≤ t ≤ 1 `|t b₁ b₂ b₃|` is at most 0.0197, and
//! `|bᵢ d|` for i ≥ 4 at most 0.03 / 2, so it is below `0.0197 * 0.03³ * 1.02 < 6e-7`. The factors depend on the mix
//! alone and are computed once per pose; then each weight costs two multiply-adds for eight rotations at once. If any
//! of eight pairs of rotations are farther apart, all eight use the longer series of [`SOME`] or [`MANY`] terms.

use crate::fast::simd::{Arithmetic, Float8, RowPair, Simd};

/// Smallest `d` for which two terms are enough.
const FAR: f32 = -0.03;
/// Number of terms for `d` down to [`FARTHER`]: rotations up to 91° apart, with an error below 2e-7.
const SOME: usize = 8;
const FARTHER: f32 = -0.3;
/// Number of terms for any two rotations: up to 180° apart, with an error of 1e-6.
const MANY: usize = 20;

/// The factors for one mix.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slerp {
    /// `t`, `c₁` and `c₂` of the first rotation and of the second.
    from: [f32; 3],
    to: [f32; 3],
}

/// Returns `bᵢ` for `t`, where i is `index + 1`.
#[inline(always)]
fn factor(t: f32, index: usize) -> f32 {
    let i = (index + 1) as f32;
    (t * t - i * i) / (i * (2.0 * i + 1.0))
}

impl Slerp {
    /// Computes the factors for a mix of 0..=1.
    #[inline(always)]
    pub(super) fn at(mix: f32) -> Self {
        Self { from: factors(1.0 - mix), to: factors(mix) }
    }

    /// Interpolates from `a` to `b` the short way; both of unit length.
    #[inline(always)]
    pub(super) fn mix<S: Simd>(&self, a: [S::F8; 4], b: [S::F8; 4]) -> [S::F8; 4] {
        let d = cosine_less_one(a, b);
        weighted(a, b, self.weights::<S>(d))
    }

    /// As [`Self::mix`], for two times eight rotations. Gives the same bits.
    #[inline(always)]
    pub(super) fn mix_two<S: Simd>(&self, a: [S::Pair; 4], b: [S::Pair; 4]) -> [S::Pair; 4] {
        let d = cosine_less_one(a, b);
        let weights = if d.any_less(S::Pair::all(FAR)) {
            let [first, second] = d.rows();
            let ([a, b], [c, d]) = (self.weights::<S>(first), self.weights::<S>(second));
            [S::Pair::of([a, c]), S::Pair::of([b, d])]
        } else {
            [near(&self.from, d), near(&self.to, d)]
        };
        weighted(a, b, weights)
    }

    /// Returns the weights of the first rotation and of the second.
    #[inline(always)]
    fn weights<S: Simd>(&self, d: S::F8) -> [S::F8; 2] {
        // Also true where the dot product is negative, so that one rotation has to be negated.
        if d.any_less(S::F8::splat(FAR)) {
            self.far::<S>(d)
        } else {
            [near(&self.from, d), near(&self.to, d)]
        }
    }

    /// Returns the weights for any `cosine_less_one`.
    #[inline(always)]
    fn far<S: Simd>(&self, cosine_less_one: S::F8) -> [S::F8; 2] {
        let one = S::F8::splat(1.0);
        let cosine = cosine_less_one + one;
        // Rounding, and invalid bytes, can make the cosine more than 1.
        let d = cosine.abs().min(one) - one;
        let terms = if d.less(S::F8::splat(FARTHER)).any() { MANY } else { SOME };
        let (mut from, mut to) = (one, one);
        for index in (0..terms).rev() {
            from = (from * d).mul_add(S::F8::splat(factor(self.from[0], index)), one);
            to = (to * d).mul_add(S::F8::splat(factor(self.to[0], index)), one);
        }
        [from * S::F8::splat(self.from[0]), (to * S::F8::splat(self.to[0])).flipped_by(cosine.sign())]
    }
}

#[inline(always)]
fn factors(t: f32) -> [f32; 3] {
    let first = t * ((t * t - 1.0) * (1.0 / 3.0));
    [t, first, first * ((t * t - 4.0) * (1.0 / 10.0))]
}

/// Returns the dot products, less 1.
#[inline(always)]
fn cosine_less_one<A: Arithmetic>(a: [A; 4], b: [A; 4]) -> A {
    let minus = A::all(-1.0);
    a[3].times_plus(b[3], a[2].times_plus(b[2], a[1].times_plus(b[1], a[0].times_plus(b[0], minus))))
}

/// Returns the weight for an angle that is not far.
#[inline(always)]
fn near<A: Arithmetic>(factors: &[f32; 3], d: A) -> A {
    let [t, first, second] = [A::all(factors[0]), A::all(factors[1]), A::all(factors[2])];
    d.times_plus(d.times_plus(second, first), t)
}

/// Returns `a * from + b * to`.
#[inline(always)]
fn weighted<A: Arithmetic>(a: [A; 4], b: [A; 4], [from, to]: [A; 2]) -> [A; 4] {
    [
        b[0].times_plus(to, a[0] * from),
        b[1].times_plus(to, a[1] * from),
        b[2].times_plus(to, a[2] * from),
        b[3].times_plus(to, a[3] * from),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns `sin(t θ) / sin θ` in double precision.
    fn weight(t: f64, d: f64) -> f64 {
        let angle = (1.0 + d).acos();
        if angle < 1e-6 { t } else { (t * angle).sin() / angle.sin() }
    }

    #[test]
    fn two_terms_of_the_series_are_within_their_error_bound_up_to_their_largest_angle() {
        let mut largest = 0.0_f64;
        for step in 0..=1000 {
            let t = step as f32 / 1000.0;
            let [t, first, second] = factors(t).map(f64::from);
            for step in 0..=100 {
                let d = f64::from(FAR) * f64::from(step) / 100.0;
                largest = largest.max((t + d * (first + d * second) - weight(t, d)).abs());
            }
        }
        // The bound from the top of this file, and the rounding of three factors.
        assert!((3e-7..6e-7 + 1e-7).contains(&largest), "{largest}");
    }
}
