//! The file of a movie while it grows, and the end of it: a file with several names keeps them all, as where models are saved, and a complete movie that
//! cannot replace the old file is kept under another name.

use crate::error::MovieError;
use crate::linked::overwrite;
use dragonfly_store::{
    FileData, FileKind, FileSaveError, GrowingFile, Vfs, VfsFile, folder_of, interrupted_save,
};
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// Number of other names that are tried for a complete movie.
const NAMES: u32 = 100;

/// A file that replaces an old one when it is complete.
#[derive(Debug)]
pub(crate) struct MovieFile {
    file: GrowingFile,
    files: Arc<EndingFiles>,
}

impl MovieFile {
    /// Creates an empty file that will replace the one at `path`.
    pub(crate) fn create(files: Arc<dyn Vfs>, path: &Path) -> Result<Self, MovieError> {
        if let Some(old) = interrupted_save(&*files, path)? {
            return Err(FileSaveError::Interrupted { path: path.to_path_buf(), old }.into());
        }
        let files = Arc::new(EndingFiles { files, kept: AtomicU32::new(0) });
        let file = GrowingFile::create(Arc::clone(&files) as Arc<dyn Vfs>, path)?;
        Ok(Self { file, files })
    }

    /// Returns the number of bytes so far.
    pub(crate) fn size(&self) -> u64 {
        self.file.size()
    }

    /// Writes bytes after the last one.
    pub(crate) fn append(&mut self, bytes: &[u8]) -> Result<(), FileSaveError> {
        self.file.append(bytes)
    }

    /// Replaces bytes that are there already. All bytes are in the file then, and none in a buffer.
    pub(crate) fn overwrite(&mut self, bytes: &[u8], offset: u64) -> Result<(), FileSaveError> {
        self.file.overwrite(bytes, offset)
    }

    /// Writes the bytes of the buffer to the file.
    pub(crate) fn settle(&mut self) -> Result<(), FileSaveError> {
        self.file.overwrite(&[], 0)
    }

    /// Removes all bytes from `size` on.
    pub(crate) fn truncate(&mut self, size: u64) -> Result<(), FileSaveError> {
        self.file.truncate(size)
    }

    /// Inserts bytes at `offset`.
    pub(crate) fn insert(&mut self, bytes: &[u8], offset: u64) -> Result<(), FileSaveError> {
        self.file.insert(bytes, offset)
    }

    /// Flushes the file to the disk and gives it its name. Returns its path and size.
    pub(crate) fn commit(self) -> Result<(PathBuf, u64), MovieError> {
        let Self { file, files } = self;
        let target = file.target().to_path_buf();
        file.commit().map_err(|error| match files.kept.load(Ordering::Relaxed) {
            0 => MovieError::File(error),
            number => MovieError::Kept { kept: numbered(&target, number), error },
        })
    }
}

/// A file system in which the last step of a file, its renaming, is as movies need it.
#[derive(Debug)]
struct EndingFiles {
    files: Arc<dyn Vfs>,
    /// Number in the other name of the complete file that could not get its own; 0 while there is none.
    kept: AtomicU32,
}

impl EndingFiles {
    fn replace(&self, complete: &Path, target: &Path) -> io::Result<()> {
        match self.files.metadata(target) {
            Ok(old) if old.kind == FileKind::File && old.links > 1 => {
                overwrite(&*self.files, complete, target)
            }
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            Ok(_) | Err(_) => self.files.rename(complete, target),
        }
    }

    /// Gives a complete file a free name next to that of `target`. One that cannot get any is removed as an incomplete one is.
    fn keep(&self, complete: &Path, target: &Path) {
        for number in 1..=NAMES {
            match self.files.rename_to_new(complete, &numbered(target, number)) {
                Ok(()) => {
                    // After a power cut the file may be back under its temporary name, which does no harm.
                    let _ = self.files.sync_folder(folder_of(target));
                    return self.kept.store(number, Ordering::Relaxed);
                }
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(_) => return,
            }
        }
    }
}

impl Vfs for EndingFiles {
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        let replaced = self.replace(from, to);
        // A call that was interrupted is repeated.
        if replaced.as_ref().is_err_and(|error| error.kind() != io::ErrorKind::Interrupted) {
            self.keep(from, to);
        }
        replaced
    }

    fn remove(&self, path: &Path) -> io::Result<()> {
        self.files.remove(path)
    }

    fn create_new(&self, path: &Path, private: bool) -> io::Result<Box<dyn VfsFile>> {
        self.files.create_new(path, private)
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn VfsFile>> {
        self.files.open(path)
    }

    fn open_to_write(&self, path: &Path) -> io::Result<Box<dyn VfsFile>> {
        self.files.open_to_write(path)
    }

    fn metadata(&self, path: &Path) -> io::Result<FileData> {
        self.files.metadata(path)
    }

    fn read_link(&self, path: &Path) -> io::Result<PathBuf> {
        self.files.read_link(path)
    }

    fn resolve(&self, path: &Path) -> io::Result<PathBuf> {
        self.files.resolve(path)
    }

    fn rename_to_new(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.files.rename_to_new(from, to)
    }

    fn create_folder(&self, path: &Path) -> io::Result<()> {
        self.files.create_folder(path)
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        self.files.sync_folder(path)
    }

    fn list(&self, path: &Path) -> io::Result<Vec<OsString>> {
        self.files.list(path)
    }
}

/// Returns a path with a number before its extension: `shot (1).mp4`.
fn numbered(path: &Path, number: u32) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_os_string();
    name.push(format!(" ({number})"));
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}
