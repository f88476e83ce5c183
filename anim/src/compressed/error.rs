//! Errors of compressing a take and of reading compressed bytes.

use thiserror::Error;

/// Reasons why a take cannot be compressed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CompressError {
    /// More bones, keys or bytes than a compressed take can contain.
    #[error("too many {what}: {count}, at most {limit}")]
    TooLarge {
        /// The counted items.
        what: &'static str,
        /// The count.
        count: u64,
        /// The largest allowed count.
        limit: u64,
    },
    /// Single precision cannot keep the requested tolerance: the numbers are too large for it.
    #[error("bone {bone} at {time} s is off by {reached}, which is more than the tolerance of {tolerance}")]
    OutOfReach {
        /// The bone.
        bone: usize,
        /// Time of the error in seconds.
        time: f32,
        /// The tolerance of the bone.
        tolerance: f32,
        /// The smallest error reached; not finite where to-root poses are not.
        reached: f32,
    },
}

/// Error for bytes that are not a compressed take.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("byte {offset}: {reason}")]
pub struct FormatError {
    /// Offset from the first byte.
    pub offset: usize,
    /// Description of the problem, with the numbers.
    pub reason: String,
}

impl FormatError {
    pub(super) fn new(offset: usize, reason: impl Into<String>) -> Self {
        Self { offset, reason: reason.into() }
    }
}
