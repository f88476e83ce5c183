//! Additive animation: the difference between a pose and a reference, added to any pose.
//!
//! Formulas and reasons are in the docs of [`difference`] and [`add`].

use super::{Mask, usable, weight_or_zero};
use crate::data::Transform;
use crate::sample::{Value, healthy};
use glam::{Quat, Vec3};

/// Computes the difference of `poses` from `reference`, bone by bone.
///
/// ```text
/// translation p - r        rotation p * r⁻¹        scale p / r
/// ```
///
/// Rotations are differences in the parent's space, applied from the left, so a nod stays a nod about the neck's axes
/// whatever the animation below does; the editor stores its changes in the same form. A difference is itself a list of
/// [`Transform`]s, with [`Transform::IDENTITY`] for no difference.
///
/// Added to `reference` with weight 1 it gives `poses` again, within rounding; a value that is equal in both gives
/// exactly no difference. Where `poses` or `reference` is shorter than `out`: no difference. Allocates nothing.
#[doc(alias = "additive")]
pub fn difference(poses: &[Transform], reference: &[Transform], out: &mut [Transform]) {
    for (bone, out) in out.iter_mut().enumerate() {
        *out = match (poses.get(bone), reference.get(bone)) {
            (Some(&pose), Some(&reference)) => difference_of(pose, reference),
            _ => Transform::IDENTITY,
        };
    }
}

/// Returns the difference of one bone; see [`difference`].
///
/// For an axis that `reference` scales by 0 no factor exists, so the factor is 1. A difference that leaves the range of
/// `f32` becomes no difference.
pub fn difference_of(pose: Transform, reference: Transform) -> Transform {
    let reference = usable(reference);
    let pose = healthy(pose, reference);
    let same = pose.rotation == reference.rotation || pose.rotation == -reference.rotation;
    let factor = |pose: f32, reference: f32| match pose / reference {
        _ if pose == reference => 1.0,
        factor if factor.is_finite() => factor,
        _ => 1.0,
    };
    let rotation = (pose.rotation * reference.rotation.conjugate()).normalize();
    Transform {
        translation: (pose.translation - reference.translation).healed(Vec3::ZERO),
        rotation: if same { Quat::IDENTITY } else { rotation },
        scale: Vec3::new(
            factor(pose.scale.x, reference.scale.x),
            factor(pose.scale.y, reference.scale.y),
            factor(pose.scale.z, reference.scale.z),
        ),
    }
}

/// Adds `differences` to `base`, bone by bone, each scaled by `weight` × `mask`.
///
/// ```text
/// w           = weight * mask at this bone
/// translation = b + w * d        rotation = d^w * b        scale = b * (1 + w * (d - 1))
/// ```
///
/// `d^w` turns about `d`'s axis by `w` times its angle, the short way.
///
/// Weight 0 (also a negative one and NaN) leaves the base unchanged bit for bit, and so does an identity difference.
/// Weight 1 adds the full difference; more than 1 exaggerates it. Where `differences` is shorter, the base is kept;
/// where `base` is shorter, the identity is used. For several additive layers, call this once per layer with `out` of
/// one call as `base` of the next, or use [`add_to`]. Allocates nothing.
#[doc(alias = "additive")]
pub fn add(
    base: &[Transform],
    differences: &[Transform],
    weight: f32,
    mask: Option<&Mask>,
    out: &mut [Transform],
) {
    for (bone, out) in out.iter_mut().enumerate() {
        let base = usable(base.get(bone).copied().unwrap_or_default());
        let weight = weight_or_zero(weight) * mask.map_or(1.0, |mask| mask.weight(bone));
        *out = match differences.get(bone) {
            Some(&difference) => add_to(base, difference, weight),
            None => base,
        };
    }
}

/// Adds the difference of one bone; see [`add`].
///
/// A difference that is not finite adds nothing; a sum that leaves the range of `f32` is replaced by the base's value.
pub fn add_to(base: Transform, difference: Transform, weight: f32) -> Transform {
    let base = usable(base);
    let (difference, weight) = (usable(difference), weight_or_zero(weight));
    if weight == 0.0 {
        return base;
    }
    let translation = base.translation + difference.translation * weight;
    let scale = base.scale * (Vec3::ONE + (difference.scale - Vec3::ONE) * weight);
    Transform {
        // Adding 0 would change -0 to 0.
        translation: if difference.translation == Vec3::ZERO {
            base.translation
        } else {
            translation.healed(base.translation)
        },
        rotation: turned(base.rotation, difference.rotation, weight),
        // At weight 1 a single product rounds less than the interpolation from 1.
        scale: if weight == 1.0 { base.scale * difference.scale } else { scale }.healed(base.scale),
    }
}

/// Returns `by^weight * rotation`.
fn turned(rotation: Quat, by: Quat, weight: f32) -> Quat {
    let by = if weight == 1.0 { by } else { power(by, weight) };
    if by == Quat::IDENTITY || by == -Quat::IDENTITY {
        return rotation;
    }
    let product = by * rotation;
    if product.is_finite() { product.normalize() } else { rotation }
}

/// Returns the rotation about the same axis by `factor` times the angle of `rotation`, the short way.
///
/// ```text
/// half angle = atan2(|xyz|, w), with w ≥ 0        power = (axis * sin(half * factor), cos(half * factor))
/// ```
fn power(rotation: Quat, factor: f32) -> Quat {
    let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
    let sine = rotation.xyz().length();
    if sine == 0.0 {
        return Quat::IDENTITY;
    }
    // As in `sample::mix`: the same bits on Linux and Windows.
    let half = libm::atan2f(sine, rotation.w) * factor;
    let axis = rotation.xyz() * (libm::sinf(half) / sine);
    Quat::from_xyzw(axis.x, axis.y, axis.z, libm::cosf(half))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_turns_about_the_same_axis_by_a_multiple_of_the_angle() {
        let axis = Vec3::new(1.0, -2.0, 0.5).normalize();
        for angle in [-3.0_f32, -1.0, -1e-4, 0.0, 1e-6, 0.5, 3.1] {
            for factor in [0.0_f32, 0.25, 0.5, 1.0, 2.0, 3.5] {
                let got = power(Quat::from_axis_angle(axis, angle), factor);
                let expected = Quat::from_axis_angle(axis, angle * factor);
                assert!(got.dot(expected).abs() > 1.0 - 1e-6, "{angle} {factor}");
                // The long way is not taken.
                assert_eq!(power(-Quat::from_axis_angle(axis, angle), factor), got);
            }
        }
    }
}
