//! A joint with one axis.

use super::AngleRange;
use super::axis::{direction, mirrored_axis};
use crate::trig::rotation_about;
use glam::{DQuat, Vec3};

/// A joint that turns about one axis, from one angle to another: an elbow, a knee.
///
/// ```text
/// angle   = 2 * atan2(xyz · axis, w)        the twist of the turn about the axis
/// allowed = turn about axis by the nearest angle of the range
/// ```
///
/// The part of the turn that moves the axis itself is removed. A turn of 180° about a line across the axis has no angle
/// about it: it counts as 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hinge {
    /// Axis in the bone's rest axes; any length but 0.
    pub axis: Vec3,
    /// Angles relative to the rest pose, right-handed about `axis`.
    pub range: AngleRange,
}

impl Hinge {
    pub(super) fn allowed(&self, turn: DQuat) -> DQuat {
        let Some(axis) = direction(self.axis) else { return turn };
        let angle = 2.0 * libm::atan2(turn.xyz().dot(axis), turn.w);
        rotation_about(axis, self.range.clamp(angle))
    }

    pub(super) fn mirrored(&self, normal: usize) -> Self {
        Self { axis: mirrored_axis(self.axis, normal), ..*self }
    }
}
