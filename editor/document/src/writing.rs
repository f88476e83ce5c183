//! Options and results of writing a saved file.

use dragonfly_store::{
    FileSaveError as DiskError, FileStamp, RealFiles, SaveOptions, SaveOutcome, Versions, Vfs,
};
use std::fmt;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Number of files that were written before a save failed of which a message names each.
const NAMED: usize = 5;

/// The files that a save may overwrite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Overwrite {
    /// The file, if it is unchanged since it was last read or saved.
    AsRead,
    /// No file.
    Nothing,
    /// Any file: the user has decided.
    Anything,
}

/// Options of a save.
pub(super) struct Writing<'a> {
    /// The file system.
    pub(super) disk: &'a dyn Vfs,
    pub(super) overwrite: Overwrite,
    /// Files that the document has not read, and that are replaced whatever they contain: the user has decided.
    pub(super) replaces: &'a [PathBuf],
    /// The folder for old versions of the file.
    pub(super) versions: Option<&'a Versions>,
    /// Whether the written file becomes the file of the document.
    pub(super) becomes: bool,
    /// Whether the files are in another folder than the document.
    pub(super) is_elsewhere: bool,
    /// Called after each file that is copied into that folder, with the number of copies and the fraction of their bytes so far.
    pub(super) copied: &'a dyn Fn(usize, f32),
}

/// The files that a save has written.
#[derive(Debug, Default)]
pub(super) struct FilesSaved {
    /// Their paths, the file itself last where it was written.
    pub(super) files: Vec<PathBuf>,
    /// Size of the file itself.
    pub(super) bytes: usize,
    /// Attributes of the old file that were lost, one sentence each.
    pub(super) notices: Vec<String>,
}

/// The reason why nothing was saved.
#[derive(Debug, Error)]
pub(super) enum SaveFailure {
    /// Another program changed the file.
    #[error("{}: another program changed this file; it was not overwritten", .0.display())]
    Changed(PathBuf),
    /// A file of this name exists already.
    #[error("{}: a file of this name exists already; it was not overwritten", .0.display())]
    Exists(PathBuf),
    /// It was cancelled. Contains the files that were written before and stay.
    #[error("the save was cancelled{}", StayingFiles(.0))]
    Cancelled(Vec<PathBuf>),
    /// Any other failure.
    #[error("{0}")]
    Other(String),
}

/// A file that was not saved.
pub(super) struct UnsavedFile {
    /// The reason.
    pub(super) reason: SaveFailure,
    /// Its path, links resolved, and its stamp, where it has the new bytes although the disk did not confirm them. The next save must not
    /// take them for those of another program.
    pub(super) own: Option<(PathBuf, FileStamp)>,
}

/// Saves a file.
pub(super) fn save_file(
    disk: &dyn Vfs,
    path: &Path,
    bytes: &[u8],
    options: &SaveOptions<'_>,
) -> Result<SaveOutcome, UnsavedFile> {
    dragonfly_store::save(disk, path, bytes, options).map_err(|error| {
        let stamp = match &error {
            DiskError::Unconfirmed { path, .. } => path.canonicalize().ok().and_then(|path| {
                let stamp = FileStamp::take(&RealFiles, &path).ok().filter(|stamp| stamp.is_of(bytes))?;
                Some((path, stamp))
            }),
            _ => None,
        };
        UnsavedFile { reason: SaveFailure::of(error), own: stamp }
    })
}

impl From<String> for UnsavedFile {
    fn from(reason: String) -> Self {
        Self { reason: SaveFailure::Other(reason), own: None }
    }
}

impl SaveFailure {
    pub(super) fn of(error: DiskError) -> Self {
        match error {
            DiskError::Changed { path } => Self::Changed(path),
            DiskError::Exists { path } => Self::Exists(path),
            other => Self::Other(other.to_string()),
        }
    }

    /// Returns the failure to write a file next to the main one into another folder. Where that file exists or changed, the failure is `reason`:
    /// the questions to the user are about the main one.
    pub(super) fn of_copy(self, reason: String) -> Self {
        match self {
            Self::Changed(_) | Self::Exists(_) => Self::Other(reason),
            other @ (Self::Cancelled(_) | Self::Other(_)) => other,
        }
    }

    /// Adds the files in another folder that were written before and stay.
    pub(super) fn with_staying(self, files: Vec<PathBuf>) -> Self {
        if files.is_empty() {
            return self;
        }
        match self {
            Self::Cancelled(_) => Self::Cancelled(files),
            other @ (Self::Changed(_) | Self::Exists(_) | Self::Other(_)) => {
                Self::Other(format!("{other}{}", StayingFiles(&files)))
            }
        }
    }
}

/// The end of a sentence about a save that failed: the files that it wrote before and that stay.
pub struct StayingFiles<'a>(pub &'a [PathBuf]);

impl fmt::Display for StayingFiles<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let more = self.0.len().saturating_sub(NAMED);
        for (index, path) in self.0.iter().take(NAMED).enumerate() {
            let before = if index == 0 { "; files that were written before stay: " } else { ", " };
            write!(out, "{before}{}", path.display())?;
        }
        match more {
            0 => Ok(()),
            1 => write!(out, " and one more file"),
            more => write!(out, " and {more} more files"),
        }
    }
}

impl From<String> for SaveFailure {
    fn from(reason: String) -> Self {
        Self::Other(reason)
    }
}
