//! Replacing a file in one step: at every instant, and after a power cut, its name leads to the complete old bytes or
//! the complete new ones; and once it is reported as saved, to the new ones.
//!
//! A new file is created in the same folder, given the owner, permissions and attributes of the old one, written,
//! flushed to the disk and renamed over the old one; then the folder is flushed. Only after that does it count as
//! saved. A link is followed first, so that the file it points to is replaced and not the link.
//!
//! A file with several names (hard links) would lose the others that way. It is overwritten in place, after its old
//! content was copied and flushed to the disk: see [`in_place`](super::in_place).

use super::error::{FileSaveError, SaveStep};
use super::in_place;
use super::stamp::{FileStamp, hash};
use super::target::{ExpectedFile, check_expected, ensure_writable, regular, resolved};
use super::temporary::{create_temporary, remove_leftovers};
use super::versions::Versions;
use super::vfs::{FileData, Vfs, VfsFile, folder_of, metadata_if_exists, retry, write_all};
use std::io;
use std::path::{Path, PathBuf};

/// Options of a save.
#[derive(Clone, Copy, Debug, Default)]
pub struct SaveOptions<'a> {
    /// Condition on the existing file.
    pub expected: ExpectedFile<'a>,
    /// Folder that keeps the old version; `None` to keep none.
    pub versions: Option<&'a Versions>,
}

/// Result of a save.
#[derive(Debug)]
pub struct SaveOutcome {
    /// The file that was written, links resolved.
    pub path: PathBuf,
    /// Its stamp after the save.
    pub stamp: FileStamp,
    /// Number of names of the file. A file with several was overwritten in place to keep them; 1 when it was
    /// replaced.
    pub links: u64,
    /// Path of the old version that was kept.
    pub kept: Option<PathBuf>,
    /// Properties of the old file that could not be kept, in words for the user.
    pub notices: Vec<String>,
}

/// Saves `bytes` in the file at `path`.
///
/// # Errors
/// When the bytes are not on the disk. Except for [`FileSaveError::Unconfirmed`] and [`FileSaveError::Torn`] the old file is
/// unchanged then, and no temporary file is left.
pub fn save(
    files: &dyn Vfs,
    path: &Path,
    bytes: &[u8],
    options: &SaveOptions<'_>,
) -> Result<SaveOutcome, FileSaveError> {
    let saved = save_one_of_many(files, path, bytes, options)?;
    remove_leftovers(files, &saved.path);
    Ok(saved)
}

/// Saves as [`save`], but does not look for what killed programs left while saving the file, because that reads the whole folder: for many
/// files in one folder [`remove_unfinished`](super::remove_unfinished) does so once.
///
/// # Errors
/// As [`save`].
pub fn save_one_of_many(
    files: &dyn Vfs,
    path: &Path,
    bytes: &[u8],
    options: &SaveOptions<'_>,
) -> Result<SaveOutcome, FileSaveError> {
    let target = resolved(files, path)?;
    let old = regular(files, &target)?;
    if let Some(old) = &old {
        ensure_writable(files, &target, old)?;
    }
    in_place::ensure_not_interrupted(files, &target)?;
    check_expected(files, &target, options.expected)?;
    let mut notices = Vec::new();
    let mut kept = None;
    if let (Some(versions), Some(_)) = (options.versions, &old) {
        match versions.keep(files, &target) {
            Ok(path) => kept = Some(path),
            // Saving the new work matters more than keeping the old version.
            Err(error) => notices.push(format!("the old version could not be kept: {error}")),
        }
    }
    let links = old.map_or(1, |data| data.links.max(1));
    let stamp = if links > 1 {
        in_place::overwrite(files, &target, bytes, options.expected)?
    } else {
        replace_file(files, &target, old.as_ref(), bytes, options.expected, &mut notices)?
    };
    Ok(SaveOutcome { path: target, stamp, links, kept, notices })
}

/// Saves `bytes` in a file that belongs to the program, without conditions.
///
/// # Errors
/// As [`save`].
pub fn replace(path: &Path, bytes: &[u8]) -> Result<SaveOutcome, FileSaveError> {
    save(&super::RealFiles, path, bytes, &SaveOptions::default())
}

fn replace_file(
    files: &dyn Vfs,
    target: &Path,
    old: Option<&FileData>,
    bytes: &[u8],
    expected: ExpectedFile<'_>,
    notices: &mut Vec<String>,
) -> Result<FileStamp, FileSaveError> {
    let (temporary, file) = create_temporary(files, target, old.is_some())
        .map_err(FileSaveError::at(target, SaveStep::Create))?;
    let written = fill(files, target, &*file, old, bytes, notices).and_then(|data| {
        // Checked again as late as possible, because writing may take long.
        check_expected(files, target, expected)?;
        // Closed before the rename, because some systems cannot rename an open file.
        drop(file);
        match expected {
            ExpectedFile::Nothing => retry(|| files.rename_to_new(&temporary, target)),
            ExpectedFile::Anything | ExpectedFile::Stamp(_) => retry(|| files.rename(&temporary, target)),
        }
        .map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => FileSaveError::Exists { path: target.to_path_buf() },
            _ => FileSaveError::at(target, SaveStep::Replace)(error),
        })?;
        Ok(data)
    });
    if written.is_err() {
        // The half-written file is useless; if it cannot be removed, it does no harm.
        let _ = retry(|| files.remove(&temporary));
    }
    let data = written?;
    retry(|| files.sync_folder(folder_of(target)))
        .map_err(|error| FileSaveError::Unconfirmed { path: target.to_path_buf(), error })?;
    // The rename may have changed a time of the file. If another program has replaced the file since, its metadata is
    // not used.
    let now = metadata_if_exists(files, target).ok().flatten().filter(|now| {
        (now.device, now.inode, now.size, now.modified) == (data.device, data.inode, data.size, data.modified)
    });
    Ok(FileStamp::of(&now.unwrap_or(data), hash(bytes)))
}

fn fill(
    files: &dyn Vfs,
    target: &Path,
    file: &dyn VfsFile,
    old: Option<&FileData>,
    bytes: &[u8],
    notices: &mut Vec<String>,
) -> Result<FileData, FileSaveError> {
    if let Some(old) = old {
        inherit(files, target, file, old, notices)
            .map_err(FileSaveError::at(target, SaveStep::Attributes))?;
    }
    write_all(file, bytes, 0).map_err(FileSaveError::at(target, SaveStep::Write))?;
    retry(|| file.sync_all()).map_err(FileSaveError::at(target, SaveStep::Sync))?;
    retry(|| file.metadata()).map_err(FileSaveError::at(target, SaveStep::Look))
}

/// Gives `file` the owner, permissions and attributes of the file at `target`.
pub(super) fn inherit(
    files: &dyn Vfs,
    target: &Path,
    file: &dyn VfsFile,
    old: &FileData,
    notices: &mut Vec<String>,
) -> io::Result<()> {
    let new = retry(|| file.metadata())?;
    let mut mode = old.mode;
    if (new.owner, new.group) != (old.owner, old.group)
        && !allowed(retry(|| file.set_owner(Some(old.owner), old.group)))?
    {
        // Without permission to change the owner, changing the group may still be possible.
        let group = allowed(retry(|| file.set_owner(None, old.group)))?;
        let what = if group { "owner" } else { "owner and group" };
        notices.push(format!("its {what} could not be kept: it now belongs to you"));
        // Clears the set-user-ID and set-group-ID bits, so that the file does not run with the rights of another
        // user.
        mode &= 0o1777;
        if !group {
            mode &= !0o070;
        }
    }
    retry(|| file.set_mode(mode))?;
    // The old file may have become unreadable in the meantime, even to its owner.
    let source = match retry(|| files.open(target)) {
        Err(error) if error.kind() == io::ErrorKind::PermissionDenied => return Ok(()),
        other => other?,
    };
    for (name, value) in retry(|| source.attributes())? {
        // A security label is not missed, because the system gives every file its own.
        if !allowed(retry(|| file.set_attribute(&name, &value)))? && !name.starts_with(b"security.") {
            let name = String::from_utf8_lossy(&name).into_owned();
            notices.push(format!("its attribute {name} could not be kept"));
        }
    }
    Ok(())
}

/// Returns `false` when the operation is not permitted or not supported; other errors are returned.
fn allowed(done: io::Result<()>) -> io::Result<bool> {
    match done {
        Ok(()) => Ok(true),
        Err(error)
            if matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::Unsupported) =>
        {
            Ok(false)
        }
        Err(error) => Err(error),
    }
}
