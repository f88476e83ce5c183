//! Additive animation: the difference between a pose and a reference, added to any pose, eight bones at once.
//!
//! ```text
//! difference(p, r):  translation p - r      rotation p * r⁻¹      scale p / r
//! add(b, d, w):      translation b + w * d  rotation d^w * b      scale b * (1 + w * (d - 1))
//! ```
//!
//! Rotations are differences in the parent's space, applied from the left. `d^w` turns about `d`'s axis by `w` times
//! its angle, the short way; it is `d` itself at weight 1, and for weights between, slerp from the identity:
//!
//! ```text
//! d^w = (xyz * sin(w h) / sin h, cos(w h))      h: half the angle, 0..=π/2
//! ```

use super::mask::{LaneMask, usable};
use super::pose::PoseBlock;
use super::simd::{Float8, Kernel, Simd, SimdLevel};

/// Computes the difference of `pose` from `reference`, for the blocks that all three have.
///
/// Added to `reference` with weight 1 it gives `pose` again. Where the reference scales by 0 the factor is 1. Allocates
/// nothing.
pub fn difference(level: SimdLevel, pose: &[PoseBlock], reference: &[PoseBlock], out: &mut [PoseBlock]) {
    level.run(Difference { pose, reference, out });
}

/// Adds `difference` to `base`, each bone scaled by `weight` × `mask`, for the blocks that all three have.
///
/// Weight 0 (also a negative one and NaN) gives the base, 1 adds the full difference; more is clamped to 1. Allocates
/// nothing.
pub fn add(
    level: SimdLevel,
    base: &[PoseBlock],
    difference: &[PoseBlock],
    weight: f32,
    mask: Option<&LaneMask>,
    out: &mut [PoseBlock],
) {
    level.run(AddTo { base, difference, weight: usable(weight).min(1.0), mask, out });
}

struct Difference<'a> {
    pose: &'a [PoseBlock],
    reference: &'a [PoseBlock],
    out: &'a mut [PoseBlock],
}

impl Kernel for Difference<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let (zero, one) = (S::F8::splat(0.0), S::F8::splat(1.0));
        for ((out, pose), from) in self.out.iter_mut().zip(self.pose).zip(self.reference) {
            let [x, y, z, w] = S::F8::load_four(&from.rotation);
            let turn = product::<S>(S::F8::load_four(&pose.rotation), [-x, -y, -z, w]);
            S::F8::store_four(turn, &mut out.rotation);
            let ([a, b, c], [x, y, z]) =
                (S::F8::load_three(&pose.translation), S::F8::load_three(&from.translation));
            S::F8::store_three([a - x, b - y, c - z], &mut out.translation);
            let ([a, b, c], [x, y, z]) = (S::F8::load_three(&pose.scale), S::F8::load_three(&from.scale));
            let factors = [
                quotient::<S>(a, x, zero, one),
                quotient::<S>(b, y, zero, one),
                quotient::<S>(c, z, zero, one),
            ];
            S::F8::store_three(factors, &mut out.scale);
        }
    }
}

/// Returns `a / b`; 1 where that is not finite.
#[inline(always)]
fn quotient<S: Simd>(a: S::F8, b: S::F8, zero: S::F8, one: S::F8) -> S::F8 {
    let quotient = a / b;
    // The product is zero, unless the quotient is not finite.
    let finite = (quotient * zero).abs().less(one);
    finite.select(quotient, one)
}

struct AddTo<'a> {
    base: &'a [PoseBlock],
    difference: &'a [PoseBlock],
    weight: f32,
    mask: Option<&'a LaneMask>,
    out: &'a mut [PoseBlock],
}

impl Kernel for AddTo<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { base, difference, weight, mask, out } = self;
        let (one, all) = (S::F8::splat(1.0), S::F8::splat(weight));
        let is_whole = weight == 1.0 && mask.is_none();
        for (block, ((out, base), more)) in out.iter_mut().zip(base).zip(difference).enumerate() {
            let weight = match mask {
                Some(mask) => S::F8::load(mask.block(block)) * all,
                None => all,
            };
            let mut turn = S::F8::load_four(&more.rotation);
            if !is_whole {
                turn = power::<S>(turn, weight);
            }
            let turned = product::<S>(turn, S::F8::load_four(&base.rotation));
            S::F8::store_four(super::slerp::unit::<S>(turned), &mut out.rotation);
            let ([a, b, c], [x, y, z]) =
                (S::F8::load_three(&base.translation), S::F8::load_three(&more.translation));
            let moved = [x.mul_add(weight, a), y.mul_add(weight, b), z.mul_add(weight, c)];
            S::F8::store_three(moved, &mut out.translation);
            let ([a, b, c], [x, y, z]) = (S::F8::load_three(&base.scale), S::F8::load_three(&more.scale));
            let grown = [
                a * (x - one).mul_add(weight, one),
                b * (y - one).mul_add(weight, one),
                c * (z - one).mul_add(weight, one),
            ];
            S::F8::store_three(grown, &mut out.scale);
        }
    }
}

/// Returns the product of quaternions `a * b`: first `b`, then `a`.
#[inline(always)]
fn product<S: Simd>([ax, ay, az, aw]: [S::F8; 4], [bx, by, bz, bw]: [S::F8; 4]) -> [S::F8; 4] {
    let x = az.neg_mul_add(by, ay.mul_add(bz, ax.mul_add(bw, aw * bx)));
    let y = ax.neg_mul_add(bz, az.mul_add(bx, ay.mul_add(bw, aw * by)));
    let z = ay.neg_mul_add(bx, ax.mul_add(by, az.mul_add(bw, aw * bz)));
    let w = az.neg_mul_add(bz, ay.neg_mul_add(by, ax.neg_mul_add(bx, aw * bw)));
    [x, y, z, w]
}

/// Returns the rotation about the same axis by `weight` (0..=1) times the angle of `turn`, the short way.
///
/// Half the angle is `h = atan2(|xyz|, w)`, by the arc tangent's polynomial on 0..=tan(π/8) after two halvings; sine
/// and cosine of `w h` by their polynomials on 0..=π/2. Within 3e-7.
#[inline(always)]
fn power<S: Simd>([x, y, z, w]: [S::F8; 4], weight: S::F8) -> [S::F8; 4] {
    // Moves the rotation to the hemisphere of the identity.
    let sign = w.sign();
    let (x, y, z, w) = (x.flipped_by(sign), y.flipped_by(sign), z.flipped_by(sign), w.flipped_by(sign));
    let square = x.mul_add(x, y.mul_add(y, z * z));
    let length = square.sqrt();
    // tan(h / 2) = sin h / (1 + cos h), and once more for a quarter: at most tan(π/8).
    let one = S::F8::splat(1.0);
    let size = w.mul_add(w, square).sqrt();
    let half = length / (size + w);
    let quarter = half / (one + half.mul_add(half, one).sqrt());
    let angle = arc_tangent::<S>(quarter) * S::F8::splat(4.0) * weight;
    let angle2 = angle * angle;
    let sine = angle * sine_over::<S>(angle2);
    let cosine = cosine::<S>(angle2);
    // Without an axis there is no rotation either.
    let along = sine / length.max(S::F8::splat(1e-30));
    [x * along, y * along, z * along, cosine]
}

/// Returns atan(t) for 0 ≤ t ≤ tan(π/8), by Taylor's series up to the precision of f32.
#[inline(always)]
fn arc_tangent<S: Simd>(t: S::F8) -> S::F8 {
    let t2 = t * t;
    let mut sum = S::F8::splat(-1.0 / 15.0);
    for term in [1.0 / 13.0, -1.0 / 11.0, 1.0 / 9.0, -1.0 / 7.0, 1.0 / 5.0, -1.0 / 3.0, 1.0_f32] {
        sum = sum.mul_add(t2, S::F8::splat(term));
    }
    sum * t
}

/// Returns sin(a) / a for a² given, 0 ≤ a ≤ π/2.
#[inline(always)]
fn sine_over<S: Simd>(square: S::F8) -> S::F8 {
    let mut sum = S::F8::splat(-1.0 / 39_916_800.0);
    for term in [1.0 / 362_880.0, -1.0 / 5_040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0_f32] {
        sum = sum.mul_add(square, S::F8::splat(term));
    }
    sum
}

/// Returns cos(a) for a² given, 0 ≤ a ≤ π/2.
#[inline(always)]
fn cosine<S: Simd>(square: S::F8) -> S::F8 {
    let mut sum = S::F8::splat(1.0 / 479_001_600.0);
    for term in [-1.0 / 3_628_800.0, 1.0 / 40_320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5, 1.0_f32] {
        sum = sum.mul_add(square, S::F8::splat(term));
    }
    sum
}
