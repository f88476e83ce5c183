//! What goes wrong when a take is compressed, and when compressed bytes are read.

use thiserror::Error;

/// Why a take could not be compressed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CompressError {
    /// More bones, keys or bytes than a compressed take may have.
    #[error("too many {what}: {count}, at most {limit}")]
    TooLarge {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        count: u64,
        /// How many there may be.
        limit: u64,
    },
    /// Single precision cannot hold the error that was asked for: numbers too large for the tolerance.
    #[error("bone {bone} at {time} s is off by {reached}, which is more than the tolerance of {tolerance}")]
    OutOfReach {
        /// The bone.
        bone: usize,
        /// Seconds.
        time: f32,
        /// The tolerance of the bone.
        tolerance: f32,
        /// The best that was reached; not finite where to-root poses are not.
        reached: f32,
    },
}

/// Why bytes are no compressed take.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("byte {offset}: {reason}")]
pub struct FormatError {
    /// Offset from the first byte.
    pub offset: usize,
    /// What is wrong there, with the numbers.
    pub reason: String,
}

impl FormatError {
    pub(super) fn new(offset: usize, reason: impl Into<String>) -> Self {
        Self { offset, reason: reason.into() }
    }
}
