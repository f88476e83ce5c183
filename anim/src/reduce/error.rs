//! Errors: of a reduced take at one place, and the reasons why a take cannot be reduced.

use crate::data::BoneIndex;

/// An error at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// The bone.
    pub bone: BoneIndex,
    /// Time in seconds.
    pub time: f32,
    /// Distance in millimeters of the worst point of the bone's shell from its position in the original.
    pub millimeters: f64,
    /// Allowed distance there in millimeters: less in a contact.
    pub tolerance: f64,
}

impl Deviation {
    pub(super) fn holds(&self) -> bool {
        self.millimeters <= self.tolerance
    }
}

/// Reasons why a take cannot be reduced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReduceError {
    /// The take is too large to process in memory at once.
    #[error(
        "{frames} frames of {bones} bones are more than {limit} poses; reduce a part of the take, or use fewer frames per second"
    )]
    TooLarge {
        /// Number of key times, and frames between them.
        frames: usize,
        /// Number of bones of the skeleton.
        bones: usize,
        /// The limit, [`SAMPLES`](super::SAMPLES).
        limit: usize,
    },
}
