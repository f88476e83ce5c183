//! How far joints can turn: the physical range of motion of an elbow, a shoulder, a neck, which the article of the first
//! Dragonfly lists among what a joint has.
//!
//! A limit is about a bone's rotation *relative to its rest pose*, in the axes of the bone as it rests:
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
//! | [`Euler`] | three axes one after the other | rigs that are described so |
//!
//! # Rules that hold everywhere
//!
//! * [`JointLimit::clamp`] is total: any input gives a rotation of unit length, and it never panics.
//! * A rotation within [`SLACK`] of an allowed one counts as allowed and is returned bit for bit. So clamping twice is
//!   clamping once, bit for bit: what comes out lies within rounding of the border.
//! * A range whose ends are the wrong way round allows only its middle; one with an end that is not finite does not
//!   limit. An axis without direction cannot limit either: the limit allows everything.
//! * Limits are about rotations alone. The scale of the bone, mirrored or not, has no say, nor have the bones above.
//!   A limb on the other side of the body wants [`JointLimit::mirrored`].

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
use glam::{DQuat, Quat, Vec3};

/// Radians (about 0.0006°, or 0.01 mm at the end of a bone of 1 m): nearer to an allowed rotation than this is allowed.
///
/// A `f32` quaternion is right to about 2e-7 rad. Where two angles of a limit turn about nearly the same line, they are
/// known less well by 1 / cos of the angle between; the limits end where that makes 30-fold.
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

/// An allowed rotation, and how far it is from what was asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clamped {
    /// In the parent's space, unit length.
    pub rotation: Quat,
    /// The angle between what was given and `rotation`: radians, 0..=π; exactly 0 where it was allowed.
    pub by: f32,
}

impl JointLimit {
    /// The allowed rotation for `rotation`, both in the parent's space; `rest` is the bone's rest rotation.
    ///
    /// Each kind of limit says which allowed rotation it takes. A `rest` that is not finite counts as the identity, a
    /// `rotation` that is not finite as `rest`; other lengths than 1 are normalised.
    pub fn clamp(&self, rotation: Quat, rest: Quat) -> Clamped {
        let rest = rest.healed(Quat::IDENTITY);
        let rotation = rotation.healed(rest);
        // In f64, so that the only rounding that counts is that of the result.
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
        // In the hemisphere of what was given, so that nothing flips where the joint reaches its limit.
        let clamped = if clamped.dot(exact) < 0.0 { -clamped } else { clamped };
        Clamped { rotation: clamped.as_quat(), by: by as f32 }
    }

    /// The limit of the same joint on the other side: mirrored at the plane through the joint whose normal is the x, y or
    /// z axis of the bone's rest.
    ///
    /// Right where the rest axes of the two bones are mirror images of each other in the same way. `axis` 0 is x, 1 y, any
    /// other z.
    pub fn mirrored(&self, axis: usize) -> Self {
        match self {
            Self::Hinge(hinge) => Self::Hinge(hinge.mirrored(axis)),
            Self::Ball(ball) => Self::Ball(ball.mirrored(axis)),
            Self::Euler(euler) => Self::Euler(euler.mirrored(axis)),
        }
    }
}

/// The smallest angle between two rotations, radians: 0..=π.
fn angle_between(a: DQuat, b: DQuat) -> f64 {
    let (near, far) = ((a - b).length(), (a + b).length());
    4.0 * near.min(far).atan2(near.max(far))
}

/// An axis of turning seen in a mirror: what lies in the plane turns round, what stands on it stays.
fn mirrored_axis(axis: Vec3, normal: usize) -> Vec3 {
    match normal {
        0 => Vec3::new(axis.x, -axis.y, -axis.z),
        1 => Vec3::new(-axis.x, axis.y, -axis.z),
        _ => Vec3::new(-axis.x, -axis.y, axis.z),
    }
}

/// `axis` with length 1, in f64; `None` where it has no direction.
fn direction(axis: Vec3) -> Option<glam::DVec3> {
    axis.as_dvec3().try_normalize()
}
