//! The file that a path means: links followed, with the conditions for overwriting it, and its name in the autosave
//! folder.

use super::error::{FileSaveError, SaveStep};
use super::stamp::{FileStamp, FileState, hash};
use super::vfs::{FileData, FileKind, Vfs, folder_of, metadata_if_exists, retry};
use std::io;
use std::path::{Path, PathBuf};

/// Condition on the existing file, checked before it is overwritten.
#[derive(Clone, Copy, Debug, Default)]
pub enum ExpectedFile<'a> {
    /// No condition: the user confirmed, or the file belongs to the program.
    #[default]
    Anything,
    /// There is no file.
    Nothing,
    /// The file still has this stamp, or is gone: then no one's work is overwritten.
    Stamp(&'a FileStamp),
}

/// Longest chain of links that is followed.
const MOST_LINKS: usize = 40;

/// Returns the path of the file after following links. The file need not exist, its folder must.
pub(super) fn resolved(files: &dyn Vfs, path: &Path) -> Result<PathBuf, FileSaveError> {
    let no_name = || FileSaveError::NoName { path: path.to_path_buf() };
    let mut at = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        let name = at.file_name().ok_or_else(no_name)?.to_owned();
        let folder =
            retry(|| files.resolve(folder_of(&at))).map_err(FileSaveError::at(path, SaveStep::Create))?;
        at = folder.join(name);
        let found = metadata_if_exists(files, &at).map_err(FileSaveError::at(path, SaveStep::Look))?;
        if found.is_none_or(|data| data.kind != FileKind::Link) {
            return Ok(at);
        }
        let points = retry(|| files.read_link(&at)).map_err(FileSaveError::at(path, SaveStep::Look))?;
        at = folder.join(points);
    }
    Err(no_name())
}

/// Returns the metadata of the existing file, which must be a regular one.
pub(super) fn regular(files: &dyn Vfs, target: &Path) -> Result<Option<FileData>, FileSaveError> {
    let old = metadata_if_exists(files, target).map_err(FileSaveError::at(target, SaveStep::Look))?;
    match old {
        Some(data) if data.kind != FileKind::File => {
            Err(FileSaveError::NotRegular { path: target.to_path_buf() })
        }
        other => Ok(other),
    }
}

/// Returns an error for a write-protected file. Permission to write the folder is enough to replace any file in it,
/// but protecting a file, as version control systems do, is meant to protect its content.
pub(super) fn ensure_writable(files: &dyn Vfs, target: &Path, old: &FileData) -> Result<(), FileSaveError> {
    let denied = |error: &io::Error| error.kind() == io::ErrorKind::PermissionDenied;
    let nobody = old.mode & 0o222 == 0;
    if nobody || retry(|| files.open_to_write(target)).is_err_and(|error| denied(&error)) {
        return Err(FileSaveError::Protected { path: target.to_path_buf() });
    }
    Ok(())
}

/// Checks the condition on the existing file.
pub(super) fn check_expected(
    files: &dyn Vfs,
    target: &Path,
    expected: ExpectedFile<'_>,
) -> Result<(), FileSaveError> {
    let path = || target.to_path_buf();
    match expected {
        ExpectedFile::Anything => Ok(()),
        ExpectedFile::Nothing => {
            match metadata_if_exists(files, target).map_err(FileSaveError::at(target, SaveStep::Look))? {
                None => Ok(()),
                Some(_) => Err(FileSaveError::Exists { path: path() }),
            }
        }
        ExpectedFile::Stamp(stamp) => {
            match stamp.state(files, target).map_err(FileSaveError::at(target, SaveStep::Look))? {
                FileState::Same | FileState::Missing => Ok(()),
                FileState::Changed => Err(FileSaveError::Changed { path: path() }),
            }
        }
    }
}

/// Resolves the links in `path`, so that two paths of one file name one document. Returns `path` unchanged if it
/// cannot be resolved.
pub(super) fn canonical(files: &dyn Vfs, path: &Path) -> PathBuf {
    resolved(files, path).or_else(|_| std::path::absolute(path)).unwrap_or_else(|_| path.to_path_buf())
}

/// Name used in the autosave folder for the document at `path`: the readable start of its file name, and a hash that
/// makes it unique.
pub(super) fn key(files: &dyn Vfs, path: &Path) -> String {
    let path = canonical(files, path);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let plain = |letter: char| if letter.is_alphanumeric() { letter } else { '_' };
    let stem: String = stem.chars().take(32).map(plain).collect();
    format!("{stem}-{:016x}", hash(path.as_os_str().as_encoded_bytes()))
}
