//! Rotations as the angles that scripts have.

use glam::{DMat3, DQuat, DVec3};
use std::f64::consts::FRAC_PI_2;

/// Cosine below which two of the three axes are the same, so that one of the angles is free.
const LOCKED: f64 = 1e-6;

/// Returns the angles, degrees, of a rotation about x, then y, then z: the `turn` of an `attach`.
pub fn turn_about_axes(rotation: DQuat) -> DVec3 {
    let DMat3 { x_axis, y_axis, z_axis } = DMat3::from_quat(rotation.normalize());
    let y = arc_sine(-x_axis.z);
    if (y.abs() - FRAC_PI_2).abs() < LOCKED {
        return degrees(DVec3::new(libm::atan2(-z_axis.y, y_axis.y), y, 0.0));
    }
    degrees(DVec3::new(libm::atan2(y_axis.z, z_axis.z), y, libm::atan2(x_axis.y, x_axis.x)))
}

/// Returns the direction about the vertical, degrees, and the pitch and roll before it: `facing` and `tilt` of a prop.
pub fn facing_and_tilt(rotation: DQuat) -> (f64, [f64; 2]) {
    let DMat3 { x_axis, y_axis, z_axis } = DMat3::from_quat(rotation.normalize());
    let pitch = arc_sine(-z_axis.y);
    let angles = if (pitch.abs() - FRAC_PI_2).abs() < LOCKED {
        DVec3::new(libm::atan2(-x_axis.z, x_axis.x), pitch, 0.0)
    } else {
        DVec3::new(libm::atan2(z_axis.x, z_axis.z), pitch, libm::atan2(x_axis.y, y_axis.y))
    };
    let [facing, pitch, roll] = degrees(angles).to_array();
    (facing, [pitch, roll])
}

fn arc_sine(sine: f64) -> f64 {
    libm::asin(sine.clamp(-1.0, 1.0))
}

/// Returns angles in degrees, to a hundredth.
fn degrees(radians: DVec3) -> DVec3 {
    let hundredths = radians.to_array().map(|angle| (angle.to_degrees() * 100.0).round());
    // Adding zero makes a zero of a negative one.
    DVec3::from_array(hundredths) / 100.0 + 0.0
}
