//! Normals and tangents: directions that a matrix with unequal scales would tilt.
//!
//! A normal is not moved by the matrix `M` of its vertex but by the transposed inverse of its linear part, so that it
//! stays at right angles to the surface. That is computed as the cofactor matrix, which needs no division and therefore
//! exists where a scale is zero:
//!
//! ```text
//! M = [x y z]      cofactors = [y×z  z×x  x×y]      inverse transpose = cofactors / determinant
//! normal = normalize(sign(determinant) * cofactors * normal)
//! ```
//!
//! The sign turns the normals of a mirrored bone to the correct side. One zero scale flattens the surface: its normal
//! becomes that of the plane, as it should. With two zero scales no cofactor is left: the normal is moved like a
//! tangent, by `M` itself; with three it is not changed.

use super::{Movement, morphed};
use crate::data::Primitive;
use glam::{Mat3, Mat4, Vec3, Vec4};

/// Returns `sign(determinant) * cofactors` of the linear part of `matrix`, scaled so that its numbers are near 1:
/// normals are multiplied by it and normalized.
///
/// A determinant of zero counts as positive. All zero where two or three scales are zero.
pub fn normal_matrix(matrix: Mat4) -> Mat3 {
    let linear = near_one(Mat3::from_mat4(matrix));
    let cofactors = Mat3::from_cols(
        linear.y_axis.cross(linear.z_axis),
        linear.z_axis.cross(linear.x_axis),
        linear.x_axis.cross(linear.y_axis),
    );
    if mirrors(linear) { -cofactors } else { cofactors }
}

/// Moves normals of `primitive` to scene space, unit length, up to the length of `out`.
///
/// Returns the number written; 0 when the primitive has no normals. Allocates nothing.
pub fn skin_normals(
    primitive: &Primitive,
    movement: Movement<'_>,
    morph_weights: &[f32],
    out: &mut [Vec3],
) -> usize {
    let normals = &primitive.vertices.normals;
    for (index, (&stored, out)) in normals.iter().zip(out.iter_mut()).enumerate() {
        *out = moved_normal(primitive, movement, morph_weights, index, stored);
    }
    normals.len().min(out.len())
}

/// Returns the normal of vertex `index` of `primitive` in scene space, unit length: [`skin_normals`] for one vertex;
/// `None` where it has none.
pub fn skin_normal(
    primitive: &Primitive,
    movement: Movement<'_>,
    morph_weights: &[f32],
    index: usize,
) -> Option<Vec3> {
    let stored = *primitive.vertices.normals.get(index)?;
    Some(moved_normal(primitive, movement, morph_weights, index, stored))
}

fn moved_normal(
    primitive: &Primitive,
    movement: Movement<'_>,
    morph_weights: &[f32],
    index: usize,
    stored: Vec3,
) -> Vec3 {
    let normal = morphed(primitive, morph_weights, stored, |target| target.normals.get(index).copied());
    let matrix = movement.matrix(primitive, index);
    first_direction([
        normal_matrix(matrix) * normal,
        near_one(Mat3::from_mat4(matrix)) * normal,
        normal,
        stored,
    ])
}

/// Moves tangents of `primitive` to scene space, up to the length of `out`.
///
/// xyz follow the surface, so the matrix itself moves them, and they have unit length; w, the side of the bitangent,
/// changes its sign where the matrix mirrors. Returns the number written; 0 when the primitive has no tangents.
/// Allocates nothing.
pub fn skin_tangents(
    primitive: &Primitive,
    movement: Movement<'_>,
    morph_weights: &[f32],
    out: &mut [Vec4],
) -> usize {
    let tangents = &primitive.vertices.tangents;
    for (index, (&stored, out)) in tangents.iter().zip(out.iter_mut()).enumerate() {
        let tangent = morphed(primitive, morph_weights, stored.truncate(), |target| {
            target.tangents.get(index).copied()
        });
        let linear = near_one(Mat3::from_mat4(movement.matrix(primitive, index)));
        let side = if stored.w < 0.0 { -1.0 } else { 1.0 };
        let side = if mirrors(linear) { -side } else { side };
        *out = first_direction([linear * tangent, tangent, stored.truncate()]).extend(side);
    }
    tangents.len().min(out.len())
}

/// Returns whether the determinant is negative.
fn mirrors(linear: Mat3) -> bool {
    linear.x_axis.cross(linear.y_axis).dot(linear.z_axis) < 0.0
}

/// Returns `linear` divided by its largest number, so that products of three stay within f32; zero stays zero.
pub(crate) fn near_one(linear: Mat3) -> Mat3 {
    let largest = linear.to_cols_array().into_iter().map(f32::abs).fold(0.0, f32::max);
    if largest > 0.0 { Mat3::from_cols_array(&linear.to_cols_array().map(|n| n / largest)) } else { linear }
}

/// Returns the first of `candidates` that has a direction, unit length; +Y when none has.
pub(crate) fn first_direction<const N: usize>(candidates: [Vec3; N]) -> Vec3 {
    candidates.into_iter().find_map(direction).unwrap_or(Vec3::Y)
}

/// Returns `vector` divided by its length; `None` when it is zero or not finite.
fn direction(vector: Vec3) -> Option<Vec3> {
    let largest = vector.abs().max_element();
    if !vector.is_finite() || largest == 0.0 {
        return None;
    }
    // For very small numbers, 1/largest would be infinite; the quotient itself is not.
    let near_one = vector / largest;
    near_one.is_finite().then(|| near_one.normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;

    #[test]
    fn the_normal_matrix_is_the_inverse_transpose_up_to_its_length() {
        let rotation = Quat::from_xyzw(0.1, 0.7, -0.3, 0.6).normalize();
        for scale in [Vec3::ONE, Vec3::new(1.0, 2.0, 3.0), Vec3::new(-1.0, 2.0, 0.5), Vec3::splat(-2.0)] {
            let matrix = Mat4::from_scale_rotation_translation(scale, rotation, Vec3::X);
            let expected = Mat3::from_mat4(matrix).inverse().transpose();
            for normal in [Vec3::X, Vec3::Y, Vec3::new(1.0, -2.0, 3.0)] {
                let got = (normal_matrix(matrix) * normal).normalize();
                assert!((got - (expected * normal).normalize()).length() < 1e-5, "{scale} {normal}");
            }
        }
    }

    #[test]
    fn a_flattened_surface_faces_along_the_axis_that_vanished() {
        let matrix = Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0));
        let normal = normal_matrix(matrix) * Vec3::new(0.3, 0.8, 0.1);
        assert_eq!(direction(normal), Some(Vec3::Y));
    }

    #[test]
    fn tiny_and_huge_directions_have_unit_length() {
        for length in [1e-44, 1e-38, 1e-20, 1.0, 1e20, 1e38] {
            let found = direction(Vec3::new(length, 0.0, -length)).unwrap();
            assert!((found - Vec3::new(1.0, 0.0, -1.0).normalize()).length() < 1e-6, "{length}");
        }
        assert_eq!(direction(Vec3::ZERO), None);
        assert_eq!(direction(Vec3::new(f32::NAN, 0.0, 0.0)), None);
    }
}
