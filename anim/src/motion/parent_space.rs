//! The space of the bone's parent at one time.

use super::MotionError;
use crate::animation::to_parent;
use crate::data::{BoneIndex, Skeleton, Take};
use crate::sample::{rest_pose, sample_track};
use glam::{DMat3, DMat4, DQuat, DVec3};

/// `P`, its inverse, and its rotation `R`.
#[derive(Clone, Copy, Debug)]
pub(super) struct ParentSpace {
    to_root: DMat4,
    from_root: DMat4,
    rotation: DQuat,
}

impl ParentSpace {
    /// Computes the space of the parent of `bone` at `time` seconds of `take`.
    pub(super) fn at(
        take: &Take,
        skeleton: &Skeleton,
        bone: BoneIndex,
        time: f32,
    ) -> Result<Self, MotionError> {
        let mut to_root = DMat4::IDENTITY;
        for ancestor in skeleton.ancestors(bone).map(|above| above as usize) {
            let (bone, track) = (&skeleton.bones[ancestor], take.tracks.get(ancestor));
            let pose = track.map_or_else(|| rest_pose(bone), |track| sample_track(track, bone, time));
            to_root = to_parent(bone, pose).as_dmat4() * to_root;
        }
        let from_root = to_root.inverse();
        let milliseconds = (f64::from(time) * 1000.0) as i64;
        if to_root.determinant() == 0.0 || !from_root.is_finite() {
            return Err(MotionError::Flat { bone, milliseconds });
        }
        Ok(Self { to_root, from_root, rotation: rotation_of(DMat3::from_mat4(to_root)) })
    }

    /// Converts a position relative to the parent to to-root space.
    pub(super) fn point_to_root(&self, translation: DVec3) -> DVec3 {
        self.to_root.transform_point3(translation)
    }

    /// Converts a position in to-root space to one relative to the parent.
    pub(super) fn point_from_root(&self, place: DVec3) -> DVec3 {
        self.from_root.transform_point3(place)
    }

    /// Converts a velocity, or a difference of two positions, to to-root space.
    pub(super) fn vector_to_root(&self, vector: DVec3) -> DVec3 {
        self.to_root.transform_vector3(vector)
    }

    /// Converts a velocity, or a difference of two positions, to the parent's space.
    pub(super) fn vector_from_root(&self, vector: DVec3) -> DVec3 {
        self.from_root.transform_vector3(vector)
    }

    /// Returns `R⁻¹ Y R`: a rotation of to-root space as one of the parent's space. Any quaternion, the length is kept.
    pub(super) fn rotation_from_root(&self, rotation: DQuat) -> DQuat {
        let turned = self.rotation.conjugate() * rotation.xyz();
        DQuat::from_xyzw(turned.x, turned.y, turned.z, rotation.w)
    }

    /// Returns `R q`: a rotation relative to the parent in to-root space.
    pub(super) fn rotation_to_root(&self, rotation: DQuat) -> DQuat {
        self.rotation * rotation
    }
}

/// Returns the rotation R of a matrix P. For a mirrored matrix it is the rotation of `-P`: `P⁻¹ Y P` and `R⁻¹ Y R` are
/// equal in both cases.
fn rotation_of(matrix: DMat3) -> DQuat {
    let matrix = if matrix.determinant() < 0.0 { -matrix } else { matrix };
    let z = matrix.z_axis.normalize_or(DVec3::Z);
    let y = (matrix.y_axis - z * matrix.y_axis.dot(z))
        .try_normalize()
        .unwrap_or_else(|| z.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(y.cross(z), y, z)).normalize()
}
