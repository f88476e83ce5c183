//! Folders of numbered files that grow only to a bound: old versions, and the bin.

use super::vfs::{FileData, FileKind, Vfs, metadata_if_exists, retry};
use std::io;
use std::path::{Path, PathBuf};

/// Limits of a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FolderLimits {
    /// Number of newest files that are kept whatever their size.
    pub least: usize,
    /// Largest number of files.
    pub most: usize,
    /// Largest number of bytes in total, not counting the `least` newest files.
    pub bytes: u64,
}

/// A file named `number-name`.
#[derive(Clone, Debug)]
pub(super) struct NumberedFile {
    pub(super) number: u64,
    /// Name without the number.
    pub(super) name: String,
    pub(super) path: PathBuf,
    pub(super) data: FileData,
}

/// Lists the numbered files in `folder`, oldest first; empty when there is no such folder.
pub(super) fn files(files: &dyn Vfs, folder: &Path) -> io::Result<Vec<NumberedFile>> {
    let mut found = Vec::new();
    for name in names(files, folder)? {
        let Some((number, rest)) = name.to_str().and_then(|name| name.split_once('-')) else { continue };
        let Ok(number) = number.parse() else { continue };
        let path = folder.join(&name);
        if let Some(data) = metadata_if_exists(files, &path)?.filter(|data| data.kind == FileKind::File) {
            found.push(NumberedFile { number, name: rest.to_owned(), path, data });
        }
    }
    found.sort_by_key(|file| file.number);
    Ok(found)
}

/// Lists the names in `folder` in no particular order; empty when there is no such folder.
pub(super) fn names(files: &dyn Vfs, folder: &Path) -> io::Result<Vec<std::ffi::OsString>> {
    match retry(|| files.list(folder)) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        other => other,
    }
}

/// Returns the path of the next file named `name`.
pub(super) fn next_path(folder: &Path, present: &[NumberedFile], name: &str) -> PathBuf {
    let number = present.last().map_or(1, |last| last.number.saturating_add(1));
    // Leading zeros, so that other programs sort the files in order.
    folder.join(format!("{number:06}-{name}"))
}

/// Removes the oldest files until the folder is within `bounds`. Failing to remove one does no
/// harm.
pub(super) fn trim(files: &dyn Vfs, folder: &Path, bounds: FolderLimits) {
    let present = self::files(files, folder).unwrap_or_default();
    let (mut bytes, mut stays) = (0_u64, true);
    for (newer, file) in present.iter().rev().enumerate() {
        bytes = bytes.saturating_add(file.data.size);
        stays = newer < bounds.least || (stays && newer < bounds.most && bytes <= bounds.bytes);
        if !stays {
            let _ = retry(|| files.remove(&file.path));
        }
    }
}
