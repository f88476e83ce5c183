//! Folders of numbered files that grow only to a bound: old versions, and the bin.

use super::vfs::{FileData, Kind, Vfs, again, look};
use std::io;
use std::path::{Path, PathBuf};

/// How much a folder holds at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// So many of the newest stay, whatever their size.
    pub least: usize,
    /// At most so many.
    pub most: usize,
    /// At most so many bytes, but for the `least` newest.
    pub bytes: u64,
}

/// A file called `number-name`.
#[derive(Clone, Debug)]
pub(super) struct Numbered {
    pub(super) number: u64,
    /// Without the number.
    pub(super) name: String,
    pub(super) path: PathBuf,
    pub(super) data: FileData,
}

/// The numbered files in `folder`, oldest first; none when there is no such folder.
pub(super) fn numbered(files: &dyn Vfs, folder: &Path) -> io::Result<Vec<Numbered>> {
    let mut found = Vec::new();
    for name in list(files, folder)? {
        let Some((number, rest)) = name.to_str().and_then(|name| name.split_once('-')) else { continue };
        let Ok(number) = number.parse() else { continue };
        let path = folder.join(&name);
        if let Some(data) = look(files, &path)?.filter(|data| data.kind == Kind::File) {
            found.push(Numbered { number, name: rest.to_owned(), path, data });
        }
    }
    found.sort_by_key(|file| file.number);
    Ok(found)
}

/// Names in `folder`, in no order; none when there is no such folder.
pub(super) fn list(files: &dyn Vfs, folder: &Path) -> io::Result<Vec<std::ffi::OsString>> {
    match again(|| files.list(folder)) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        other => other,
    }
}

/// The path of the next file called `name`.
pub(super) fn next(folder: &Path, present: &[Numbered], name: &str) -> PathBuf {
    let number = present.last().map_or(1, |last| last.number.saturating_add(1));
    // With leading zeros, so that other programs show them in their order.
    folder.join(format!("{number:06}-{name}"))
}

/// Removes the oldest files until `bounds` hold. That one cannot be removed changes nothing.
pub(super) fn trim(files: &dyn Vfs, folder: &Path, bounds: Bounds) {
    let present = numbered(files, folder).unwrap_or_default();
    let (mut bytes, mut stays) = (0_u64, true);
    for (newer, file) in present.iter().rev().enumerate() {
        bytes = bytes.saturating_add(file.data.size);
        stays = newer < bounds.least || (stays && newer < bounds.most && bytes <= bounds.bytes);
        if !stays {
            let _ = again(|| files.remove(&file.path));
        }
    }
}
