//! Results and errors of the solvers.

use crate::data::BoneIndex;

/// Result of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Remaining distance between the end and the target at full weight, in units of to-root space; not negative.
    pub distance: f32,
    /// Number of sweeps over the bones; 1 for a solver that needs no repetition.
    pub iterations: u32,
}

/// Reasons why a solver did nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IkError {
    /// The bone is not in the skeleton, or there is no pose or matrix for it.
    #[error("bone {bone} is not in the skeleton or has no pose")]
    NoSuchBone {
        /// The index that was given.
        bone: BoneIndex,
    },
    /// The second bone is not a descendant of the first.
    #[error("bone {below} is not a descendant of bone {above}")]
    NotBelow {
        /// The expected ancestor.
        above: BoneIndex,
        /// The expected descendant.
        below: BoneIndex,
    },
    /// A target, a direction or a pose is NaN or infinite, or so large that the result would be.
    #[error("a target, a direction or a pose at bone {bone} is not finite, or too large")]
    NotFinite {
        /// The first bone of the solve.
        bone: BoneIndex,
    },
    /// A line of action has no length, or the bones point at the viewer, so that their line has none.
    #[error("the line has no length, or the bones point at the viewer")]
    NoLine,
    /// A scale of zero above the bone: its space has no volume, so nothing can be transformed into it.
    #[error("bone {bone} cannot be turned: a scale of one of its ancestors is zero")]
    Flat {
        /// The bone to turn.
        bone: BoneIndex,
    },
}
