//! Joint limits as three Euler angles, each with a range.

use super::AngleRange;
use glam::{DQuat, EulerRot};

/// Largest second angle in radians: 88°. At 90° the first and the third turn have the same axis.
const MOST: f64 = 88.0 / 180.0 * std::f64::consts::PI;

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

    /// Returns the same order as a type of `glam`.
    pub fn of_glam(self) -> EulerRot {
        match self {
            Self::Xyz => EulerRot::XYZ,
            Self::Xzy => EulerRot::XZY,
            Self::Yxz => EulerRot::YXZ,
            Self::Yzx => EulerRot::YZX,
            Self::Zxy => EulerRot::ZXY,
            Self::Zyx => EulerRot::ZYX,
        }
    }
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
        let (a, b, c) = turn.to_euler(self.order.of_glam());
        let (a, b, c) = (first.clamp(a), second.clamp_within(MOST, b), third.clamp(c));
        DQuat::from_euler(self.order.of_glam(), a, b, c)
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
