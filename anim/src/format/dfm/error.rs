//! Errors of writing, and of the bytes of a file.

use crate::format::{ExportError, ImportError, Place};
use thiserror::Error;

/// Reason why a model could not be written. Displayed as `place: reason`, on one line.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WriteError {
    /// A part of the model breaks the invariants of its type, so that reading would not restore it.
    #[error("{place}: {}", crate::format::one_line(reason))]
    Invalid {
        /// Place in the model, such as `/meshes/0/primitives/1`.
        place: String,
        /// Description of the error, with the numbers.
        reason: String,
    },
    /// The reader refuses an index or another number of the model; its place is in the file that would have been
    /// written.
    #[error("the model cannot be read back: {0}")]
    Refused(#[from] ImportError),
    /// The file would be longer than its first four bytes can represent.
    #[error("file: {bytes} bytes, at most {}", u32::MAX)]
    TooLarge {
        /// Number of bytes of the whole file.
        bytes: u64,
    },
}

impl From<WriteError> for ExportError {
    fn from(error: WriteError) -> Self {
        Self::new(error)
    }
}

/// Returns the error of an invalid file at byte `at`.
pub(super) fn invalid(at: usize, code: &'static str, reason: String) -> ImportError {
    ImportError::Invalid { place: Place::Byte(at as u64), code, reason }
}

/// Returns the error of an invalid model at `place`.
pub(super) fn refuse(place: String, reason: String) -> WriteError {
    WriteError::Invalid { place, reason }
}
