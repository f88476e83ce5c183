//! Options and results of writing a saved file.

use dragonfly_store::{
    FileSaveError as DiskError, FileStamp, RealFiles, SaveOptions, SaveOutcome, Versions, Vfs,
};
use std::path::{Path, PathBuf};
use thiserror::Error;

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
}

impl From<String> for SaveFailure {
    fn from(reason: String) -> Self {
        Self::Other(reason)
    }
}
