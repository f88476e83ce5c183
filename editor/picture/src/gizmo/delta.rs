//! The change that a drag of a gizmo makes.

use glam::DVec3;

/// What is done to all bones, along the axes of a gizmo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GizmoDelta {
    /// Scene units along each axis.
    Move(DVec3),
    /// Radians about a unit axis, beyond a turn too.
    Rotate {
        /// Unit length.
        axis: DVec3,
        /// Radians.
        angle: f64,
    },
    /// Factors along each axis.
    Scale(DVec3),
}

impl GizmoDelta {
    /// Does it change nothing?
    pub fn is_identity(&self) -> bool {
        match self {
            Self::Move(by) => *by == DVec3::ZERO,
            Self::Rotate { angle, .. } => *angle == 0.0,
            Self::Scale(by) => *by == DVec3::ONE,
        }
    }
}
