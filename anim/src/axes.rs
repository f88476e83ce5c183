//! The axes of a space without their lengths.

use glam::{Mat3, Mat4, Quat, Vec3, Vec4Swizzles};

/// Right-angled axes of unit length, nearest to those of a matrix.
#[derive(Clone, Copy)]
pub(crate) struct Axes {
    x: Vec3,
    y: Vec3,
    /// Whether z points against `x × y`.
    mirrored: bool,
}

impl Axes {
    /// Returns the axes of the space that `matrix` maps from: x keeps its direction, y stays in its plane with x
    /// (Gram–Schmidt), and z stays on its side of that plane. `None` where an axis has no length or is not finite, or
    /// where all three are in one plane.
    pub(crate) fn of(matrix: Mat4) -> Option<Self> {
        // Lengths first: squares of very small or large numbers leave the range of f32.
        let unit = |axis: Vec3| (axis / axis.abs().max_element()).try_normalize();
        let x = unit(matrix.x_axis.xyz())?;
        let y = unit(matrix.y_axis.xyz())?;
        let z = unit(matrix.z_axis.xyz())?;
        let y = (y - x * x.dot(y)).try_normalize()?;
        let side = x.cross(y).dot(z);
        (side != 0.0).then_some(Self { x, y, mirrored: side < 0.0 })
    }

    /// Returns the rotation with these axes; where they are mirrored, with z reversed.
    pub(crate) fn rotation(&self) -> Quat {
        Quat::from_mat3(&Mat3::from_cols(self.x, self.y, self.x.cross(self.y))).normalize()
    }

    /// Returns `A⁻¹ · rotation · A`, with these axes as the columns of `A`: a rotation given in the outer space,
    /// expressed in this one.
    ///
    /// Mirrored axes are a rotation with all three axes reversed, and reversing all axes changes no rotation: `(-B)⁻¹ ·
    /// R · (-B) = B⁻¹ · R · B`.
    pub(crate) fn rotation_from_outside(&self, rotation: Quat) -> Quat {
        let sign = if self.mirrored { -1.0 } else { 1.0 };
        let axes = Mat3::from_cols(self.x * sign, self.y * sign, self.x.cross(self.y));
        let axes = Quat::from_mat3(&axes).normalize();
        axes.conjugate() * rotation * axes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_no_scale_and_a_mirrored_matrix_is_detected() {
        let turn = Quat::from_xyzw(0.3, -0.5, 0.1, 0.8).normalize();
        for scale in [Vec3::ONE, Vec3::new(2.0, 1e-20, 1e19), Vec3::splat(1e-30)] {
            let matrix = Mat4::from_scale_rotation_translation(scale, turn, Vec3::ONE);
            let axes = Axes::of(matrix).unwrap();
            assert!(axes.rotation().dot(turn).abs() > 1.0 - 1e-6 && !axes.mirrored, "{scale}");
        }
        let mirror = Mat4::from_scale_rotation_translation(Vec3::new(1.0, 1.0, -2.0), turn, Vec3::ONE);
        let axes = Axes::of(mirror).unwrap();
        assert!(axes.rotation().dot(turn).abs() > 1.0 - 1e-6 && axes.mirrored);
    }

    #[test]
    fn matrices_with_an_axis_without_length_or_axes_in_one_plane_have_no_axes() {
        let matrix = |x, y, z| Mat4::from_mat3(Mat3::from_cols(x, y, z));
        assert!(Axes::of(Mat4::ZERO).is_none());
        assert!(Axes::of(Mat4::NAN).is_none());
        assert!(Axes::of(matrix(Vec3::X, Vec3::X, Vec3::Z)).is_none());
        assert!(Axes::of(matrix(Vec3::X, Vec3::Y, Vec3::X)).is_none());
        assert!(Axes::of(matrix(Vec3::INFINITY, Vec3::Y, Vec3::Z)).is_none());
    }
}
