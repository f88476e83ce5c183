//! Files with several names are overwritten where they are, so that all names go on to lead to the same file.
//!
//! First the old content is copied beside the file and brought to the disk; only then is the file touched. When the
//! new bytes cannot be written, the old ones are put back. When the machine stops in between, the copy is still
//! there: the file is not saved again before a person has said what to do with it, and nothing is put back unasked.
//! Other programs may see the file half written for a moment; that is the price of keeping its names.

use super::error::{SaveError, Step};
use super::save::{Expected, create_beside, expect};
use super::stamp::{FileStamp, hash};
use super::vfs::{Vfs, VfsFile, again, copy, folder_of, look, write_all};
use std::io;
use std::path::{Path, PathBuf};

/// Where the old content lies while a file is overwritten.
fn old_of(target: &Path) -> PathBuf {
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

/// The content of before, if overwriting the file at `target` was cut off; links are followed.
///
/// # Errors
/// When it cannot be looked at.
pub fn cut_off(files: &dyn Vfs, target: &Path) -> Result<Option<PathBuf>, SaveError> {
    let target = super::save::resolved(files, target)?;
    let old = old_of(&target);
    Ok(look(files, &old).map_err(SaveError::at(&target, Step::Look))?.map(|_| old))
}

/// As [`cut_off`], as an error.
pub(super) fn not_cut_off(files: &dyn Vfs, target: &Path) -> Result<(), SaveError> {
    let old = old_of(target);
    match look(files, &old).map_err(SaveError::at(target, Step::Look))? {
        None => Ok(()),
        Some(_) => Err(SaveError::CutOff { path: target.to_path_buf(), old }),
    }
}

/// Puts the content of before back, after overwriting was cut off and a person chose so.
///
/// # Errors
/// When that does not succeed; the copy stays then.
pub fn put_back(files: &dyn Vfs, target: &Path) -> Result<(), SaveError> {
    let target = super::save::resolved(files, target)?;
    let old = old_of(&target);
    back(files, &target, &old).and_then(|()| forget(files, &old)).map_err(|error| SaveError::Torn {
        path: target.clone(),
        old,
        error,
    })
}

/// Leaves the file as it is and forgets the content of before, after a person chose so.
///
/// # Errors
/// When it cannot be removed.
pub fn put_away(files: &dyn Vfs, target: &Path) -> Result<(), SaveError> {
    let target = super::save::resolved(files, target)?;
    forget(files, &old_of(&target)).map_err(SaveError::at(&target, Step::Keep))
}

fn back(files: &dyn Vfs, target: &Path, old: &Path) -> io::Result<()> {
    let from = again(|| files.open(old))?;
    // Opened anew: the file whose bytes could not be brought to the disk is not asked a second time.
    let to = again(|| files.open_to_write(target))?;
    let size = copy(&*from, &*to)?;
    again(|| to.set_size(size))?;
    again(|| to.sync_all())
}

fn forget(files: &dyn Vfs, old: &Path) -> io::Result<()> {
    again(|| files.remove(old))?;
    again(|| files.sync_folder(folder_of(old)))
}

/// Writes `bytes` into the file at `target`, which has several names.
pub(super) fn overwrite(
    files: &dyn Vfs,
    target: &Path,
    bytes: &[u8],
    expected: Expected<'_>,
) -> Result<FileStamp, SaveError> {
    let file = again(|| files.open_to_write(target)).map_err(SaveError::at(target, Step::Create))?;
    let old = old_of(target);
    set_aside(files, target, &old, &*file).map_err(SaveError::at(target, Step::Keep))?;
    if let Err(error) = expect(files, target, expected) {
        let _ = forget(files, &old);
        return Err(error);
    }
    let written = write_all(&*file, bytes, 0).map_err(|error| (Step::Write, error)).and_then(|()| {
        again(|| file.set_size(bytes.len() as u64)).map_err(|error| (Step::Write, error))?;
        again(|| file.sync_all()).map_err(|error| (Step::Sync, error))?;
        again(|| file.metadata()).map_err(|error| (Step::Look, error))
    });
    let data = match written {
        Ok(data) => data,
        Err((step, error)) => {
            drop(file);
            return Err(match back(files, target, &old) {
                Ok(()) => {
                    let _ = forget(files, &old);
                    SaveError::Io { path: target.to_path_buf(), step, error }
                }
                Err(_) => SaveError::Torn { path: target.to_path_buf(), old, error },
            });
        }
    };
    // While the copy is there, the file counts as half written.
    forget(files, &old).map_err(|error| {
        let _ = again(|| files.remove(&old));
        SaveError::Unconfirmed { path: target.to_path_buf(), error }
    })?;
    Ok(FileStamp::of(&data, hash(bytes)))
}

/// Copies the old content to `old`, all or nothing, on the disk before this returns.
fn set_aside(files: &dyn Vfs, target: &Path, old: &Path, file: &dyn VfsFile) -> io::Result<()> {
    let (beside, to) = create_beside(files, target, true)?;
    let made = copy(file, &*to).and_then(|_| again(|| to.sync_all())).and_then(|()| {
        drop(to);
        again(|| files.rename(&beside, old))
    });
    let gone = if made.is_ok() { old } else { &beside };
    let made = made.and_then(|()| again(|| files.sync_folder(folder_of(old))));
    if made.is_err() {
        let _ = again(|| files.remove(gone));
    }
    made
}
