//! What was in a file before it was saved: some old versions of each document, in the autosave folder.

use super::save::{create_beside, remove_leftovers};
use super::shelf::{self, Bounds, Numbered};
use super::stamp::Hash;
use super::vfs::{FileData, Vfs, VfsFile, again, read_pieces, write_all};
use super::{autosave, error};
use std::io;
use std::path::{Path, PathBuf};

/// How much is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VersionLimits {
    /// Of one document.
    pub each: Bounds,
    /// A larger file is not kept, in bytes.
    pub largest: u64,
    /// Bytes of all documents together; the versions that were kept longest ago go first.
    pub all: u64,
}

impl Default for VersionLimits {
    fn default() -> Self {
        let each = Bounds { least: 3, most: 20, bytes: 512 << 20 };
        Self { each, largest: 1 << 30, all: 8 << 30 }
    }
}

/// Old versions of documents.
#[derive(Clone, Debug)]
pub struct Versions {
    folder: PathBuf,
    limits: VersionLimits,
}

/// An old version of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Version {
    /// The file it is in, with the ending of the document's own.
    pub path: PathBuf,
    /// Bytes.
    pub size: u64,
    /// When it was replaced by a newer one, in nanoseconds since 1970.
    pub replaced: i64,
}

impl Versions {
    /// Kept in `folder`, which is made when there is something to keep.
    pub fn new(folder: PathBuf, limits: VersionLimits) -> Self {
        Self { folder, limits }
    }

    /// The old versions of the document at `document`, newest first.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn of(&self, files: &dyn Vfs, document: &Path) -> io::Result<Vec<Version>> {
        let present = shelf::numbered(files, &self.folder.join(autosave::key(files, document)))?;
        let version =
            |file: Numbered| Version { path: file.path, size: file.data.size, replaced: file.data.modified };
        Ok(present.into_iter().rev().map(version).collect())
    }

    /// Keeps what is now in the file at `document`; where it is.
    ///
    /// # Errors
    /// When it is not on the disk then. `document` is only read.
    pub fn keep(&self, files: &dyn Vfs, document: &Path) -> io::Result<PathBuf> {
        let folder = self.folder.join(autosave::key(files, document));
        let from = again(|| files.open(document))?;
        let size = again(|| from.metadata())?.size;
        if size > self.limits.largest {
            let text = format!("it is larger than {} MiB", self.limits.largest >> 20);
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, text));
        }
        again(|| files.create_folder(&folder))?;
        let work = folder.join("version");
        remove_leftovers(files, &work);
        let (beside, to) = create_beside(files, &work, true)?;
        let kept = fill(files, document, &folder, &*from, &*to).and_then(|path| {
            drop(to);
            match path {
                Kept::New(path) => {
                    again(|| files.rename(&beside, &path))?;
                    again(|| files.sync_folder(&folder))?;
                    Ok(path)
                }
                Kept::Already(path) => {
                    again(|| files.remove(&beside))?;
                    Ok(path)
                }
            }
        });
        if kept.is_err() {
            let _ = again(|| files.remove(&beside));
        }
        let kept = kept.map_err(|error| io::Error::new(error.kind(), error::reason(&error)))?;
        shelf::trim(files, &folder, self.limits.each);
        self.trim_all(files, &folder);
        Ok(kept)
    }

    /// Removes what was kept longest ago, of documents other than the one in `present`, until all is within bounds.
    fn trim_all(&self, files: &dyn Vfs, present: &Path) {
        let mut all: Vec<(PathBuf, FileData)> = Vec::new();
        let mut bytes = 0_u64;
        for name in shelf::list(files, &self.folder).unwrap_or_default() {
            let folder = self.folder.join(name);
            for file in shelf::numbered(files, &folder).unwrap_or_default() {
                bytes = bytes.saturating_add(file.data.size);
                if folder != present {
                    all.push((file.path, file.data));
                }
            }
        }
        all.sort_by_key(|(_, data)| data.modified);
        for (path, data) in all {
            if bytes <= self.limits.all {
                break;
            }
            if again(|| files.remove(&path)).is_ok() {
                bytes = bytes.saturating_sub(data.size);
            }
        }
    }
}

enum Kept {
    New(PathBuf),
    /// The newest version holds the same bytes.
    Already(PathBuf),
}

/// Copies, and chooses the name.
fn fill(
    files: &dyn Vfs,
    document: &Path,
    folder: &Path,
    from: &dyn VfsFile,
    to: &dyn VfsFile,
) -> io::Result<Kept> {
    let mut hash = Hash::default();
    read_pieces(from, |offset, piece| {
        hash.add(piece);
        write_all(to, piece, offset)
    })?;
    let mut name = format!("{:016x}", hash.value());
    if let Some(ending) = document.extension().and_then(|ending| ending.to_str()) {
        name.push('.');
        name.push_str(ending);
    }
    let present = shelf::numbered(files, folder)?;
    if let Some(newest) = present.last().filter(|newest| newest.name == name) {
        return Ok(Kept::Already(newest.path.clone()));
    }
    again(|| to.sync_all())?;
    Ok(Kept::New(shelf::next(folder, &present, &name)))
}
