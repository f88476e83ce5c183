//! Errors of writing a movie, in words for the user.

use dragonfly_store::FileSaveError;
use std::io;
use std::path::PathBuf;

/// Reasons why a movie, or a frame of it, was not written.
#[derive(Debug, thiserror::Error)]
pub enum MovieError {
    /// A file could not be written; the message names it.
    #[error(transparent)]
    File(#[from] FileSaveError),
    /// The file of a movie is complete, but could not replace the old one; the message names both.
    #[error("{error}; the movie is complete in {kept}", kept = .kept.display())]
    Kept {
        /// The file of the movie.
        kept: PathBuf,
        /// Why it has not the name that it should have.
        #[source]
        error: FileSaveError,
    },
    /// The receiver of a stream took no more bytes.
    #[error("the stream of the movie ended: {0}")]
    Stream(#[source] io::Error),
    /// The settings do not fit the format.
    #[error("{format}: {reason}")]
    Settings {
        /// Title of the format.
        format: &'static str,
        /// A clause: the setting, and the values that are possible.
        reason: String,
    },
    /// The pixels of a frame are not those of the movie.
    #[error("frame {number}: {reason}")]
    Frame {
        /// Number of the frame, counted from the start of the whole movie.
        number: u64,
        /// A clause.
        reason: String,
    },
    /// A part cannot be joined.
    #[error("{path}: {reason}", path = .path.display())]
    Part {
        /// File of the part.
        path: PathBuf,
        /// A clause.
        reason: String,
    },
    /// The sound of the movie cannot be read or be part of it.
    #[error("the sound: {0}")]
    Sound(String),
    /// A movie without frames was ended.
    #[error("the movie has no frames")]
    Empty,
    /// The movie was cancelled while it was completed. The old file is unchanged.
    #[error("the movie was cancelled")]
    Cancelled,
}

impl MovieError {
    /// Returns whether the disk has no room for a file, or the file system none for larger files.
    pub(crate) fn is_out_of_room(&self) -> bool {
        let Self::File(FileSaveError::Io { error, .. }) = self else { return false };
        let kinds = [io::ErrorKind::StorageFull, io::ErrorKind::QuotaExceeded, io::ErrorKind::FileTooLarge];
        kinds.contains(&error.kind())
    }
}

/// Returns an error for a frame that an encoder refused.
pub(crate) fn refused(number: u64) -> impl FnOnce(String) -> MovieError {
    move |reason| MovieError::Frame { number, reason }
}
