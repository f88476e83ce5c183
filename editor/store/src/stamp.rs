//! Stamps of files, to detect changes by other programs.

use super::vfs::{FileData, FileKind, Vfs, metadata_if_exists, read_pieces, retry};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

/// Coarsest clock of a file system (FAT: 2 s), in nanoseconds. A change this soon after another may have the same
/// time.
const TICK: i64 = 2_000_000_000;

/// Metadata and hash of a file at one time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileStamp {
    /// Size in bytes.
    pub size: u64,
    /// Time its bytes were last changed, in nanoseconds since 1970.
    pub modified: i64,
    /// Time its bytes or metadata were last changed, in nanoseconds since 1970; 0 where the system does not record
    /// it.
    pub changed: i64,
    /// Number of the device it is on.
    pub device: u64,
    /// Inode number on that device.
    pub inode: u64,
    /// Hash of its bytes ([`hash`]).
    pub hash: u64,
    /// Time the stamp was taken, in nanoseconds since 1970.
    pub taken: i64,
}

/// State of a file compared with its stamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileState {
    /// It has the same bytes.
    Same,
    /// It has other bytes, or is not a regular file anymore.
    Changed,
    /// There is no file with its name.
    Missing,
}

impl FileStamp {
    /// Takes the stamp of the file at `path`, reading its bytes. Links are followed.
    ///
    /// # Errors
    /// When it is not a regular file or cannot be read, or when it changes while it is read (`WouldBlock`).
    pub fn take(files: &dyn Vfs, path: &Path) -> io::Result<Self> {
        let path = retry(|| files.resolve(path))?;
        if retry(|| files.metadata(&path))?.kind != FileKind::File {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "is not a regular file"));
        }
        let file = retry(|| files.open(&path))?;
        let before = retry(|| file.metadata())?;
        let mut hash = Hash::default();
        read_pieces(&*file, |_, piece| {
            hash.add(piece);
            Ok(())
        })?;
        let after = retry(|| file.metadata())?;
        if (before.size, before.modified, before.changed) != (after.size, after.modified, after.changed) {
            return Err(io::Error::new(io::ErrorKind::WouldBlock, "is being changed by another program"));
        }
        Ok(Self::of(&after, hash.value()))
    }

    /// Returns the metadata of the file at `path`, to be taken before reading it: see [`of_read`](Self::of_read).
    ///
    /// # Errors
    /// When the file cannot be examined.
    pub fn before(files: &dyn Vfs, path: &Path) -> io::Result<FileData> {
        let path = retry(|| files.resolve(path))?;
        retry(|| files.metadata(&path))
    }

    /// Makes the stamp of the file at `path`, which was read as `bytes` after its metadata `before` was taken.
    ///
    /// # Errors
    /// When the file cannot be examined, or was changed since (`WouldBlock`).
    pub fn of_read(files: &dyn Vfs, path: &Path, before: &FileData, bytes: &[u8]) -> io::Result<Self> {
        let after = Self::before(files, path)?;
        let same = |data: &FileData| (data.size, data.modified, data.changed, data.device, data.inode);
        if same(before) != same(&after) || after.size != bytes.len() as u64 {
            return Err(io::Error::new(io::ErrorKind::WouldBlock, "is being changed by another program"));
        }
        Ok(Self::of(&after, hash(bytes)))
    }

    /// Makes a stamp from metadata and the hash of the bytes.
    pub(super) fn of(data: &FileData, hash: u64) -> Self {
        let FileData { size, modified, changed, device, inode, .. } = *data;
        Self { size, modified, changed, device, inode, hash, taken: now() }
    }

    /// Returns whether this is the stamp of a file with these bytes, for a caller that has already read them.
    pub fn is_of(&self, bytes: &[u8]) -> bool {
        self.size == bytes.len() as u64 && self.hash == hash(bytes)
    }

    /// Compares the file at `path` with the stamp: by its metadata, and where that is not conclusive, by its bytes.
    ///
    /// # Errors
    /// When the file cannot be examined.
    pub fn state(&self, files: &dyn Vfs, path: &Path) -> io::Result<FileState> {
        let path = match retry(|| files.resolve(path)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(FileState::Missing),
            other => other?,
        };
        let Some(data) = metadata_if_exists(files, &path)? else { return Ok(FileState::Missing) };
        if data.kind != FileKind::File || data.size != self.size {
            return Ok(FileState::Changed);
        }
        let same = (data.modified, data.changed, data.device, data.inode)
            == (self.modified, self.changed, self.device, self.inode);
        // Recent times prove nothing: a second write within the same tick of the clock would leave them the same.
        let newest = self.modified.max(self.changed);
        if same && self.taken.saturating_sub(newest) > TICK {
            return Ok(FileState::Same);
        }
        match Self::take(files, &path) {
            Ok(other) if other.hash == self.hash && other.size == self.size => Ok(FileState::Same),
            Ok(_) => Ok(FileState::Changed),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Ok(FileState::Changed),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(FileState::Missing),
            Err(error) => Err(error),
        }
    }
}

/// The system time, in nanoseconds since 1970.
fn now() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_nanos()).unwrap_or(i64::MAX)
}

/// FNV-1a with 64 bits. Its values are stored in journals and in the names of journals and old versions, so with
/// another function none of them would be found again. An accidental change goes undetected once in 10¹⁹ cases; the
/// hash does not protect against deliberate changes, and nothing here needs that.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hash(u64);

impl Default for Hash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Hash {
    pub(super) fn add(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    pub(super) fn value(self) -> u64 {
        self.0
    }
}

/// Returns the FNV-1a hash of `bytes`, as stored in journals and file names.
pub fn hash(bytes: &[u8]) -> u64 {
    let mut hash = Hash::default();
    hash.add(bytes);
    hash.value()
}
