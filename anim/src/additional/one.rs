//! One entry of the list.

use super::space::parent_to_root;
use super::{Additional, Change, Space};
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
    let full = match additional.change {
        Change::Add => added(pose, &additional, parent),
        Change::Replace => replaced(bone, &additional, parent),
    };
    let parts = additional.parts;
    let full = Transform {
        translation: if parts.translation { full.translation } else { pose.translation },
        rotation: if parts.rotation { full.rotation } else { pose.rotation },
        scale: if parts.scale { full.scale } else { pose.scale },
    };
    // Which also takes what is not a number from `pose`.
    poses[index] = mix_poses(pose, full, weight);
}

/// The row "add" of the table at [`Change`].
fn added(pose: Transform, additional: &Additional, parent: impl FnOnce() -> Mat4) -> Transform {
    let Transform { translation: by, rotation: turn, scale } = additional.transform;
    let (by_nothing, turned) = (by == Vec3::ZERO, turn != Quat::IDENTITY && turn != -Quat::IDENTITY);
    let (by, rotation) = match additional.space {
        Space::Bone => (pose.rotation * (pose.scale * by), pose.rotation * turn),
        Space::Parent => (by, turn * pose.rotation),
        Space::Root => {
            let parent = parent();
            // What cannot be computed is not a number, and leaves the pose as it is.
            let turn = Axes::of(parent).map_or(Quat::NAN, |axes| axes.rotation_from_outside(turn));
            (Mat3::from_mat4(parent).inverse() * by, turn * pose.rotation)
        }
    };
    Transform {
        // Nothing is added without rounding, and without the sign of a zero.
        translation: if by_nothing { pose.translation } else { pose.translation + by },
        rotation: if turned { rotation.normalize() } else { pose.rotation },
        scale: pose.scale * scale,
    }
}

/// The row "replace" of the table at [`Change`].
fn replaced(bone: &Bone, additional: &Additional, parent: impl FnOnce() -> Mat4) -> Transform {
    match additional.space {
        Space::Bone => added(rest_pose(bone), additional, || Mat4::IDENTITY),
        Space::Parent => additional.transform,
        Space::Root => {
            let local = parent().inverse() * additional.transform.to_matrix();
            // Without an inverse nothing is a number, and the pose stays.
            if local.is_finite() { Transform::from_matrix(local) } else { NOT_FINITE }
        }
    }
}

/// Replaced by the pose that was there.
const NOT_FINITE: Transform = Transform { translation: Vec3::NAN, rotation: Quat::NAN, scale: Vec3::NAN };
