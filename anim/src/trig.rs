//! Rotations about an axis that are the same, bit for bit, on every system.
//!
//! The C libraries of Linux and Windows round sine, arc tangent and others differently in the last place, and the methods of `f32`,
//! `f64` and glam's rotations call them. So this crate calls `libm` instead, which is compiled with it. Square roots and roundings are
//! exact on every system.
//!
//! ```
//! use dragonfly_anim::trig::{rotation_about, rotation_of_vector};
//! use glam::DVec3;
//!
//! let quarter = rotation_about(DVec3::Z, std::f64::consts::FRAC_PI_2);
//! assert!((quarter * DVec3::X - DVec3::Y).length() < 1e-15);
//! assert_eq!(rotation_of_vector(DVec3::Z * std::f64::consts::FRAC_PI_2), quarter);
//! ```

use glam::{DQuat, DVec3};

/// Returns the rotation by `angle`, radians, about `axis`, which has unit length.
#[doc(alias = "from_axis_angle")]
pub fn rotation_about(axis: DVec3, angle: f64) -> DQuat {
    let (sine, cosine) = libm::sincos(0.5 * angle);
    let vector = axis * sine;
    DQuat::from_xyzw(vector.x, vector.y, vector.z, cosine)
}

/// Returns the rotation about `vector` by its length, radians.
#[doc(alias = "from_scaled_axis")]
pub fn rotation_of_vector(vector: DVec3) -> DQuat {
    let angle = vector.length();
    if angle == 0.0 { DQuat::IDENTITY } else { rotation_about(vector / angle, angle) }
}
