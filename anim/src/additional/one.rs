//! Application of one additional transformation.

use super::space::parent_to_root;
use super::{Additional, AdditionalMode, Space};
use crate::axes::Axes;
use crate::blend::{fraction, mix_poses};
use crate::data::{Bone, Skeleton, Transform};
use crate::sample::{healthy, rest_pose};
use glam::{Mat3, Mat4, Quat, Vec3};

/// Applies one entry; see [`super::apply`].
pub(super) fn apply_one(skeleton: &Skeleton, additional: &Additional, poses: &mut [Transform]) {
    let index = additional.bone as usize;
    let (Some(bone), Some(&pose)) = (skeleton.bones.get(index), poses.get(index)) else { return };
    let weight = fraction(additional.weight);
    if weight == 0.0 || !additional.transform.is_finite() {
        return;
    }
    let additional =
        Additional { transform: healthy(additional.transform, Transform::IDENTITY), ..*additional };
    let pose = healthy(pose, rest_pose(bone));
    let parent = || parent_to_root(skeleton, index, poses);
    let full = match additional.mode {
        AdditionalMode::Add => added(pose, &additional, parent),
        AdditionalMode::Replace => replaced(bone, &additional, parent),
    };
    let parts = additional.parts;
    let full = Transform {
        translation: if parts.translation { full.translation } else { pose.translation },
        rotation: if parts.rotation { full.rotation } else { pose.rotation },
        scale: if parts.scale { full.scale } else { pose.scale },
    };
    // Mixing also replaces NaN by the value of `pose`.
    poses[index] = mix_poses(pose, full, weight);
}

/// Computes the column "add" of the table at [`AdditionalMode`].
fn added(pose: Transform, additional: &Additional, parent: impl FnOnce() -> Mat4) -> Transform {
    let Transform { translation: by, rotation: turn, scale } = additional.transform;
    let (by_nothing, turned) = (by == Vec3::ZERO, turn != Quat::IDENTITY && turn != -Quat::IDENTITY);
    let (by, rotation) = match additional.space {
        Space::Bone => (pose.rotation * (pose.scale * by), pose.rotation * turn),
        Space::Parent => (by, turn * pose.rotation),
        Space::Root => {
            let parent = parent();
            // NaN where the rotation cannot be computed; the pose then keeps its own.
            let turn = Axes::of(parent).map_or(Quat::NAN, |axes| axes.rotation_from_outside(turn));
            (Mat3::from_mat4(parent).inverse() * by, turn * pose.rotation)
        }
    };
    Transform {
        // Skips the addition of zero, which could round, or change the sign of a zero.
        translation: if by_nothing { pose.translation } else { pose.translation + by },
        rotation: if turned { rotation.normalize() } else { pose.rotation },
        scale: pose.scale * scale,
    }
}

/// Computes the column "replace" of the table at [`AdditionalMode`].
fn replaced(bone: &Bone, additional: &Additional, parent: impl FnOnce() -> Mat4) -> Transform {
    match additional.space {
        Space::Bone => added(rest_pose(bone), additional, || Mat4::IDENTITY),
        Space::Parent => additional.transform,
        Space::Root => {
            let local = parent().inverse() * additional.transform.to_matrix();
            // Without an inverse every number is NaN, and the pose keeps its own.
            if local.is_finite() { Transform::from_matrix(local) } else { NOT_FINITE }
        }
    }
}

/// Result of a failed computation; the caller replaces it by the pose that was there.
const NOT_FINITE: Transform = Transform { translation: Vec3::NAN, rotation: Quat::NAN, scale: Vec3::NAN };
