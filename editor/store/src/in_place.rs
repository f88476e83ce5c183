//! Overwriting files with several names (hard links) in place, so that all names keep leading to the same file.
//!
//! First the old content is copied next to the file and flushed to the disk; only then is the file changed. When the
//! new bytes cannot be written, the old ones are restored. When the machine stops in between, the copy remains: the
//! file is not saved again until the user has chosen what to do with the copy, and nothing is restored without being
//! asked. Other programs may briefly see a half-written file; that is the price of keeping its names.

use super::error::{FileSaveError, SaveStep};
use super::stamp::{FileStamp, hash};
use super::target::{ExpectedFile, check_expected, resolved};
use super::temporary::create_temporary;
use super::vfs::{Vfs, VfsFile, copy, folder_of, metadata_if_exists, retry, write_all};
use std::io;
use std::path::{Path, PathBuf};

/// Path of the copy of the old content while a file is overwritten.
fn old_content_path(target: &Path) -> PathBuf {
    let name = target.file_name().unwrap_or_default();
    let mut old = std::ffi::OsString::from(".");
    if name.len() < 200 {
        old.push(name);
    } else {
        old.push(format!("{:016x}", hash(name.as_encoded_bytes())));
    }
    old.push(".dragonfly-old");
    target.with_file_name(old)
}

/// Returns the path of the old content if overwriting the file at `target` was interrupted. Links are followed.
///
/// # Errors
/// When the folder cannot be examined.
pub fn interrupted_save(files: &dyn Vfs, target: &Path) -> Result<Option<PathBuf>, FileSaveError> {
    let target = resolved(files, target)?;
    let old = old_content_path(&target);
    Ok(metadata_if_exists(files, &old).map_err(FileSaveError::at(&target, SaveStep::Look))?.map(|_| old))
}

/// Returns an error if an earlier save of the file at `target` was interrupted; see [`interrupted_save`].
pub(super) fn ensure_not_interrupted(files: &dyn Vfs, target: &Path) -> Result<(), FileSaveError> {
    let old = old_content_path(target);
    match metadata_if_exists(files, &old).map_err(FileSaveError::at(target, SaveStep::Look))? {
        None => Ok(()),
        Some(_) => Err(FileSaveError::Interrupted { path: target.to_path_buf(), old }),
    }
}

/// Restores the old content after an interrupted save, when the user chose so.
///
/// # Errors
/// When the content cannot be restored; the copy is kept.
pub fn restore_old_content(files: &dyn Vfs, target: &Path) -> Result<(), FileSaveError> {
    let target = resolved(files, target)?;
    let old = old_content_path(&target);
    back(files, &target, &old).and_then(|()| forget(files, &old)).map_err(|error| FileSaveError::Torn {
        path: target.clone(),
        old,
        error,
    })
}

/// Leaves the file as it is and deletes the old content, when the user chose so.
///
/// # Errors
/// When the copy cannot be removed.
pub fn discard_old_content(files: &dyn Vfs, target: &Path) -> Result<(), FileSaveError> {
    let target = resolved(files, target)?;
    forget(files, &old_content_path(&target)).map_err(FileSaveError::at(&target, SaveStep::Keep))
}

fn back(files: &dyn Vfs, target: &Path, old: &Path) -> io::Result<()> {
    let from = retry(|| files.open(old))?;
    // Reopened: a file handle is not used again after its sync failed.
    let to = retry(|| files.open_to_write(target))?;
    let size = copy(&*from, &*to)?;
    retry(|| to.set_size(size))?;
    retry(|| to.sync_all())
}

fn forget(files: &dyn Vfs, old: &Path) -> io::Result<()> {
    retry(|| files.remove(old))?;
    retry(|| files.sync_folder(folder_of(old)))
}

/// Writes `bytes` into the file at `target`, which has several names.
pub(super) fn overwrite(
    files: &dyn Vfs,
    target: &Path,
    bytes: &[u8],
    expected: ExpectedFile<'_>,
) -> Result<FileStamp, FileSaveError> {
    let file = retry(|| files.open_to_write(target)).map_err(FileSaveError::at(target, SaveStep::Create))?;
    let old = old_content_path(target);
    copy_old_content(files, target, &old, &*file).map_err(FileSaveError::at(target, SaveStep::Keep))?;
    if let Err(error) = check_expected(files, target, expected) {
        let _ = forget(files, &old);
        return Err(error);
    }
    let written = write_all(&*file, bytes, 0).map_err(|error| (SaveStep::Write, error)).and_then(|()| {
        retry(|| file.set_size(bytes.len() as u64)).map_err(|error| (SaveStep::Write, error))?;
        retry(|| file.sync_all()).map_err(|error| (SaveStep::Sync, error))?;
        retry(|| file.metadata()).map_err(|error| (SaveStep::Look, error))
    });
    let data = match written {
        Ok(data) => data,
        Err((step, error)) => {
            drop(file);
            return Err(match back(files, target, &old) {
                Ok(()) => {
                    let _ = forget(files, &old);
                    FileSaveError::Io { path: target.to_path_buf(), step, error }
                }
                Err(_) => FileSaveError::Torn { path: target.to_path_buf(), old, error },
            });
        }
    };
    // While the copy exists, the file counts as half-written.
    forget(files, &old).map_err(|error| {
        let _ = retry(|| files.remove(&old));
        FileSaveError::Unconfirmed { path: target.to_path_buf(), error }
    })?;
    Ok(FileStamp::of(&data, hash(bytes)))
}

/// Copies the old content to `old`, completely or not at all, and flushes it to the disk.
fn copy_old_content(files: &dyn Vfs, target: &Path, old: &Path, file: &dyn VfsFile) -> io::Result<()> {
    let (temporary, to) = create_temporary(files, target, true)?;
    let made = copy(file, &*to).and_then(|_| retry(|| to.sync_all())).and_then(|()| {
        drop(to);
        retry(|| files.rename(&temporary, old))
    });
    let gone = if made.is_ok() { old } else { &temporary };
    let made = made.and_then(|()| retry(|| files.sync_folder(folder_of(old))));
    if made.is_err() {
        let _ = retry(|| files.remove(gone));
    }
    made
}
