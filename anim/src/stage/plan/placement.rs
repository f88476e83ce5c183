//! The placement of a thing: a position and a direction about the vertical.

use crate::stage::ease::smooth;
use crate::trig::rotation_about;
use glam::{DQuat, DVec3};
use std::f64::consts::{PI, TAU};

/// A position in meters and a direction in radians: 0 looks along +z, a quarter turn along +x.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// Meters; y points up.
    pub position: DVec3,
    /// Radians about +y.
    pub facing: f64,
}

impl Placement {
    /// Returns the direction as a rotation.
    pub fn rotation(&self) -> DQuat {
        rotation_about(DVec3::Y, self.facing)
    }

    /// Returns this placement followed by a movement in its own space.
    pub(in crate::stage) fn then(&self, movement: &Placement) -> Self {
        Self {
            position: self.position + self.rotation() * movement.position,
            facing: self.facing + movement.facing,
        }
    }

    /// Returns the movement that leads back.
    pub(in crate::stage) fn inverse(&self) -> Self {
        let back = Self { position: DVec3::ZERO, facing: -self.facing };
        Self { position: -(back.rotation() * self.position), ..back }
    }

    /// Returns the movement `times` times one after the other, by squaring.
    pub(in crate::stage) fn repeated(&self, times: u64) -> Self {
        let (mut square, mut left, mut product) = (*self, times, Self::default());
        while left > 0 {
            if left & 1 == 1 {
                product = product.then(&square);
            }
            square = square.then(&square);
            left >>= 1;
        }
        product
    }

    /// Returns the placement at the share `x` of a fade from this one to `other`; directions turn the short way.
    pub(in crate::stage) fn faded(&self, other: &Self, x: f64) -> Self {
        let weight = smooth(x);
        Self {
            position: self.position.lerp(other.position, weight),
            facing: self.facing + shortest(other.facing - self.facing) * weight,
        }
    }
}

/// Returns the angle from -π to π that is the same direction.
pub(in crate::stage) fn shortest(angle: f64) -> f64 {
    let turned = angle - TAU * (angle / TAU).round();
    if turned.is_finite() { turned.clamp(-PI, PI) } else { 0.0 }
}

/// Returns the direction of a vector on the ground; `None` for one without length there.
pub(in crate::stage) fn facing_of(direction: DVec3) -> Option<f64> {
    let flat = DVec3::new(direction.x, 0.0, direction.z);
    (flat.length_squared() > 1e-18).then(|| libm::atan2(direction.x, direction.z))
}
