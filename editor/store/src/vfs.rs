//! What saving and journals ask of a file system, as a trait, so that tests can fail every single call.

use std::ffi::OsString;
use std::fmt::Debug;
use std::io;
use std::path::{Path, PathBuf};

/// What has a name in a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A regular file.
    File,
    /// A folder.
    Folder,
    /// A symbolic link.
    Link,
    /// A device, pipe or socket.
    Other,
}

/// What the system knows of a file. What it does not know is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileData {
    /// What it is.
    pub kind: Kind,
    /// Bytes.
    pub size: u64,
    /// When its bytes changed, in nanoseconds since 1970.
    pub modified: i64,
    /// When its bytes or its data changed, in nanoseconds since 1970; no program can choose this one.
    pub changed: i64,
    /// The device it lies on.
    pub device: u64,
    /// Its number there.
    pub inode: u64,
    /// How many names it has.
    pub links: u64,
    /// Permission bits.
    pub mode: u32,
    /// Number of the user whom it belongs to.
    pub owner: u32,
    /// Number of the group that it belongs to.
    pub group: u32,
}

/// An extended attribute: name and value.
pub type Attribute = (Vec<u8>, Vec<u8>);

/// The file system. Every call is one the system may refuse; [`again`] repeats one that a signal interrupted.
pub trait Vfs: Debug + Send + Sync {
    /// A new, empty file to read and write; an error when the name is taken. `private` keeps others from it.
    fn create_new(&self, path: &Path, private: bool) -> io::Result<Box<dyn VfsFile>>;
    /// An existing file to read.
    fn open(&self, path: &Path) -> io::Result<Box<dyn VfsFile>>;
    /// An existing file to read and write; what it holds stays.
    fn open_to_write(&self, path: &Path) -> io::Result<Box<dyn VfsFile>>;
    /// What has this very name: a link is not followed.
    fn metadata(&self, path: &Path) -> io::Result<FileData>;
    /// Where a link points.
    fn read_link(&self, path: &Path) -> io::Result<PathBuf>;
    /// The absolute path of what exists, free of links.
    fn resolve(&self, path: &Path) -> io::Result<PathBuf>;
    /// Gives a file another name in one step; whatever had that name before is replaced.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;
    /// Gives a file another name in one step, if nothing has that name; `AlreadyExists` otherwise.
    fn rename_to_new(&self, from: &Path, to: &Path) -> io::Result<()>;
    /// Removes a name of a file.
    fn remove(&self, path: &Path) -> io::Result<()>;
    /// Makes a folder that is nobody else's, and those above it; nothing when it exists.
    fn create_folder(&self, path: &Path) -> io::Result<()>;
    /// Returns when names made, changed or removed in a folder are on the disk.
    fn sync_folder(&self, path: &Path) -> io::Result<()>;
    /// Names in a folder, in no order.
    fn list(&self, path: &Path) -> io::Result<Vec<OsString>>;
}

/// An open file. Positions are said with each call, so that a failed one leaves none behind.
pub trait VfsFile: Debug + Send {
    /// What the system knows of it.
    fn metadata(&self) -> io::Result<FileData>;
    /// Reads up to `bytes.len()` bytes; 0 at the end.
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize>;
    /// Writes some of `bytes`, and says how many.
    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize>;
    /// Cuts it, or fills it with zeros.
    fn set_size(&self, size: u64) -> io::Result<()>;
    /// Returns when its bytes are on the disk. After an error what was written may be gone: the same file is not
    /// asked again.
    fn sync_data(&self) -> io::Result<()>;
    /// [`sync_data`](Self::sync_data), and all that the system knows of it.
    fn sync_all(&self) -> io::Result<()>;
    /// Takes the advisory lock, which ends with the open file; `false` when another one has it.
    fn try_lock(&self) -> io::Result<bool>;
    /// Gives it to a user, or keeps that one when `None`, and to a group.
    fn set_owner(&self, owner: Option<u32>, group: u32) -> io::Result<()>;
    /// Sets its permission bits.
    fn set_mode(&self, mode: u32) -> io::Result<()>;
    /// Its extended attributes; none where the system has no such thing.
    fn attributes(&self) -> io::Result<Vec<Attribute>>;
    /// Sets an extended attribute.
    fn set_attribute(&self, name: &[u8], value: &[u8]) -> io::Result<()>;
}

/// How often a call interrupted by signals is repeated: more often than any signals come, and not for ever.
const REPEATS: usize = 1000;

/// Repeats what a signal interrupted.
pub(super) fn again<T>(mut call: impl FnMut() -> io::Result<T>) -> io::Result<T> {
    for _ in 0..REPEATS {
        match call() {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            other => return other,
        }
    }
    call()
}

/// Writes all of `bytes`, however little at a time the system takes.
pub(super) fn write_all(file: &dyn VfsFile, bytes: &[u8], offset: u64) -> io::Result<()> {
    let mut done = 0;
    while done < bytes.len() {
        match again(|| file.write_at(&bytes[done..], offset + done as u64))? {
            0 => return Err(io::Error::from(io::ErrorKind::WriteZero)),
            written => done += written,
        }
    }
    Ok(())
}

/// Pieces in which files are read and copied, in bytes.
pub(super) const PIECE: usize = 1 << 16;

/// Shows `visit` all bytes of `file`, a piece at a time.
pub(super) fn read_pieces(
    file: &dyn VfsFile,
    mut visit: impl FnMut(u64, &[u8]) -> io::Result<()>,
) -> io::Result<u64> {
    let mut piece = vec![0; PIECE];
    let mut offset = 0;
    loop {
        let got = again(|| file.read_at(&mut piece, offset))?;
        if got == 0 {
            return Ok(offset);
        }
        visit(offset, &piece[..got])?;
        offset += got as u64;
    }
}

/// Writes all of `from` into `to`, from its beginning; the number of bytes.
pub(super) fn copy(from: &dyn VfsFile, to: &dyn VfsFile) -> io::Result<u64> {
    read_pieces(from, |offset, piece| write_all(to, piece, offset))
}

/// What has this name, if anything has.
pub(super) fn look(files: &dyn Vfs, path: &Path) -> io::Result<Option<FileData>> {
    match again(|| files.metadata(path)) {
        Ok(data) => Ok(Some(data)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// The folder of `path`; of a file named with nothing before its name, the present one.
pub fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
