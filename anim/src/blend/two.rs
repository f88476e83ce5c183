//! Blending of exactly two poses, with slerp for rotations.

use super::{Mask, fraction, usable};
use crate::data::Transform;
use crate::sample::{healthy, mix};
use glam::{Quat, Vec3};

/// Blends two poses, `mix` of the way from `from` to `to`; rotations turn at constant speed ([`mix::slerp`]).
///
/// ```text
/// m           = mix * mask at this bone, clamped to 0..=1
/// translation = (1 - m) * from + m * to            scale too
/// rotation    = slerp(from, to, m), the short way
/// ```
///
/// The result is bit for bit `from` where `m` is 0, `to` where `m` is 1, and the common pose where both are equal.
/// Where `from` is shorter, the identity is used; where `to` is shorter, `from` is kept. Rules: see [`super`].
/// Allocates nothing.
pub fn blend_two(from: &[Transform], to: &[Transform], mix: f32, mask: Option<&Mask>, out: &mut [Transform]) {
    for (bone, out) in out.iter_mut().enumerate() {
        let from = from.get(bone).copied().unwrap_or_default();
        let to = to.get(bone).copied().unwrap_or(from);
        *out = mix_poses(from, to, fraction(mix) * mask.map_or(1.0, |mask| mask.weight(bone)));
    }
}

/// Returns the pose `mix` of the way from one pose to another; one bone of [`blend_two`].
pub fn mix_poses(from: Transform, to: Transform, mix: f32) -> Transform {
    let from = usable(from);
    let to = healthy(to, from);
    let mix = fraction(mix);
    if mix == 0.0 {
        return from;
    }
    if mix == 1.0 {
        return to;
    }
    Transform {
        translation: vector(from.translation, to.translation, mix),
        rotation: rotation(from.rotation, to.rotation, mix),
        scale: vector(from.scale, to.scale, mix),
    }
}

/// Interpolates linearly; if both vectors are equal, returns that vector without rounding.
fn vector(from: Vec3, to: Vec3, mix: f32) -> Vec3 {
    let mixed = mix::lerp(from, to, mix);
    if from == to || !mixed.is_finite() { from } else { mixed }
}

/// Interpolates the short way; if both rotations are equal, returns that rotation without rounding.
fn rotation(from: Quat, to: Quat, mix: f32) -> Quat {
    if from == to || from == -to { from } else { mix::slerp(from, to, mix) }
}
