//! Things that others hold: attached, handed over, detached.

use super::spot::StageSpot;
use crate::stage::time::StageTime;
use glam::{DQuat, DVec3};

/// Acceleration of what falls, meters per square second.
const GRAVITY: f64 = 9.81;

/// Number of attachments that may fade into each other; further ones begin at once.
pub(super) const MOST_FADES: usize = 4;

/// A position and a rotation in the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidPlace {
    /// Meters.
    pub position: DVec3,
    /// Unit length.
    pub rotation: DQuat,
}

impl RigidPlace {
    /// Returns the place that undoes this one.
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self { position: rotation * -self.position, rotation }
    }

    /// Returns this place followed by one in its own space.
    pub fn then(&self, inner: &Self) -> Self {
        Self {
            position: self.position + self.rotation * inner.position,
            rotation: (self.rotation * inner.rotation).normalize(),
        }
    }

    /// Returns the place between this one and `other`.
    pub(super) fn mixed(&self, other: &Self, weight: f64) -> Self {
        let to = if self.rotation.dot(other.rotation) < 0.0 { -other.rotation } else { other.rotation };
        let rotation = (self.rotation * (1.0 - weight) + to * weight).normalize();
        Self { position: self.position.lerp(other.position, weight), rotation }
    }
}

/// What happens to a thing.
#[derive(Clone, Copy, Debug)]
pub(super) enum HoldKind {
    /// Another thing holds it from now on.
    Attach {
        /// What holds it.
        to: StageSpot,
        /// Its place relative to that.
        grip: RigidPlace,
        /// The duration of the way there.
        fade_in: StageTime,
    },
    /// No one holds it.
    Detach {
        /// The place where it was detached; `None` until that is computed.
        from: Option<RigidPlace>,
        /// The height of the ground to which it falls, meters; `None` where it stays in the air.
        floor: Option<f64>,
    },
}

/// An `attach` or `detach`.
#[derive(Clone, Copy, Debug)]
pub(super) struct HoldCue {
    pub(super) action: usize,
    pub(super) begin: StageTime,
    pub(super) kind: HoldKind,
}

impl HoldCue {
    /// Returns whether its place is known: that of a detachment is computed in the order of time.
    pub(super) fn is_known(&self) -> bool {
        match self.kind {
            HoldKind::Attach { .. } => true,
            HoldKind::Detach { from, .. } => from.is_some(),
        }
    }

    /// Returns whether another thing, or a point, holds it from then on.
    pub(super) fn attaches(&self) -> bool {
        match self.kind {
            HoldKind::Attach { .. } => true,
            HoldKind::Detach { .. } => false,
        }
    }

    /// Returns the thing to which it attaches; `None` where it detaches, or attaches to a point.
    pub(super) fn holder(&self) -> Option<usize> {
        match self.kind {
            HoldKind::Attach { to, .. } => to.thing(),
            HoldKind::Detach { .. } => None,
        }
    }
}

/// Returns the place of what falls for `after`, from `start` to the ground at the height `floor`; what starts below does not move.
pub(super) fn fallen(start: &RigidPlace, floor: f64, after: StageTime) -> RigidPlace {
    let seconds = after.seconds();
    let height = start.position.y;
    let y = if height > floor { (height - 0.5 * GRAVITY * seconds * seconds).max(floor) } else { height };
    RigidPlace { position: DVec3::new(start.position.x, y, start.position.z), ..*start }
}
