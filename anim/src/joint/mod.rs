//! Joint limits: the physical range of motion of an elbow, a shoulder, a neck, which the article about the first
//! Dragonfly lists among the properties of a joint.
//!
//! A limit applies to a bone's rotation *relative to its rest pose*, in the rest axes of the bone:
//!
//! ```text
//! turn     = rest⁻¹ * rotation              rotation and rest in the parent's space
//! clamped  = rest * nearest allowed(turn)
//! ```
//!
//! | limit | turns about | for |
//! |---|---|---|
//! | [`Hinge`] | one axis | elbow, knee, finger |
//! | [`Ball`] | swing within an elliptic cone, twist about the bone | shoulder, hip, neck |
//! | [`Euler`] | three axes one after the other | rigs that are described in Euler angles |
//!
//! # Common rules
//!
//! * [`JointLimit::clamp`] is total: any input gives a rotation of unit length, and it never panics.
//! * A rotation within [`SLACK`] of an allowed one counts as allowed and is returned bit for bit. So clamping twice is
//!   clamping once, bit for bit: the result is within rounding of the border.
//! * A range whose `max` is below its `min` allows only its middle; one with an end that is not finite does not
//!   limit. An axis without direction cannot limit either: the limit allows everything.
//! * Limits affect rotations alone. The scale of the bone, mirrored or not, has no influence, nor have the bones above.
//!   For a limb on the other side of the body use [`JointLimit::mirrored`].

mod axis;
mod ball;
mod ellipse;
mod euler;
mod hinge;
mod limits;
mod range;

pub use ball::Ball;
pub(crate) use ball::rotation_vector;
pub use euler::{Euler, EulerOrder};
pub use hinge::Hinge;
pub use limits::{JointLimits, LimitReport};
pub use range::AngleRange;

use crate::sample::Value;
use glam::{DQuat, Quat};

/// Tolerance in radians (about 0.0006°, or 0.01 mm at the end of a bone of 1 m): a rotation nearer to an allowed one
/// than this is allowed.
///
/// A `f32` quaternion is accurate to about 2e-7 rad. Where two of a limit's turns have nearly the same axis, their
/// angles are less accurate, by a factor of up to 30 at the largest angles that limits allow: 88° for the second Euler
/// angle, 175° for the swing of a ball joint.
pub const SLACK: f32 = 1e-5;

/// The range of motion of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointLimit {
    /// About one axis only.
    Hinge(Hinge),
    /// Swing and twist.
    Ball(Ball),
    /// Three angles.
    Euler(Euler),
}

/// An allowed rotation, and its distance from the given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clamped {
    /// The allowed rotation, in the parent's space, of unit length.
    pub rotation: Quat,
    /// The angle between the given rotation and `rotation`: radians, 0..=π; exactly 0 where it was allowed.
    pub by: f32,
}

impl JointLimit {
    /// Returns the allowed rotation for `rotation`, both in the parent's space; `rest` is the bone's rest rotation.
    ///
    /// Each kind of limit documents which allowed rotation it chooses. A `rest` that is not finite counts as the
    /// identity, a `rotation` that is not finite as `rest`; other lengths than 1 are normalized.
    pub fn clamp(&self, rotation: Quat, rest: Quat) -> Clamped {
        let rest = rest.healed(Quat::IDENTITY);
        let rotation = rotation.healed(rest);
        // In f64, so that only the result is rounded significantly.
        let (exact_rest, exact) = (rest.as_dquat().normalize(), rotation.as_dquat().normalize());
        let turn = exact_rest.conjugate() * exact;
        let turn = if turn.w < 0.0 { -turn } else { turn };
        let allowed = match self {
            Self::Hinge(hinge) => hinge.allowed(turn),
            Self::Ball(ball) => ball.allowed(turn),
            Self::Euler(euler) => euler.allowed(turn),
        };
        let by = angle_between(turn, allowed);
        if !allowed.is_finite() || by <= f64::from(SLACK) {
            return Clamped { rotation, by: 0.0 };
        }
        let clamped = (exact_rest * allowed).normalize();
        // In the hemisphere of the given rotation, so that nothing flips where the joint reaches its limit.
        let clamped = if clamped.dot(exact) < 0.0 { -clamped } else { clamped };
        Clamped { rotation: clamped.as_quat(), by: by as f32 }
    }

    /// Returns the limit of the same joint on the other side: mirrored at the plane through the joint whose normal is
    /// the x, y or z axis of the bone's rest pose.
    ///
    /// Correct where the rest axes of the two bones are mirror images of each other in the same way. `axis` 0 is x, 1
    /// y, any other z.
    pub fn mirrored(&self, axis: usize) -> Self {
        match self {
            Self::Hinge(hinge) => Self::Hinge(hinge.mirrored(axis)),
            Self::Ball(ball) => Self::Ball(ball.mirrored(axis)),
            Self::Euler(euler) => Self::Euler(euler.mirrored(axis)),
        }
    }
}

/// Returns the smallest angle between two rotations, radians: 0..=π.
fn angle_between(a: DQuat, b: DQuat) -> f64 {
    let (near, far) = ((a - b).length(), (a + b).length());
    4.0 * libm::atan2(near.min(far), near.max(far))
}
