//! A joint that swings in all directions and twists.

use super::AngleRange;
use super::axis::{direction, mirrored_axis};
use super::ellipse::nearest_in_ellipse;
use crate::trig::{rotation_about, rotation_of_vector};
use glam::{DQuat, DVec2, DVec3, Vec3};

/// Largest swing in radians: 175°. Exactly backwards, twist and direction could not be separated.
const MOST: f64 = 175.0 / 180.0 * std::f64::consts::PI;

/// A ball joint: a shoulder, a hip, a neck.
///
/// The turn is decomposed into a twist about the bone and then a swing that moves the bone:
///
/// ```text
/// turn   = swing * twist
/// twist  = (axis * (xyz · axis), w), divided by its length;   none where that is 0
/// swing  = turn * twist⁻¹ = a turn by σ about an axis at right angles to the bone
/// s      = σ * that axis, in the plane of `side` and `axis × side`
/// ```
///
/// * The swing is allowed where `(s·side / swing_side)² + (s·up / swing_up)² ≤ 1`, with `up = axis × side`: a cone
///   whose section is an ellipse, measured in angles. Otherwise the nearest point of that ellipse is used. So the limit
///   is continuous also for flat cones, where shrinking `s` towards 0 would jump.
/// * The twist is clamped to its range, which does not depend on the swing.
///
/// A half-angle of 0 allows no swing about that side: with `swing_up` = 0 the bone swings in one plane only. Negative
/// and NaN count as 0, more than 175° as 175°.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Direction of the bone, in its rest axes; any length but 0.
    pub axis: Vec3,
    /// A direction across the bone; only the part at right angles to `axis` counts, and without one any direction is
    /// used.
    pub side: Vec3,
    /// Largest swing about `side`: half of the cone's opening, radians.
    pub swing_side: f32,
    /// Largest swing about `axis × side`: half of the cone's opening, radians.
    pub swing_up: f32,
    /// Range of the twist about `axis`, right-handed.
    pub twist: AngleRange,
}

impl Ball {
    /// Creates a joint with a round cone: the same largest swing in every direction.
    pub fn round(axis: Vec3, swing: f32, twist: AngleRange) -> Self {
        Self { axis, side: Vec3::ZERO, swing_side: swing, swing_up: swing, twist }
    }

    pub(super) fn allowed(&self, turn: DQuat) -> DQuat {
        let Some(axis) = direction(self.axis) else { return turn };
        let side = self.side.as_dvec3();
        let side = side - axis * side.dot(axis);
        let side = side.try_normalize().unwrap_or_else(|| axis.any_orthonormal_vector());
        let up = axis.cross(side);

        let (swing, twist) = swing_twist(turn, axis);
        let swing = rotation_vector(swing);
        let swing = DVec2::new(swing.dot(side), swing.dot(up));
        let halves = DVec2::new(half(self.swing_side), half(self.swing_up));
        let swing = nearest_in_ellipse(swing, halves);
        let swing = rotation_of_vector(side * swing.x + up * swing.y);

        swing * rotation_about(axis, self.twist.clamp(twist))
    }

    pub(super) fn mirrored(&self, normal: usize) -> Self {
        Self { axis: mirrored_axis(self.axis, normal), side: mirrored_axis(self.side, normal), ..*self }
    }
}

fn half(angle: f32) -> f64 {
    // NaN fails the comparison.
    if angle > 0.0 { f64::from(angle).min(MOST) } else { 0.0 }
}

/// Returns the swing, and the angle of the twist about `axis` (radians, −π..=π), with `turn = swing * twist`.
fn swing_twist(turn: DQuat, axis: DVec3) -> (DQuat, f64) {
    let along = turn.xyz().dot(axis);
    let angle = 2.0 * libm::atan2(along, turn.w);
    let twist = rotation_about(axis, angle);
    (turn * twist.conjugate(), angle)
}

/// Returns axis times angle, the short way: 0..=π long.
pub(crate) fn rotation_vector(rotation: DQuat) -> DVec3 {
    let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
    let sine = rotation.xyz().length();
    if sine == 0.0 { DVec3::ZERO } else { rotation.xyz() * (2.0 * libm::atan2(sine, rotation.w) / sine) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn swing_after_twist_is_the_turn_and_the_swing_does_not_twist() {
        let axis = DVec3::new(0.3, 0.9, -0.2).normalize();
        for turn in [
            DQuat::IDENTITY,
            DQuat::from_axis_angle(axis, 2.0),
            DQuat::from_xyzw(0.1, -0.7, 0.5, 0.2).normalize(),
            DQuat::from_axis_angle(axis.any_orthonormal_vector(), std::f64::consts::PI),
        ] {
            let (swing, twist) = swing_twist(turn, axis);
            assert!((swing * DQuat::from_axis_angle(axis, twist)).dot(turn).abs() > 1.0 - 1e-12);
            assert!(rotation_vector(swing).dot(axis).abs() < 1e-12, "{turn}");
        }
    }
}
