//! Slerp of eight rotations at once, without a sine: linear interpolation with a corrected fraction.
//!
//! The straight line from `a` to `b`, normalized, follows the same arc as slerp; only its speed differs. With θ the
//! angle between `a` and `b` as vectors, `s = 2 mix - 1` and
//!
//! ```text
//! s' = tan(s θ/2) / tan(θ/2)
//! ```
//!
//! the straight line at `mix' = (s' + 1) / 2` is slerp at `mix`. In powers of `x = sin²(θ/2) = (1 - a·b) / 2`:
//!
//! ```text
//! s' = s (1 + (s² - 1) (x/3 + 2/15 (1 + s²) x² + …))
//! ```
//!
//! The two terms written are exact to 1e-7 up to θ = 17.8° ([`WIDEST`]), which are 35.6° of rotation between two keys;
//! wider steps get keys in between when the data is built ([`steps`]). The formula follows from the series of the
//! tangent and of the arc sine.

use super::simd::{Float8, Simd};
use glam::Quat;

/// The largest x for which the series is used.
const WIDEST: f32 = 0.024;

/// The fraction between two keys, prepared for any number of rotations.
#[derive(Clone, Copy)]
pub(super) struct FastSlerp<S: Simd> {
    mix: S::F8,
    rest: S::F8,
    /// s (s² - 1) / 2
    pace: S::F8,
    /// 2/15 (1 + s²)
    second: S::F8,
}

impl<S: Simd> FastSlerp<S> {
    /// Prepares the fraction `mix` from the first key to the second, 0..=1.
    #[inline(always)]
    pub(super) fn new(mix: f32) -> Self {
        let s = 2.0 * mix - 1.0;
        Self {
            mix: S::F8::splat(mix),
            rest: S::F8::splat(1.0 - mix),
            pace: S::F8::splat(0.5 * s * (s * s - 1.0)),
            second: S::F8::splat(2.0 / 15.0 * (1.0 + s * s)),
        }
    }

    /// Interpolates linearly: `(1 - mix) a + mix b`.
    #[inline(always)]
    pub(super) fn straight(&self, a: S::F8, b: S::F8) -> S::F8 {
        b.mul_add(self.mix, a * self.rest)
    }

    /// Interpolates unit quaternions in one hemisphere by slerp, at most as far apart as [`steps`] allows; unit length.
    #[inline(always)]
    pub(super) fn turn(&self, a: [S::F8; 4], b: [S::F8; 4]) -> [S::F8; 4] {
        let cosine = dot::<S>(a, b);
        let (half, third, one) = (S::F8::splat(0.5), S::F8::splat(1.0 / 3.0), S::F8::splat(1.0));
        let x = cosine.neg_mul_add(half, half);
        let mix = (x * x.mul_add(self.second, third)).mul_add(self.pace, self.mix);
        let rest = one - mix;
        let (first, second) = (b[0].mul_add(mix, a[0] * rest), b[1].mul_add(mix, a[1] * rest));
        let (third, fourth) = (b[2].mul_add(mix, a[2] * rest), b[3].mul_add(mix, a[3] * rest));
        unit::<S>([first, second, third, fourth])
    }
}

/// Returns the dot products of eight pairs.
#[inline(always)]
pub(super) fn dot<S: Simd>(a: [S::F8; 4], b: [S::F8; 4]) -> S::F8 {
    // Two sums that do not wait for each other.
    a[1].mul_add(b[1], a[0] * b[0]) + a[3].mul_add(b[3], a[2] * b[2])
}

/// Normalizes rotations whose length is not zero.
#[inline(always)]
pub(super) fn unit<S: Simd>(rotation: [S::F8; 4]) -> [S::F8; 4] {
    let shrink = S::F8::splat(1.0) / dot::<S>(rotation, rotation).sqrt();
    [rotation[0] * shrink, rotation[1] * shrink, rotation[2] * shrink, rotation[3] * shrink]
}

/// Returns the number of equal steps into which the rotation from `a` to `b` has to be cut for [`FastSlerp::turn`]; 1
/// for nearly all data, at most 6.
pub(super) fn steps(a: Quat, b: Quat) -> usize {
    let x = |cosine: f32| 0.5 - 0.5 * cosine;
    let cosine = a.dot(b).abs();
    if x(cosine) <= WIDEST {
        return 1;
    }
    let half_angle = |x: f32| libm::asinf(x.sqrt());
    (half_angle(x(cosine)) / half_angle(WIDEST)).ceil().clamp(1.0, 6.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fast::simd::{Kernel, SimdLevel};
    use crate::sample::mix::slerp;

    struct Turn(Quat, Quat, f32);

    impl Kernel for Turn {
        type Output = Quat;

        #[inline(always)]
        fn run<S: Simd>(self) -> Quat {
            let eight = |rotation: Quat| S::F8::load_four(&rotation.to_array().map(|part| [part; 8]));
            let mut lanes = [[0.0; 8]; 4];
            S::F8::store_four(FastSlerp::<S>::new(self.2).turn(eight(self.0), eight(self.1)), &mut lanes);
            Quat::from_array(lanes.map(|part| part[3]))
        }
    }

    #[test]
    fn the_series_agrees_with_slerp_for_all_rotations_within_one_step() {
        let a = Quat::from_xyzw(0.3, -0.2, 0.5, 0.7).normalize();
        for degrees in [0.0, 0.001, 0.1, 1.0, 5.0, 12.0, 20.0, 30.0, 35.5_f32] {
            let b =
                Quat::from_axis_angle(glam::Vec3::new(1.0, 2.0, -0.5).normalize(), degrees.to_radians()) * a;
            assert_eq!(steps(a, b), 1, "{degrees}");
            for mix in 0..=20 {
                let mix = mix as f32 / 20.0;
                for level in SimdLevel::all() {
                    let off = (level.run(Turn(a, b, mix)) - slerp(a, b, mix)).length();
                    assert!(off < 4e-7, "{} {degrees}° {mix}: {off}", level.name());
                }
            }
        }
    }

    #[test]
    fn a_wide_rotation_is_split_into_steps_that_are_not_wide() {
        let a = Quat::from_rotation_y(0.4);
        for degrees in 1..=180 {
            let b = Quat::from_rotation_y(0.4 + (degrees as f32).to_radians());
            let count = steps(a, b);
            let part = slerp(a, b, 1.0 / count as f32);
            assert!(0.5 - 0.5 * a.dot(part) <= WIDEST * 1.001, "{degrees} {count}");
        }
    }
}
