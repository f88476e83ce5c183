//! A transformation as an animator edits it: translation, rotation, scale.

use glam::{Affine3A, Mat4, Quat, Vec3};

/// Translation, rotation and scale of a bone relative to its parent (thesis §3.1.2, `Keyframe`).
///
/// As a matrix: scale first, then rotation, then translation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[doc(alias("local transform", "TRS"))]
pub struct Transform {
    /// Meters, or the length unit of the file.
    pub translation: Vec3,
    /// Unit quaternion, `xyzw`.
    pub rotation: Quat,
    /// Factor per axis of the bone's own space; may be negative (mirrored) or zero.
    pub scale: Vec3,
}

impl Transform {
    /// The identity.
    pub const IDENTITY: Self = Self { translation: Vec3::ZERO, rotation: Quat::IDENTITY, scale: Vec3::ONE };

    /// Returns the affine matrix `T · R · S` for column vectors: bone space → parent space.
    pub fn to_matrix(self) -> Mat4 {
        Mat4::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }

    /// Returns the same as an affine transform.
    pub fn to_affine(self) -> Affine3A {
        Affine3A::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }

    /// Returns the transform nearest to `matrix`.
    ///
    /// A mirrored matrix gets a negative x scale. Where an axis has no length, the rotation cannot be computed and is
    /// the identity. A sheared matrix has no exact decomposition: compare [`Self::to_matrix`] with the input to detect
    /// it.
    pub fn from_matrix(matrix: Mat4) -> Self {
        let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
        if scale.is_finite() && rotation.is_finite() && scale.min_element().abs() > 0.0 {
            Self { translation, rotation: rotation.normalize(), scale }
        } else {
            let scale = Vec3::new(
                matrix.x_axis.truncate().length(),
                matrix.y_axis.truncate().length(),
                matrix.z_axis.truncate().length(),
            );
            Self { translation: matrix.w_axis.truncate(), rotation: Quat::IDENTITY, scale }
        }
    }

    /// Returns whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.translation.is_finite() && self.rotation.is_finite() && self.scale.is_finite()
    }
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}
