//! Errors of writing a file, in words for the user.

use std::io;
use std::path::{Path, PathBuf};

/// Step of a save during which the system reported an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SaveStep {
    /// Reading the metadata of the existing file.
    Look,
    /// Creating the new file next to the old one.
    Create,
    /// Copying the owner, permissions and attributes of the old file to the new one.
    Attributes,
    /// Writing the bytes.
    Write,
    /// Flushing the bytes to the disk.
    Sync,
    /// Keeping or removing the copy of the old content of a file that is overwritten in place.
    Keep,
    /// Renaming the new file over the old one.
    Replace,
}

impl SaveStep {
    fn failure(self) -> &'static str {
        match self {
            Self::Look => "cannot be examined",
            Self::Create => "cannot be written",
            Self::Attributes => {
                "cannot be written with the owner, permissions and attributes of the old file"
            }
            Self::Write => "cannot be written",
            Self::Sync => "could not be flushed to the disk",
            Self::Keep => "cannot be written, because its old version cannot be kept",
            Self::Replace => "cannot replace the old file",
        }
    }
}

/// Reasons why a file was not saved. Unless stated otherwise, the old file is unchanged.
#[derive(Debug, thiserror::Error)]
pub enum FileSaveError {
    /// Another program changed the file.
    #[error("{path} was changed on the disk by another program; it was not overwritten", path = .path.display())]
    Changed {
        /// The file.
        path: PathBuf,
    },
    /// A new file was expected, but there is one already.
    #[error("{path} exists already; it was not overwritten", path = .path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The file is read-only, or the user has no permission to write it.
    #[error("{path} is write-protected; it was not overwritten", path = .path.display())]
    Protected {
        /// The file.
        path: PathBuf,
    },
    /// A folder, pipe, device or socket.
    #[error("{path} is not a regular file", path = .path.display())]
    NotRegular {
        /// Path of the folder, pipe, device or socket.
        path: PathBuf,
    },
    /// The path does not end in a file name, or its links form a circle.
    #[error("{path} is not the name of a file", path = .path.display())]
    NoName {
        /// The path.
        path: PathBuf,
    },
    /// The system reported an error.
    #[error("{path}: {}: {}", .step.failure(), reason(.error), path = .path.display())]
    Io {
        /// The file to be written.
        path: PathBuf,
        /// The step that failed.
        step: SaveStep,
        /// Error of the system.
        #[source]
        error: io::Error,
    },
    /// The new file is complete, but after a power cut the old one may be back, so it does not count as saved.
    #[error("{path}: was written, but the disk did not confirm it: {}; save again", reason(.error),
        path = .path.display())]
    Unconfirmed {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        #[source]
        error: io::Error,
    },
    /// A file with several names was to be overwritten in place, and that could neither be finished nor undone.
    #[error("{path}: may be damaged: {}; its complete old content is in {old}", reason(.error),
        path = .path.display(), old = .old.display())]
    Torn {
        /// The file.
        path: PathBuf,
        /// Its old content.
        old: PathBuf,
        /// Error of the system.
        #[source]
        error: io::Error,
    },
    /// An earlier save of a file with several names was interrupted.
    #[error("{path}: an earlier save was interrupted; the content before it is in {old}: restore or discard it first",
        path = .path.display(), old = .old.display())]
    Interrupted {
        /// The file.
        path: PathBuf,
        /// Its content before that save.
        old: PathBuf,
    },
}

impl FileSaveError {
    /// Returns a closure for `map_err`.
    pub(super) fn at(path: &Path, step: SaveStep) -> impl FnOnce(io::Error) -> Self + use<> {
        let path = path.to_path_buf();
        move |error| Self::Io { path, step, error }
    }
}

/// Returns the reason of a system error in plain words.
pub(super) fn reason(error: &io::Error) -> String {
    use io::ErrorKind::{
        IsADirectory, NotADirectory, NotFound, PermissionDenied, QuotaExceeded, ReadOnlyFilesystem,
        StorageFull,
    };
    let plain = match error.kind() {
        StorageFull => "the disk is full",
        QuotaExceeded => "your disk quota is used up",
        ReadOnlyFilesystem => "the disk is read-only",
        PermissionDenied => "no permission",
        NotFound => "it or its folder does not exist",
        NotADirectory => "a part of its path is not a folder",
        IsADirectory => "it is a folder",
        _ => return error.to_string(),
    };
    plain.to_owned()
}
