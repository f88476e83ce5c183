//! Interpolation between two keys (thesis §2.1.5.2: "0.5 * K1 + 0.5 * K2"; glTF 2.0 appendix C for the others).
//!
//! `mix` is always 0..1: 0 the first key, 1 the second.
//!
//! Sine and arc tangent are those of `libm`, so that a pose is the same to the bit on Linux and Windows, whose C libraries round
//! some of them differently in the last place.

use glam::Quat;
use std::ops::{Add, Mul, Sub};

/// Interpolates linearly: `(1 - mix) * a + mix * b`, for translations, scales and single numbers.
pub fn lerp<T: Copy + Add<Output = T> + Mul<f32, Output = T>>(a: T, b: T, mix: f32) -> T {
    a * (1.0 - mix) + b * mix
}

/// Cosine above which two rotations are so close (less than 0.06° in quaternion space) that the division by
/// `sin(angle)` would lose more than linear interpolation does.
const NEARLY_PARALLEL: f32 = 0.999_999_5;

/// Interpolates spherically: turns from `a` to `b` about one axis at constant speed, the short way round.
///
/// ```text
/// angle = the angle between a and b as four-dimensional vectors
/// (sin((1 - mix) * angle) * a + sin(mix * angle) * b) / sin(angle)
/// ```
///
/// * `b` and `-b` are the same rotation; the one nearer to `a` is used, so the path is never longer than 180°.
/// * Rotations exactly 180° apart have two paths of the same length: the one towards `b` as it is stored is used, so
///   the axis is that of `b * a⁻¹`.
/// * Nearly parallel rotations: linear interpolation, see [`nlerp`].
///
/// Both rotations must have unit length; the result is normalized.
pub fn slerp(a: Quat, b: Quat, mix: f32) -> Quat {
    let cosine = a.dot(b);
    let b = if cosine < 0.0 { -b } else { b };
    if cosine.abs() > NEARLY_PARALLEL {
        return nlerp(a, b, mix);
    }
    // The arc cosine is inexact for small angles; the two diagonals of the rhombus of a and b are not.
    let angle = 2.0 * libm::atan2f((a - b).length(), (a + b).length());
    let from = libm::sinf((1.0 - mix) * angle);
    let to = libm::sinf(mix * angle);
    ((a * from + b * to) / libm::sinf(angle)).normalize()
}

/// Interpolates two rotations of one hemisphere linearly, and normalizes the result.
pub fn nlerp(a: Quat, b: Quat, mix: f32) -> Quat {
    lerp(a, b, mix).normalize()
}

/// Evaluates the cubic Hermite spline from key `a` to key `b`.
///
/// ```text
/// ( 2 m³ - 3 m² + 1) * a  +  span * (m³ - 2 m² + m) * out_tangent
/// (-2 m³ + 3 m²    ) * b  +  span * (m³ -   m²    ) * in_tangent
/// ```
///
/// `out_tangent` belongs to `a`, `in_tangent` to `b`, both in units per second; `span` is the seconds between the keys.
/// A rotation has to be normalized afterwards.
pub fn hermite<T>(a: T, out_tangent: T, in_tangent: T, b: T, span: f32, mix: f32) -> T
where
    T: Copy + Add<Output = T> + Mul<f32, Output = T>,
{
    let (mix2, mix3) = (mix * mix, mix * mix * mix);
    a * (2.0 * mix3 - 3.0 * mix2 + 1.0)
        + out_tangent * (span * (mix3 - 2.0 * mix2 + mix))
        + b * (-2.0 * mix3 + 3.0 * mix2)
        + in_tangent * (span * (mix3 - mix2))
}

/// Returns the derivative of [`hermite`] in units per second.
///
/// ```text
/// (b - a) * 6 m (1 - m) / span  +  (3 m² - 4 m + 1) * out_tangent  +  (3 m² - 2 m) * in_tangent
/// ```
///
/// A key inserted there with this as both tangents leaves the curve unchanged.
pub fn hermite_slope<T>(a: T, out_tangent: T, in_tangent: T, b: T, span: f32, mix: f32) -> T
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f32, Output = T>,
{
    (b - a) * (6.0 * mix * (1.0 - mix) / span)
        + out_tangent * (3.0 * mix * mix - 4.0 * mix + 1.0)
        + in_tangent * (3.0 * mix * mix - 2.0 * mix)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn angle_between(a: Quat, b: Quat) -> f32 {
        2.0 * (a - b).length().min((a + b).length()).atan2((a + b).length().max((a - b).length())) * 2.0
    }

    // Processors of another kind add the four products of a length in another order.
    #[cfg(target_arch = "x86_64")]
    #[test]
    fn slerp_gives_the_same_bits_on_linux_and_on_windows() {
        // The bits of 1,000 rotations; the C library of Linux gives 5801780303964411495, that of Windows 5200982879927384937.
        let mut sum = 0_u64;
        for step in 0..1000_u16 {
            let (a, b) = (Quat::from_xyzw(0.6, 0.0, 0.0, 0.8), Quat::from_xyzw(0.0, 0.28, 0.0, 0.96));
            let turned = slerp(a, b, f32::from(step) / 1000.0).to_array();
            sum = turned.iter().fold(sum, |sum, number| sum.rotate_left(5) ^ u64::from(number.to_bits()));
        }
        assert_eq!(sum, 15_946_459_963_397_958_561);
    }

    #[test]
    fn slerp_turns_at_constant_speed() {
        let a = Quat::from_rotation_y(0.2);
        let b = Quat::from_rotation_y(1.2);
        for step in 0..=10 {
            let mix = step as f32 / 10.0;
            let expected = Quat::from_rotation_y(0.2 + mix);
            assert!(angle_between(slerp(a, b, mix), expected) < 1e-6, "{mix}");
        }
    }

    #[test]
    fn slerp_goes_the_short_way_whatever_sign_the_keys_have() {
        let (a, b) = (Quat::from_rotation_z(0.1), Quat::from_rotation_z(0.7));
        let half = Quat::from_rotation_z(0.4);
        for (a, b) in [(a, b), (-a, b), (a, -b), (-a, -b)] {
            assert!(angle_between(slerp(a, b, 0.5), half) < 1e-6);
        }
    }

    #[test]
    fn half_a_turn_has_a_defined_axis() {
        // Quaternions at right angles: rotations 180° apart.
        let half = slerp(Quat::IDENTITY, Quat::from_xyzw(0.0, 1.0, 0.0, 0.0), 0.5);
        assert!(angle_between(half, Quat::from_rotation_y(std::f32::consts::FRAC_PI_2)) < 1e-6);
        let half = slerp(Quat::IDENTITY, Quat::from_xyzw(0.0, -1.0, 0.0, 0.0), 0.5);
        assert!(angle_between(half, Quat::from_rotation_y(-std::f32::consts::FRAC_PI_2)) < 1e-6);
    }

    #[test]
    fn slerp_is_continuous_where_it_changes_to_linear_interpolation() {
        let a = Quat::from_rotation_x(0.3);
        for angle in [0.000_1_f32, 0.001, 0.001_9, 0.002, 0.002_1, 0.003, 0.01] {
            let b = Quat::from_rotation_x(0.3 + angle);
            for mix in [0.1_f32, 0.5, 0.9] {
                let expected = Quat::from_rotation_x(0.3 + angle * mix);
                assert!(angle_between(slerp(a, b, mix), expected) < 5e-7, "{angle} {mix}");
            }
        }
    }

    #[test]
    fn hermite_meets_its_keys_and_tangents() {
        let (a, b) = (Vec3::new(1.0, 0.0, 0.0), Vec3::new(3.0, 5.0, 0.0));
        let (leave, arrive) = (Vec3::Y, Vec3::X);
        assert_eq!(hermite(a, leave, arrive, b, 2.0, 0.0), a);
        assert_eq!(hermite(a, leave, arrive, b, 2.0, 1.0), b);
        // Half way: a/2 + b/2 + span/8 * (leave - arrive).
        assert_eq!(hermite(a, leave, arrive, b, 2.0, 0.5), Vec3::new(1.75, 2.75, 0.0));
    }
}
