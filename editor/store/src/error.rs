//! Why something was not written, in words for a person.

use std::io;
use std::path::{Path, PathBuf};

/// What was being done when the system said no.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Finding out what is there.
    Look,
    /// Making the new file beside the old one.
    Create,
    /// Giving the new file the owner, permissions and attributes of the old one.
    Attributes,
    /// Writing.
    Write,
    /// Bringing it to the disk.
    Sync,
    /// Keeping the old version where it must be kept.
    Keep,
    /// Putting the new file in the place of the old one.
    Replace,
}

impl Step {
    fn says(self) -> &'static str {
        match self {
            Self::Look => "cannot be looked at",
            Self::Create => "cannot be written",
            Self::Attributes => {
                "cannot be written with the owner, permissions and attributes of the old file"
            }
            Self::Write => "cannot be written",
            Self::Sync => "could not be brought to the disk",
            Self::Keep => "cannot be written, because its old version cannot be kept",
            Self::Replace => "cannot be put in the place of the old file",
        }
    }
}

/// Why a file was not saved. Unless said otherwise, the old file is as it was.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// Somebody else changed it.
    #[error("{path}: was changed on the disk by another program; it was not overwritten", path = .path.display())]
    Changed {
        /// The file.
        path: PathBuf,
    },
    /// It was to be a new file, and there is one.
    #[error("{path}: exists already; it was not overwritten", path = .path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// Nobody may write it, or you may not.
    #[error("{path}: is write-protected; it was not overwritten", path = .path.display())]
    Protected {
        /// The file.
        path: PathBuf,
    },
    /// A folder, pipe, device or socket.
    #[error("{path}: is not a regular file", path = .path.display())]
    NotRegular {
        /// What was found.
        path: PathBuf,
    },
    /// The path ends with no name, or leads round in a circle of links.
    #[error("{path}: is no name of a file", path = .path.display())]
    NoName {
        /// The path.
        path: PathBuf,
    },
    /// The system said no.
    #[error("{path}: {}: {}", .step.says(), reason(.error), path = .path.display())]
    Io {
        /// What was to be written.
        path: PathBuf,
        /// What was being done.
        step: Step,
        /// What the system said.
        #[source]
        error: io::Error,
    },
    /// The new file is there, whole, but after a power cut it may be the old one: it does not count as saved.
    #[error("{path}: was written, but the disk did not confirm it: {}; save again", reason(.error),
        path = .path.display())]
    Unconfirmed {
        /// The file.
        path: PathBuf,
        /// What the system said.
        #[source]
        error: io::Error,
    },
    /// A file with several names was to be overwritten in place, and that could neither be finished nor undone.
    #[error("{path}: may be damaged: {}; its old content is whole in {old}", reason(.error),
        path = .path.display(), old = .old.display())]
    Torn {
        /// The file.
        path: PathBuf,
        /// Its old content.
        old: PathBuf,
        /// What the system said.
        #[source]
        error: io::Error,
    },
    /// An earlier save of a file with several names was cut off.
    #[error("{path}: an earlier save was cut off; the content of before is in {old}: put it back or away first",
        path = .path.display(), old = .old.display())]
    CutOff {
        /// The file.
        path: PathBuf,
        /// Its content before that save.
        old: PathBuf,
    },
}

impl SaveError {
    /// For `map_err`.
    pub(super) fn at(path: &Path, step: Step) -> impl FnOnce(io::Error) -> Self + use<> {
        let path = path.to_path_buf();
        move |error| Self::Io { path, step, error }
    }
}

/// The system's reason in plain words.
pub(super) fn reason(error: &io::Error) -> String {
    use io::ErrorKind::{
        IsADirectory, NotADirectory, NotFound, PermissionDenied, QuotaExceeded, ReadOnlyFilesystem,
        StorageFull,
    };
    let plain = match error.kind() {
        StorageFull => "the disk is full",
        QuotaExceeded => "your share of the disk is used up",
        ReadOnlyFilesystem => "the disk is read-only",
        PermissionDenied => "no permission",
        NotFound => "it or its folder is not there",
        NotADirectory => "a part of its path is no folder",
        IsADirectory => "is a folder",
        _ => return error.to_string(),
    };
    plain.to_owned()
}
