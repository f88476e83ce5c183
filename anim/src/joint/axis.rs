//! The axes of joints.

use glam::{DVec3, Vec3};

/// Mirrors an axis of rotation: components in the plane are reversed, the one along the normal is kept.
pub(super) fn mirrored_axis(axis: Vec3, normal: usize) -> Vec3 {
    match normal {
        0 => Vec3::new(axis.x, -axis.y, -axis.z),
        1 => Vec3::new(-axis.x, axis.y, -axis.z),
        _ => Vec3::new(-axis.x, -axis.y, axis.z),
    }
}

/// Returns `axis` with length 1, in f64; `None` where it has no direction.
pub(super) fn direction(axis: Vec3) -> Option<DVec3> {
    axis.as_dvec3().try_normalize()
}
