//! The operations of a file system that saving and journals use, as a trait, so that tests can make every single call
//! fail.

use std::ffi::OsString;
use std::fmt::Debug;
use std::io;
use std::path::{Path, PathBuf};

/// Kind of a directory entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A regular file.
    File,
    /// A folder.
    Folder,
    /// A symbolic link.
    Link,
    /// A device, pipe or socket.
    Other,
}

/// Metadata of a file. Values that the system does not provide are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileData {
    /// Kind of the entry.
    pub kind: FileKind,
    /// Size in bytes.
    pub size: u64,
    /// Time its bytes were last changed, in nanoseconds since 1970.
    pub modified: i64,
    /// Time its bytes or metadata were last changed, in nanoseconds since 1970; programs cannot set this one.
    pub changed: i64,
    /// Number of the device it is on.
    pub device: u64,
    /// Inode number on that device.
    pub inode: u64,
    /// Number of names (hard links).
    pub links: u64,
    /// Permission bits.
    pub mode: u32,
    /// Number of the owning user.
    pub owner: u32,
    /// Number of the owning group.
    pub group: u32,
}

/// An extended attribute: name and value.
pub type Attribute = (Vec<u8>, Vec<u8>);

/// The file system. Every call may fail; `retry` repeats a call that a signal interrupted.
pub trait Vfs: Debug + Send + Sync {
    /// Creates a new, empty file to read and write; an error when the name is in use. `private` denies access to
    /// other users.
    fn create_new(&self, path: &Path, private: bool) -> io::Result<Box<dyn VfsFile>>;
    /// Opens an existing file for reading.
    fn open(&self, path: &Path) -> io::Result<Box<dyn VfsFile>>;
    /// Opens an existing file for reading and writing, keeping its content.
    fn open_to_write(&self, path: &Path) -> io::Result<Box<dyn VfsFile>>;
    /// Returns the metadata of the entry itself: a link is not followed.
    fn metadata(&self, path: &Path) -> io::Result<FileData>;
    /// Returns the target of a link.
    fn read_link(&self, path: &Path) -> io::Result<PathBuf>;
    /// Returns the absolute path of an existing file, links resolved.
    fn resolve(&self, path: &Path) -> io::Result<PathBuf>;
    /// Renames a file in one step, replacing any file with the new name.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;
    /// Renames a file in one step if the new name is free; `AlreadyExists` otherwise.
    fn rename_to_new(&self, from: &Path, to: &Path) -> io::Result<()>;
    /// Removes a name of a file.
    fn remove(&self, path: &Path) -> io::Result<()>;
    /// Creates a folder that other users cannot access, and its parents; does nothing when it exists.
    fn create_folder(&self, path: &Path) -> io::Result<()>;
    /// Flushes to the disk the names created, changed or removed in a folder.
    fn sync_folder(&self, path: &Path) -> io::Result<()>;
    /// Lists the names in a folder in no particular order.
    fn list(&self, path: &Path) -> io::Result<Vec<OsString>>;
}

/// An open file. Offsets are explicit, so a failed call leaves no changed position.
pub trait VfsFile: Debug + Send {
    /// Returns its metadata.
    fn metadata(&self) -> io::Result<FileData>;
    /// Reads up to `bytes.len()` bytes; returns 0 at the end.
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize>;
    /// Writes some of `bytes` and returns how many.
    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize>;
    /// Truncates the file, or extends it with zeros.
    fn set_size(&self, size: u64) -> io::Result<()>;
    /// Flushes the bytes to the disk. After an error the written bytes may be lost, so the call is not repeated on
    /// the same file.
    fn sync_data(&self) -> io::Result<()>;
    /// As [`sync_data`](Self::sync_data), including the metadata.
    fn sync_all(&self) -> io::Result<()>;
    /// Takes the advisory lock, which is released when the file is closed. Returns `false` when another process holds
    /// it.
    fn try_lock(&self) -> io::Result<bool>;
    /// Releases the advisory lock at once, also if a process that is being started still has a copy of the handle.
    fn unlock(&self) -> io::Result<()>;
    /// Changes the owning user, unless `None`, and the owning group.
    fn set_owner(&self, owner: Option<u32>, group: u32) -> io::Result<()>;
    /// Sets the permission bits.
    fn set_mode(&self, mode: u32) -> io::Result<()>;
    /// Returns the extended attributes; empty where the system has none.
    fn attributes(&self) -> io::Result<Vec<Attribute>>;
    /// Sets an extended attribute.
    fn set_attribute(&self, name: &[u8], value: &[u8]) -> io::Result<()>;
}

/// Largest number of repetitions of an interrupted call: far more than signals arrive, but not endless.
const REPEATS: usize = 1000;

/// Repeats a call while signals interrupt it.
pub(super) fn retry<T>(mut call: impl FnMut() -> io::Result<T>) -> io::Result<T> {
    for _ in 0..REPEATS {
        match call() {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            other => return other,
        }
    }
    call()
}

/// Writes all of `bytes`, repeating partial writes.
pub(super) fn write_all(file: &dyn VfsFile, bytes: &[u8], offset: u64) -> io::Result<()> {
    let mut done = 0;
    while done < bytes.len() {
        match retry(|| file.write_at(&bytes[done..], offset + done as u64))? {
            0 => return Err(io::Error::from(io::ErrorKind::WriteZero)),
            written => done += written,
        }
    }
    Ok(())
}

/// Size of the buffer for reading and copying, in bytes.
pub(super) const PIECE: usize = 1 << 16;

/// Reads all of `file` in pieces and calls `visit` with each. Returns the number of bytes.
pub(super) fn read_pieces(
    file: &dyn VfsFile,
    mut visit: impl FnMut(u64, &[u8]) -> io::Result<()>,
) -> io::Result<u64> {
    let mut piece = vec![0; PIECE];
    let mut offset = 0;
    loop {
        let got = retry(|| file.read_at(&mut piece, offset))?;
        if got == 0 {
            return Ok(offset);
        }
        visit(offset, &piece[..got])?;
        offset += got as u64;
    }
}

/// Copies all of `from` to the start of `to`. Returns the number of bytes.
pub(super) fn copy(from: &dyn VfsFile, to: &dyn VfsFile) -> io::Result<u64> {
    read_pieces(from, |offset, piece| write_all(to, piece, offset))
}

/// Returns the metadata of a file, or `None` if it does not exist.
pub(super) fn metadata_if_exists(files: &dyn Vfs, path: &Path) -> io::Result<Option<FileData>> {
    match retry(|| files.metadata(path)) {
        Ok(data) => Ok(Some(data)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// Returns the folder of `path`; `.` for a bare file name.
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
