//! What a file was when it was read, to notice that somebody else changed it.

use super::vfs::{FileData, Kind, Vfs, again, look, read_pieces};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

/// A file system's clock may tick this slowly (FAT: 2 s), so a change may hide behind one this near, in nanoseconds.
const TICK: i64 = 2_000_000_000;

/// A file as it was once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileStamp {
    /// Bytes.
    pub size: u64,
    /// When its bytes changed, in nanoseconds since 1970.
    pub modified: i64,
    /// When anything of it changed, in nanoseconds since 1970; 0 where the system does not say.
    pub changed: i64,
    /// The device it lay on.
    pub device: u64,
    /// Its number there.
    pub inode: u64,
    /// Of its bytes.
    pub hash: u64,
    /// When the stamp was made, in nanoseconds since 1970.
    pub taken: i64,
}

/// What became of a file since its stamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileState {
    /// It holds the same bytes.
    Same,
    /// It holds other bytes, or is no file any more.
    Changed,
    /// Nothing has its name.
    Missing,
}

impl FileStamp {
    /// Of the file at `path`, whose bytes are read for it. Links are followed.
    ///
    /// # Errors
    /// When it is no regular file or cannot be read, or changes while it is read (`WouldBlock`).
    pub fn take(files: &dyn Vfs, path: &Path) -> io::Result<Self> {
        let path = again(|| files.resolve(path))?;
        if again(|| files.metadata(&path))?.kind != Kind::File {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "is not a regular file"));
        }
        let file = again(|| files.open(&path))?;
        let before = again(|| file.metadata())?;
        let mut hash = Hash::default();
        read_pieces(&*file, |_, piece| {
            hash.add(piece);
            Ok(())
        })?;
        let after = again(|| file.metadata())?;
        if (before.size, before.modified, before.changed) != (after.size, after.modified, after.changed) {
            return Err(io::Error::new(io::ErrorKind::WouldBlock, "is being changed just now"));
        }
        Ok(Self::of(&after, hash.value()))
    }

    /// What the system knows of the file at `path`, asked before it is read: see [`of_read`](Self::of_read).
    ///
    /// # Errors
    /// When it cannot be looked at.
    pub fn before(files: &dyn Vfs, path: &Path) -> io::Result<FileData> {
        let path = again(|| files.resolve(path))?;
        again(|| files.metadata(&path))
    }

    /// Of the file at `path`, which was read as `bytes` after it was as `before`.
    ///
    /// # Errors
    /// When it cannot be looked at, or was changed meanwhile (`WouldBlock`).
    pub fn of_read(files: &dyn Vfs, path: &Path, before: &FileData, bytes: &[u8]) -> io::Result<Self> {
        let after = Self::before(files, path)?;
        let same = |data: &FileData| (data.size, data.modified, data.changed, data.device, data.inode);
        if same(before) != same(&after) || after.size != bytes.len() as u64 {
            return Err(io::Error::new(io::ErrorKind::WouldBlock, "is being changed just now"));
        }
        Ok(Self::of(&after, hash(bytes)))
    }

    /// Of a file whose bytes have this `hash`.
    pub(super) fn of(data: &FileData, hash: u64) -> Self {
        let FileData { size, modified, changed, device, inode, .. } = *data;
        Self { size, modified, changed, device, inode, hash, taken: now() }
    }

    /// Is it the stamp of a file with these bytes? For a reader that has them already.
    pub fn is_of(&self, bytes: &[u8]) -> bool {
        self.size == bytes.len() as u64 && self.hash == hash(bytes)
    }

    /// What became of the file at `path`: by what the system knows of it, and where that leaves doubt, by its bytes.
    ///
    /// # Errors
    /// When it cannot be looked at.
    pub fn state(&self, files: &dyn Vfs, path: &Path) -> io::Result<FileState> {
        let path = match again(|| files.resolve(path)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(FileState::Missing),
            other => other?,
        };
        let Some(data) = look(files, &path)? else { return Ok(FileState::Missing) };
        if data.kind != Kind::File || data.size != self.size {
            return Ok(FileState::Changed);
        }
        let same = (data.modified, data.changed, data.device, data.inode)
            == (self.modified, self.changed, self.device, self.inode);
        // Written again within the same tick of the clock, it would look the same.
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

/// The clock on the wall, in nanoseconds since 1970.
fn now() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_nanos()).unwrap_or(i64::MAX)
}

/// FNV-1a with 64 bits: finds every accidental change but one in 10¹⁹, and no one gains by making another.
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

/// The hash of `bytes`.
pub fn hash(bytes: &[u8]) -> u64 {
    let mut hash = Hash::default();
    hash.add(bytes);
    hash.value()
}
