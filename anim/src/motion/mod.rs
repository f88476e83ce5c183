//! Root motion: the movement of a figure through the scene, extracted from a take and restored.
//!
//! Let `P(t)` be to-root of the parent of the chosen bone (usually the root or the hips), `x(t)` the bone's translation
//! and `q(t)` its rotation relative to that parent, and `p = P x` its position in to-root space. With `t₀` the start of
//! the take, `Π` the choice of axes, `c` the horizontal part of `p(t₀)` and `R` the rotation of `P`:
//!
//! ```text
//! m(t) = Π (p(t) - p(t₀))                               translation of the motion
//! Y(t) = twist about up of  R q(t) (R q(t₀))⁻¹           rotation of the motion (the identity without yaw)
//! M(t) = T(c + m(t)) · Y(t) · T(-c)                     the motion as a matrix; M(t₀) is the identity
//!
//! in place:   x' = P⁻¹ (c + Y⁻¹ (p - c - m))            q' = (R⁻¹ Y R)⁻¹ q
//! put back:   x  = P⁻¹ (c + m + Y (P x' - c))           q  =  R⁻¹ Y R     q'
//! ```
//!
//! A figure placed in the scene by the matrix `W` and drawn in place looks like the take when it is drawn with `W ·
//! M(t)`; from frame to frame `W` is multiplied by [`RootMotion::delta`]. The twist of a rotation about an axis is its
//! part about that axis: `(q·axis, w)` normalized (Dobrowolski, "Swing-twist decomposition in Clifford algebra", 2015).
//!
//! The formulas are applied key by key, so [`restore`] restores the take exactly, at keys and between them. The
//! motion's channels have their keys where the bone has its own, and its interpolation; they are plain [`Channel`]s and
//! may be edited before they are restored.

mod curve;
mod extract;
mod keys;
mod parent_space;
mod restore;
mod travel;

pub use curve::RootMotion;
pub use extract::{extract, in_place};
pub use restore::restore;
pub use travel::{
    Travel, TravelOptions, guess_hips, guess_root, move_travel, put_back, take_travel, travel_bones,
};

use crate::data::BoneIndex;
#[cfg(doc)]
use crate::data::Channel;
use glam::Vec3;

/// An axis of to-root space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Axis {
    /// (1, 0, 0)
    X,
    /// (0, 1, 0), up in glTF.
    #[default]
    Y,
    /// (0, 0, 1)
    Z,
}

impl Axis {
    /// Returns the axis as a unit vector.
    pub fn to_vec3(self) -> Vec3 {
        Vec3::AXES[self as usize]
    }
}

/// The parts of the movement to extract.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RootMotionOptions {
    /// The axis that points up.
    pub up: Axis,
    /// Whether the movement along x, y, z of to-root space is extracted. The one along `up` is the height.
    pub translation: [bool; 3],
    /// Whether the rotation about `up` is extracted.
    pub yaw: bool,
}

impl Default for RootMotionOptions {
    /// Returns options with Y up; x, z and yaw are extracted, height stays in the take.
    fn default() -> Self {
        Self { up: Axis::Y, translation: [true, false, true], yaw: true }
    }
}

/// Reasons why root motion cannot be extracted or restored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MotionError {
    /// The skeleton has no such bone.
    #[error("bone {bone} is not in the skeleton")]
    NoSuchBone {
        /// The index that was given.
        bone: BoneIndex,
    },
    /// At some key an ancestor of the bone has a scale of zero, so to-root space cannot be transformed to the space of
    /// the bone's parent.
    #[error(
        "the motion of bone {bone} cannot be computed at {milliseconds} ms: a scale of one of its ancestors is zero"
    )]
    Flat {
        /// The bone of the motion.
        bone: BoneIndex,
        /// Time in the take.
        milliseconds: i64,
    },
    /// Neither of the two bones is above the other.
    #[error(
        "travel moves only between a bone and one above it: bones {from} and {to} are in different branches"
    )]
    NotInLine {
        /// The bone that travels.
        from: BoneIndex,
        /// The bone that was to travel.
        to: BoneIndex,
    },
    /// The frame rate is not a positive number, or the take has more than a million frames.
    #[error("the motion cannot be sampled at this frame rate")]
    Rate,
}
