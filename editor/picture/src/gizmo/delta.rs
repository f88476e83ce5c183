//! The change that dragging a gizmo makes.

use glam::DVec3;

/// A change applied to all targets, along the axes of a gizmo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GizmoDelta {
    /// Movement along each axis, scene units.
    Move(DVec3),
    /// Rotation about a unit axis; may exceed a full turn.
    Rotate {
        /// Axis, unit length.
        axis: DVec3,
        /// Angle, radians.
        angle: f64,
    },
    /// Scale factors along each axis.
    Scale(DVec3),
}

impl GizmoDelta {
    /// Returns whether the change has no effect.
    pub fn is_identity(&self) -> bool {
        match self {
            Self::Move(by) => *by == DVec3::ZERO,
            Self::Rotate { angle, .. } => *angle == 0.0,
            Self::Scale(by) => *by == DVec3::ONE,
        }
    }
}
