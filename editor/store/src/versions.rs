//! Old versions: the content that files had before they were saved, some per document, in the autosave folder.

use super::error;
use super::numbered::{self, FolderLimits, NumberedFile};
use super::stamp::Hash;
use super::target::key;
use super::temporary::{create_temporary, remove_leftovers};
use super::vfs::{FileData, Vfs, VfsFile, read_pieces, retry, write_all};
use std::io;
use std::path::{Path, PathBuf};

/// Limits of the kept versions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VersionLimits {
    /// Limits for one document.
    pub each: FolderLimits,
    /// Size of the largest file that is kept, in bytes.
    pub largest: u64,
    /// Total size of the versions of all documents, in bytes; the oldest ones are removed first.
    pub all: u64,
}

impl Default for VersionLimits {
    fn default() -> Self {
        let each = FolderLimits { least: 3, most: 20, bytes: 512 << 20 };
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
pub struct OldVersion {
    /// Path of the copy, which has the extension of the document.
    pub path: PathBuf,
    /// Size in bytes.
    pub size: u64,
    /// Time it was replaced by a newer version, in nanoseconds since 1970.
    pub replaced: i64,
}

impl Versions {
    /// Keeps versions in `folder`, which is created on first use.
    pub fn new(folder: PathBuf, limits: VersionLimits) -> Self {
        Self { folder, limits }
    }

    /// Lists the old versions of the document at `document`, newest first.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn of(&self, files: &dyn Vfs, document: &Path) -> io::Result<Vec<OldVersion>> {
        let present = numbered::files(files, &self.folder.join(key(files, document)))?;
        let version = |file: NumberedFile| OldVersion {
            path: file.path,
            size: file.data.size,
            replaced: file.data.modified,
        };
        Ok(present.into_iter().rev().map(version).collect())
    }

    /// Copies the current content of the file at `document` and returns the path of the copy.
    ///
    /// # Errors
    /// When the copy is not on the disk. `document` is only read.
    pub fn keep(&self, files: &dyn Vfs, document: &Path) -> io::Result<PathBuf> {
        let folder = self.folder.join(key(files, document));
        let from = retry(|| files.open(document))?;
        let size = retry(|| from.metadata())?.size;
        if size > self.limits.largest {
            let text = format!("it is larger than {} MiB", self.limits.largest >> 20);
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, text));
        }
        retry(|| files.create_folder(&folder))?;
        let work = folder.join("version");
        remove_leftovers(files, &work);
        let (temporary, to) = create_temporary(files, &work, true)?;
        let kept = fill(files, document, &folder, &*from, &*to).and_then(|path| {
            drop(to);
            match path {
                KeptVersion::New(path) => {
                    retry(|| files.rename(&temporary, &path))?;
                    retry(|| files.sync_folder(&folder))?;
                    Ok(path)
                }
                KeptVersion::Already(path) => {
                    retry(|| files.remove(&temporary))?;
                    Ok(path)
                }
            }
        });
        if kept.is_err() {
            let _ = retry(|| files.remove(&temporary));
        }
        let kept = kept.map_err(|error| io::Error::new(error.kind(), error::reason(&error)))?;
        numbered::trim(files, &folder, self.limits.each);
        self.trim_all(files, &folder);
        Ok(kept)
    }

    /// Removes the oldest versions of documents other than the one in `present`, until all are within bounds.
    fn trim_all(&self, files: &dyn Vfs, present: &Path) {
        let mut all: Vec<(PathBuf, FileData)> = Vec::new();
        let mut bytes = 0_u64;
        for name in numbered::names(files, &self.folder).unwrap_or_default() {
            let folder = self.folder.join(name);
            for file in numbered::files(files, &folder).unwrap_or_default() {
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
            if retry(|| files.remove(&path)).is_ok() {
                bytes = bytes.saturating_sub(data.size);
            }
        }
    }
}

enum KeptVersion {
    New(PathBuf),
    /// The newest version has the same bytes.
    Already(PathBuf),
}

/// Copies the file and chooses the name of the copy.
fn fill(
    files: &dyn Vfs,
    document: &Path,
    folder: &Path,
    from: &dyn VfsFile,
    to: &dyn VfsFile,
) -> io::Result<KeptVersion> {
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
    let present = numbered::files(files, folder)?;
    if let Some(newest) = present.last().filter(|newest| newest.name == name) {
        return Ok(KeptVersion::Already(newest.path.clone()));
    }
    retry(|| to.sync_all())?;
    Ok(KeptVersion::New(numbered::next_path(folder, &present, &name)))
}
