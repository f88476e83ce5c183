//! Geometry functions that the solvers share.

use glam::{DQuat, DVec3, Mat3, Quat, Vec3};

/// Returns the shortest rotation from unit vector `from` to unit vector `to`.
///
/// ```text
/// xyz = from × to,   w = 1 + from · to = |from + to|² / 2,   then normalized
/// ```
///
/// The second form of w is accurate where the two are nearly opposite. Exactly opposite: half a turn about some axis at
/// a right angle to `from`.
pub(super) fn arc(from: Vec3, to: Vec3) -> Quat {
    let cross = from.cross(to);
    let w = 0.5 * (from + to).length_squared();
    if w < 1e-13 {
        let axis = from.any_orthonormal_vector();
        return Quat::from_xyzw(axis.x, axis.y, axis.z, 0.0);
    }
    Quat::from_xyzw(cross.x, cross.y, cross.z, w).normalize()
}

/// As [`arc`], for vectors of any length, in f64; the identity where one has none.
pub(crate) fn arc_between(from: DVec3, to: DVec3) -> DQuat {
    let (Some(from), Some(to)) = (from.try_normalize(), to.try_normalize()) else { return DQuat::IDENTITY };
    let cross = from.cross(to);
    let w = 0.5 * (from + to).length_squared();
    if w < 1e-28 {
        let axis = from.any_orthonormal_vector();
        return DQuat::from_xyzw(axis.x, axis.y, axis.z, 0.0);
    }
    DQuat::from_xyzw(cross.x, cross.y, cross.z, w).normalize()
}

/// Returns the part of `vector` at a right angle to unit vector `axis`, as a unit vector; `None` where that is less
/// than a millionth of it.
pub(super) fn perpendicular(vector: Vec3, axis: Vec3) -> Option<Vec3> {
    let part = vector - axis * vector.dot(axis);
    let length = part.length();
    (length > 1e-6 * vector.length()).then(|| part / length)
}

/// Returns the rotation about unit vector `axis` that brings `from` nearest to `to`; `None` where one of them is along
/// it.
pub(super) fn twist_towards(axis: Vec3, from: Vec3, to: Vec3) -> Option<Quat> {
    let (from, to) = (perpendicular(from, axis)?, perpendicular(to, axis)?);
    let w = 0.5 * (from + to).length_squared();
    let along = axis.dot(from.cross(to));
    if w < 1e-13 {
        return Some(Quat::from_xyzw(axis.x, axis.y, axis.z, 0.0));
    }
    Some(Quat::from_xyzw(axis.x * along, axis.y * along, axis.z * along, w).normalize())
}

/// Returns the rotation nearest to `matrix` in its z and y axes: both made perpendicular, the third follows, so that a
/// mirrored matrix has its x axis reversed; `None` where an axis has no length.
pub(super) fn rotation_of(matrix: Mat3) -> Option<Quat> {
    let z = matrix.z_axis.try_normalize()?;
    let y = (matrix.y_axis - z * matrix.y_axis.dot(z)).try_normalize()?;
    let rotation = Quat::from_mat3(&Mat3::from_cols(y.cross(z), y, z));
    rotation.is_finite().then(|| rotation.normalize())
}

/// Clamps a weight to 0..=1; NaN is 0.
pub(super) fn share(weight: f32) -> f32 {
    if weight > 0.0 { weight.min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_turn_is_exact_for_small_angles_and_near_half_a_turn() {
        for angle in [0.0_f32, 1e-6, 1e-4, 7e-4, 0.1, 1.5, 3.0, 3.140_5, 3.1412, std::f32::consts::PI] {
            let (from, to) = (Vec3::X, Vec3::new(angle.cos(), angle.sin(), 0.0));
            let got = arc(from, to) * from;
            assert!((got - to).length() < 3e-7, "{angle}: {got} {to}");
        }
        assert!((arc(Vec3::Y, Vec3::NEG_Y) * Vec3::Y + Vec3::Y).length() < 1e-6);
    }

    #[test]
    fn a_twist_keeps_its_axis() {
        let axis = Vec3::new(0.6, 0.0, 0.8);
        let twist = twist_towards(axis, Vec3::Y, Vec3::new(0.8, -0.1, -0.6)).unwrap();
        assert!((twist * axis - axis).length() < 1e-6);
        let got = perpendicular(twist * Vec3::Y, axis).unwrap();
        assert!((got - perpendicular(Vec3::new(0.8, -0.1, -0.6), axis).unwrap()).length() < 1e-6);
        assert_eq!(twist_towards(axis, axis, Vec3::Y), None);
    }
}
