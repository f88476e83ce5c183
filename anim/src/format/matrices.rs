//! Matrices of files: their parts, their inverse; rotations of unit length.

use crate::data::Transform;
use glam::{DMat4, Mat4, Quat};

/// Returns translation, rotation and scale of an affine matrix, and the matrix itself where it is sheared and they cannot
/// represent it; `None` if it is too large to be decomposed.
pub(super) fn split(matrix: Mat4) -> Option<(Transform, Option<Mat4>)> {
    let parts = Transform::from_matrix(matrix);
    if !parts.is_finite() {
        return None;
    }
    // The tolerance depends on the axes only, so that a large translation does not hide a small shear.
    let largest = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(|axis| axis.abs().max_element());
    let tolerance = 1e-4 * largest.into_iter().fold(f32::MIN_POSITIVE, f32::max);
    let is_sheared = !parts.to_matrix().abs_diff_eq(matrix, tolerance);
    Some((parts, is_sheared.then_some(matrix)))
}

/// Returns the inverse, computed in double precision; `None` if it does not exist or does not fit single precision.
pub(super) fn inverse(matrix: Mat4) -> Option<Mat4> {
    let wide: DMat4 = matrix.as_dmat4();
    let determinant = wide.determinant();
    if determinant == 0.0 || !determinant.is_finite() {
        return None;
    }
    Some(wide.inverse().as_mat4()).filter(Mat4::is_finite)
}

/// Returns a finite quaternion normalized, and the deviation of its length from one; `None` for zero.
pub(super) fn unit(rotation: Quat) -> Option<(Quat, f32)> {
    // Double precision, because the square of 1e-30 or 1e30 does not fit single precision.
    let wide = rotation.as_dquat();
    let length = wide.length();
    if length == 0.0 || !length.is_finite() {
        return None;
    }
    // Already normalized as far as single precision goes: kept bit for bit.
    if (length - 1.0).abs() <= f64::from(f32::EPSILON) {
        return Some((rotation, 0.0));
    }
    Some(((wide * (1.0 / length)).as_quat(), (length - 1.0).abs() as f32))
}
