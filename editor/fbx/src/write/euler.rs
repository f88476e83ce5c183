//! Rotations as three angles: about x, then y, then z, all axes of the parent.

use crate::fit::FitValue;
use glam::{DMat3, DQuat, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Cosine of the middle angle below which the other two cannot be distinguished.
const LOCKED: f64 = 1e-6;

/// Angles in radians, of any number of turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EulerAngles(DVec3);

impl EulerAngles {
    /// Returns the angles of a rotation.
    pub(super) fn of(rotation: DQuat) -> Self {
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = DMat3::from_quat(settled(rotation));
        let cosine = libm::sqrt(x.x * x.x + x.y * x.y);
        let middle = libm::atan2(-x.z, cosine);
        if cosine < LOCKED {
            return Self(DVec3::new(libm::atan2(-z.y, y.y), middle, 0.0));
        }
        Self(DVec3::new(libm::atan2(y.z, z.z), middle, libm::atan2(x.y, x.x)))
    }

    /// Returns the rotation.
    pub(super) fn rotation(self) -> DQuat {
        let about = |axis: DVec3, angle: f64| {
            let axis = axis * libm::sin(0.5 * angle);
            DQuat::from_xyzw(axis.x, axis.y, axis.z, libm::cos(0.5 * angle))
        };
        about(DVec3::Z, self.0.z) * about(DVec3::Y, self.0.y) * about(DVec3::X, self.0.x)
    }

    /// Returns the angles in degrees.
    pub(super) fn degrees(self) -> DVec3 {
        self.0 * (180.0 / PI)
    }
}

/// Returns a rotation of unit length.
pub(super) fn settled(rotation: DQuat) -> DQuat {
    let is_good = rotation.is_finite() && rotation.length_squared() > 1e-12;
    if is_good { rotation.normalize() } else { DQuat::IDENTITY }
}

/// Returns the angle of whole turns more or less that is nearest to `other`.
fn unrolled(angle: f64, other: f64) -> f64 {
    angle - ((angle - other) / TAU).round() * TAU
}

impl FitValue for EulerAngles {
    fn between(&self, next: &Self, part: f64) -> Self {
        Self(self.0.lerp(next.0, part))
    }

    fn sum([a, b, c, d]: [&Self; 4], weights: [f64; 4]) -> Self {
        Self(a.0 * weights[0] + b.0 * weights[1] + c.0 * weights[2] + d.0 * weights[3])
    }

    fn settled(self) -> Self {
        self
    }

    fn near(self, other: &Self) -> Self {
        let near = |angles: DVec3| {
            let [x, y, z] = [0, 1, 2].map(|axis| unrolled(angles[axis], other.0[axis]));
            DVec3::new(x, y, z)
        };
        let cosine = libm::cos(self.0.y);
        if cosine.abs() < LOCKED {
            // Only the sum or the difference of the outer angles matters: both get half of the change.
            let y = unrolled(self.0.y, other.0.y);
            let sign = if unrolled(self.0.y - FRAC_PI_2, 0.0).abs() < 1.0 { -1.0 } else { 1.0 };
            let of = |angles: DVec3| angles.x + sign * angles.z;
            let change = 0.5 * (unrolled(of(self.0), of(other.0)) - of(other.0));
            return Self(DVec3::new(other.0.x + change, y, other.0.z + sign * change));
        }
        let same = near(self.0);
        let flipped = near(DVec3::new(self.0.x + PI, PI - self.0.y, self.0.z + PI));
        let travel = |angles: DVec3| (angles - other.0).abs().element_sum();
        Self(if travel(flipped) < travel(same) { flipped } else { same })
    }

    fn distance(&self, other: &Self) -> f64 {
        self.rotation().distance(&other.rotation())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns rotations all around, those at which angles are locked among them.
    fn rotations() -> Vec<DQuat> {
        let mut all = Vec::new();
        for x in -4..=4 {
            for y in -4..=4 {
                for z in -4..=4 {
                    let angles = DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * (PI / 4.0);
                    all.push(EulerAngles(angles).rotation());
                }
            }
        }
        all
    }

    #[test]
    fn angles_give_the_rotation_again_with_locked_axes_too() {
        for rotation in rotations() {
            let angle = EulerAngles::of(rotation).rotation().distance(&rotation);
            assert!(angle < 1e-7, "{rotation}: {angle:e}");
        }
    }

    #[test]
    fn angles_near_others_are_the_same_rotation_and_at_most_half_a_turn_away() {
        let others = [DVec3::ZERO, DVec3::new(7.0, -2.0, 31.0), DVec3::new(0.3, 1.5, -0.2)];
        for rotation in rotations() {
            for other in others.map(EulerAngles) {
                let near = EulerAngles::of(rotation).near(&other);
                assert!(near.rotation().distance(&rotation) < 1e-5, "{rotation} near {other:?}: {near:?}");
                assert!((near.0 - other.0).abs().max_element() <= PI + 1e-9, "{near:?} near {other:?}");
            }
        }
    }
}
