//! Slerp of eight rotations with one mix, without a sine.
//!
//! The weights of slerp are `sin(t θ) / sin θ` for the second rotation and the same with `1 - t` for the first. As a
//! series in `d = cos θ - 1` (D. Eberly, "A Fast and Accurate Algorithm for Computing SLERP", 2011):
//!
//! ```text
//! sin(t θ) / sin θ = t (1 + b₁ d (1 + b₂ d (1 + b₃ d …)))      bᵢ = (t² - i²) / (i (2 i + 1))
//! ```
//!
//! The `bᵢ` depend on the mix alone, so they are computed once a pose, and eight rotations cost two multiplications and
//! additions a term. Terms shrink like `(-d / 2)ⁱ`: few are enough for keys near each other, which most are.

use crate::fast::simd::{Float8, Simd};

/// Enough for rotations up to 37° apart: the first term left out is below 4e-8.
const FEW: usize = 5;
/// Enough for any two rotations: up to 180° apart, 1e-6.
const MANY: usize = 20;
/// Below this `d` few terms are not enough.
const FAR: f32 = -0.05;

/// The factors of one mix.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slerp {
    mix: f32,
    /// Of the weight of the first and of the second rotation.
    factors: [[f32; 2]; FEW],
}

/// `bᵢ` for `t`, without the sign of the series.
#[inline(always)]
fn factor(t: f32, index: usize) -> f32 {
    let i = (index + 1) as f32;
    (t * t - i * i) / (i * (2.0 * i + 1.0))
}

impl Slerp {
    /// 0 ≤ `mix` ≤ 1.
    #[inline(always)]
    pub(super) fn at(mix: f32) -> Self {
        let mut factors = [[0.0; 2]; FEW];
        for (index, factors) in factors.iter_mut().enumerate() {
            *factors = [factor(1.0 - mix, index), factor(mix, index)];
        }
        Self { mix, factors }
    }

    /// From `a` to `b` the short way; both of unit length.
    #[inline(always)]
    pub(super) fn mix<S: Simd>(&self, a: [S::F8; 4], b: [S::F8; 4]) -> [S::F8; 4] {
        let (one, far) = (S::F8::splat(1.0), S::F8::splat(FAR));
        let cosine = a[3].mul_add(b[3], a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0])));
        let sign = cosine.sign();
        // Rounding, and bytes that nobody wrote in earnest, can make it more than 1.
        let d = cosine.abs().min(one) - one;
        let (from, to) = if d.less(far).any() { many::<S>(self.mix, d) } else { self.few::<S>(d) };
        let from = from * S::F8::splat(1.0 - self.mix);
        let to = (to * S::F8::splat(self.mix)).flipped_by(sign);
        [
            b[0].mul_add(to, a[0] * from),
            b[1].mul_add(to, a[1] * from),
            b[2].mul_add(to, a[2] * from),
            b[3].mul_add(to, a[3] * from),
        ]
    }

    #[inline(always)]
    fn few<S: Simd>(&self, d: S::F8) -> (S::F8, S::F8) {
        let one = S::F8::splat(1.0);
        let (mut from, mut to) = (one, one);
        for [first, second] in self.factors.iter().rev() {
            from = (from * d).mul_add(S::F8::splat(*first), one);
            to = (to * d).mul_add(S::F8::splat(*second), one);
        }
        (from, to)
    }
}

#[inline(always)]
fn many<S: Simd>(mix: f32, d: S::F8) -> (S::F8, S::F8) {
    let one = S::F8::splat(1.0);
    let (mut from, mut to) = (one, one);
    for index in (0..MANY).rev() {
        from = (from * d).mul_add(S::F8::splat(factor(1.0 - mix, index)), one);
        to = (to * d).mul_add(S::F8::splat(factor(mix, index)), one);
    }
    (from, to)
}
