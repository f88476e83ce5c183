//! What a solver says when it is done, and when it cannot begin.

use crate::data::BoneIndex;

/// How near a solver came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Distance that is left between the end and the target at full weight, in units of to-root space; not negative.
    pub distance: f32,
    /// Sweeps over the bones that were made; 1 for a solver that needs no repetition.
    pub iterations: u32,
}

/// Why a solver did nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum IkError {
    /// The bone is not in the skeleton, or there is no pose or matrix for it.
    #[error("bone {bone} is not in the skeleton or has no pose")]
    NoSuchBone {
        /// The index that was given.
        bone: BoneIndex,
    },
    /// The second bone does not lie below the first.
    #[error("bone {below} is no descendant of bone {above}")]
    NotBelow {
        /// The bone that should be the ancestor.
        above: BoneIndex,
        /// The bone that should be the descendant.
        below: BoneIndex,
    },
    /// A target, a direction or a pose is NaN or infinite, or so large that the result would be.
    #[error("a target, a direction or a pose at bone {bone} is not a finite number")]
    NotFinite {
        /// The first bone of the solve.
        bone: BoneIndex,
    },
    /// A scale of zero above the bone: its space has no volume, and nothing can be carried into it.
    #[error("the space in which bone {bone} turns is flat: a scale above it is zero")]
    Flat {
        /// The bone that would have to turn.
        bone: BoneIndex,
    },
}
