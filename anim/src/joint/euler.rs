//! Joint limits as three Euler angles, each with a range.

use super::AngleRange;
use crate::trig::rotation_about;
use glam::{DQuat, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Largest second angle in radians: 88°. At 90° the first and the third turn have the same axis.
const MOST: f64 = 88.0 / 180.0 * std::f64::consts::PI;

/// Distance from 90° below which the first and the third turn are about the same line, radians. A thousand times the rounding error
/// of single precision.
const LOCKED: f64 = 1e-6;

/// Order of three turns, each about an axis that the turns before it have moved along (intrinsic). `Xyz` is the product
/// `x * y * z`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum EulerOrder {
    /// About x, then y, then z.
    #[default]
    Xyz,
    /// About x, then z, then y.
    Xzy,
    /// About y, then x, then z.
    Yxz,
    /// About y, then z, then x.
    Yzx,
    /// About z, then x, then y.
    Zxy,
    /// About z, then y, then x.
    Zyx,
}

impl EulerOrder {
    /// All orders.
    pub const ALL: [Self; 6] = [Self::Xyz, Self::Xzy, Self::Yxz, Self::Yzx, Self::Zxy, Self::Zyx];

    /// Returns the axes in this order: 0 x, 1 y, 2 z.
    pub fn axes(self) -> [usize; 3] {
        match self {
            Self::Xyz => [0, 1, 2],
            Self::Xzy => [0, 2, 1],
            Self::Yxz => [1, 0, 2],
            Self::Yzx => [1, 2, 0],
            Self::Zxy => [2, 0, 1],
            Self::Zyx => [2, 1, 0],
        }
    }

    /// Returns the rotation of three angles in this order, radians.
    pub fn rotation(self, angles: [f64; 3]) -> DQuat {
        let [first, second, third] = self.axes().map(|axis| DVec3::AXES[axis]);
        rotation_about(first, angles[0])
            * rotation_about(second, angles[1])
            * rotation_about(third, angles[2])
    }

    /// Returns three angles in this order, radians: −π..=π, the second one −π/2..=π/2. If that one is at an end of its range, the third
    /// one is 0.
    ///
    /// After Bernardes and Viollet (PLOS ONE 17(11), 2022), because it is as exact near 90° as elsewhere; the conversion by a matrix
    /// loses half of the digits there.
    pub fn angles(self, rotation: DQuat) -> [f64; 3] {
        // The method names the axes of an extrinsic rotation, which is applied in the opposite order.
        let [k, j, i] = self.axes();
        let sign = if (i + 1) % 3 == j { 1.0 } else { -1.0 };
        let q = rotation.normalize().to_array();
        let (a, b) = (q[3] - q[j], q[i] + q[k] * sign);
        let (c, d) = (q[j] + q[3], q[k] * sign - q[i]);
        let second = 2.0 * libm::atan2(libm::hypot(c, d), libm::hypot(a, b));
        let (sum, difference) = (libm::atan2(b, a), libm::atan2(d, c));
        let (first, third) = if second <= LOCKED {
            (2.0 * sum * sign, 0.0)
        } else if second >= PI - LOCKED {
            (2.0 * difference * sign, 0.0)
        } else {
            ((sum + difference) * sign, sum - difference)
        };
        [first, second - FRAC_PI_2, third].map(wrapped)
    }
}

fn wrapped(angle: f64) -> f64 {
    if (-PI..=PI).contains(&angle) { angle } else { angle - (angle / TAU).round() * TAU }
}

/// A range for each of three turns that follow each other.
///
/// ```text
/// turn    = R(first axis, a) * R(second axis, b) * R(third axis, c)      −π ≤ a, c ≤ π,  −π/2 ≤ b ≤ π/2
/// allowed = the same with each angle clamped to its range
/// ```
///
/// Each angle is clamped separately, so the result is not the allowed rotation nearest to the turn. The second angle is
/// clamped to ±88°; put the axis that bends furthest (an elbow's) first or last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Euler {
    /// The order of the turns.
    pub order: EulerOrder,
    /// Range of the turn about each axis: x, y, z, whatever the order.
    pub ranges: [AngleRange; 3],
}

impl Euler {
    pub(super) fn allowed(&self, turn: DQuat) -> DQuat {
        let [first, second, third] = self.order.axes().map(|axis| self.ranges[axis]);
        let [a, b, c] = self.order.angles(turn);
        self.order.rotation([first.clamp(a), second.clamp_within(MOST, b), third.clamp(c)])
    }

    pub(super) fn mirrored(&self, normal: usize) -> Self {
        let normal = normal.min(2);
        let mut ranges = self.ranges;
        for (axis, range) in ranges.iter_mut().enumerate() {
            if axis != normal {
                *range = range.reversed();
            }
        }
        Self { ranges, ..*self }
    }
}
