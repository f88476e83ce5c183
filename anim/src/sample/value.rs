//! Types that a channel can animate: vectors, rotations, and single numbers such as weights.

use super::mix;
use glam::{Quat, Vec3};

/// A value that keys contain and that can be interpolated.
pub trait Value: Copy {
    /// Zero, used for a tangent that is not finite.
    const ZERO: Self;

    /// Interpolates linearly between two keys, 0 ≤ `mix` ≤ 1.
    fn linear(a: Self, b: Self, mix: f32) -> Self;

    /// Interpolates on the Hermite spline between two keys `span` seconds apart; a rotation is normalized, and is `a`
    /// where the spline passes through zero.
    fn cubic(a: Self, out_tangent: Self, in_tangent: Self, b: Self, span: f32, mix: f32) -> Self;

    /// Returns whether every component is finite.
    fn is_finite(self) -> bool;

    /// Returns the value bit for bit where it is usable; otherwise the nearest usable one, or `fallback`.
    fn healed(self, fallback: Self) -> Self;
}

/// Numbers and vectors: interpolated component by component; any finite one is usable, zero scale included.
macro_rules! by_component {
    ($type:ty, $zero:expr) => {
        impl Value for $type {
            const ZERO: Self = $zero;

            fn linear(a: Self, b: Self, mix: f32) -> Self {
                mix::lerp(a, b, mix)
            }

            fn cubic(a: Self, out_tangent: Self, in_tangent: Self, b: Self, span: f32, mix: f32) -> Self {
                mix::hermite(a, out_tangent, in_tangent, b, span, mix)
            }

            fn is_finite(self) -> bool {
                <$type>::is_finite(self)
            }

            fn healed(self, fallback: Self) -> Self {
                if <$type>::is_finite(self) { self } else { fallback }
            }
        }
    };
}

by_component!(f32, 0.0);
by_component!(Vec3, Vec3::ZERO);

/// Tolerance of the squared length of a unit quaternion with rounding, which is not changed.
const UNIT_TOLERANCE: f32 = 2e-4;

impl Value for Quat {
    const ZERO: Self = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);

    fn linear(a: Self, b: Self, mix: f32) -> Self {
        mix::slerp(a, b, mix)
    }

    fn cubic(a: Self, out_tangent: Self, in_tangent: Self, b: Self, span: f32, mix: f32) -> Self {
        unit(mix::hermite(a, out_tangent, in_tangent, b, span, mix)).unwrap_or(a)
    }

    fn is_finite(self) -> bool {
        Quat::is_finite(self)
    }

    /// A quaternion of another length is normalized; one without length is the identity; one that is not finite becomes
    /// `fallback`.
    fn healed(self, fallback: Self) -> Self {
        if !self.is_finite() {
            return fallback;
        }
        if (self.length_squared() - 1.0).abs() <= UNIT_TOLERANCE {
            return self;
        }
        unit(self).unwrap_or(Quat::IDENTITY)
    }
}

/// Returns `rotation` divided by its length; `None` when it has none or is not finite.
///
/// The square of a very large or small component leaves the range of f32, so those are first scaled to about 1.
fn unit(rotation: Quat) -> Option<Quat> {
    let length_squared = rotation.length_squared();
    if (1e-20..=1e20).contains(&length_squared) {
        return Some(rotation.normalize());
    }
    let largest = rotation.to_array().into_iter().map(f32::abs).fold(0.0, f32::max);
    let scaled = rotation / largest;
    (largest > 0.0 && scaled.is_finite()).then(|| scaled.normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_quaternion_is_unchanged_and_a_longer_or_shorter_one_is_normalized() {
        let rotation = Quat::from_xyzw(0.1, 0.7, -0.1, 0.7).normalize();
        assert_eq!(rotation.healed(Quat::IDENTITY).to_array(), rotation.to_array());
        for factor in [1e-30, 1e-10, 0.5, 2.0, 1e10, 1e30, 1e38] {
            let healed = (rotation * factor).healed(Quat::IDENTITY);
            assert!((healed - rotation).length() < 1e-6, "{factor} {healed}");
        }
    }

    #[test]
    fn a_quaternion_of_length_zero_becomes_the_identity_and_one_that_is_not_finite_the_fallback() {
        let fallback = Quat::from_xyzw(0.0, 1.0, 0.0, 0.0);
        assert_eq!(Quat::ZERO.healed(fallback), Quat::IDENTITY);
        assert_eq!(Quat::from_xyzw(0.0, f32::NAN, 0.0, 1.0).healed(fallback), fallback);
        assert_eq!(Quat::from_xyzw(f32::INFINITY, 0.0, 0.0, 1.0).healed(fallback), fallback);
        assert_eq!(Quat::cubic(fallback, Quat::ZERO, Quat::ZERO, -fallback, 1.0, 0.5), fallback);
        assert!(Quat::from_xyzw(1e-45, 0.0, 0.0, 0.0).healed(fallback).is_normalized());
    }
}
