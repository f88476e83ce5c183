//! How a save writes, and what came of it.

use dragonfly_store::{Journal, SaveError as DiskError, Versions};
use std::path::PathBuf;
use thiserror::Error;

/// What a save may overwrite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Overwrite {
    /// The file as it was read or saved last.
    AsRead,
    /// No file.
    Nothing,
    /// Whatever is there: the person was asked.
    Anything,
}

/// How a save writes.
pub(super) struct Writing<'a> {
    pub(super) overwrite: Overwrite,
    /// Hears of it before and after, if it is that of the file.
    pub(super) journal: Option<&'a mut Journal>,
    /// Where the old version goes.
    pub(super) versions: Option<&'a Versions>,
    /// Is what was written the file that is edited from now on?
    pub(super) becomes: bool,
}

/// What a save came to.
#[derive(Debug, Default)]
pub(super) struct FilesSaved {
    /// What was written, the file itself last.
    pub(super) files: Vec<PathBuf>,
    /// Of the file itself.
    pub(super) bytes: usize,
    /// What could not be kept of the old file.
    pub(super) notices: Vec<String>,
}

/// Why nothing was saved.
#[derive(Debug, Error)]
pub(super) enum SaveFailure {
    /// Somebody else changed it.
    #[error("{}: was changed on the disk by another program; it was not overwritten", .0.display())]
    Changed(PathBuf),
    /// It was to be a new file.
    #[error("{}: exists already; it was not overwritten", .0.display())]
    Exists(PathBuf),
    /// Anything else.
    #[error("{0}")]
    Other(String),
}

impl SaveFailure {
    pub(super) fn of(error: DiskError) -> Self {
        match error {
            DiskError::Changed { path } => Self::Changed(path),
            DiskError::Exists { path } => Self::Exists(path),
            other => Self::Other(other.to_string()),
        }
    }
}

impl From<String> for SaveFailure {
    fn from(reason: String) -> Self {
        Self::Other(reason)
    }
}
