//! A file that is written piece by piece under a temporary name, and replaces the file of its own name when it is complete.
//!
//! Nothing but a buffer is in memory. A file that is not committed is removed, and the old file stays as it is.

use super::error::{FileSaveError, SaveStep};
use super::save::inherit;
use super::target::{ensure_writable, regular, resolved};
use super::temporary::{create_temporary, remove_leftovers};
use super::vfs::{PIECE, Vfs, VfsFile, folder_of, retry, write_all};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Bytes that are collected before they are written.
const BUFFER: usize = 4 * PIECE;

/// A file that grows under a temporary name in the folder of its target.
#[derive(Debug)]
pub struct GrowingFile {
    files: Arc<dyn Vfs>,
    target: PathBuf,
    temporary: PathBuf,
    /// Closed once it is committed.
    file: Option<Box<dyn VfsFile>>,
    /// Number of bytes in the file; those of the buffer follow.
    written: u64,
    buffer: Vec<u8>,
}

impl GrowingFile {
    /// Creates an empty file that will replace `path`, with the owner, permissions and attributes of the old file.
    ///
    /// # Errors
    /// When the target is no regular file or is write-protected, or the temporary file cannot be created.
    pub fn create(files: Arc<dyn Vfs>, path: &Path) -> Result<Self, FileSaveError> {
        let target = resolved(&*files, path)?;
        let old = regular(&*files, &target)?;
        if let Some(old) = &old {
            ensure_writable(&*files, &target, old)?;
        }
        remove_leftovers(&*files, &target);
        let (temporary, file) = create_temporary(&*files, &target, old.is_some())
            .map_err(FileSaveError::at(&target, SaveStep::Create))?;
        let growing = Self {
            files,
            target,
            temporary,
            file: Some(file),
            written: 0,
            buffer: Vec::with_capacity(BUFFER),
        };
        if let Some(old) = &old {
            let inherit =
                |file: &dyn VfsFile| inherit(&*growing.files, &growing.target, file, old, &mut Vec::new());
            growing.call(SaveStep::Attributes, inherit)?;
        }
        Ok(growing)
    }

    /// Returns the path of the file that will be replaced, links resolved.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Returns the number of bytes so far.
    pub fn size(&self) -> u64 {
        self.written + self.buffer.len() as u64
    }

    /// Writes bytes after the last one.
    ///
    /// # Errors
    /// When the system cannot write them. Any number of them may be in the file; [`Self::truncate`] removes them.
    pub fn append(&mut self, bytes: &[u8]) -> Result<(), FileSaveError> {
        if self.buffer.len() + bytes.len() > BUFFER {
            self.flush()?;
        }
        if bytes.len() >= BUFFER {
            self.write(bytes, self.written)?;
            self.written += bytes.len() as u64;
        } else {
            self.buffer.extend_from_slice(bytes);
        }
        Ok(())
    }

    /// Replaces bytes that are there already.
    ///
    /// # Errors
    /// When the system cannot write them.
    pub fn overwrite(&mut self, bytes: &[u8], offset: u64) -> Result<(), FileSaveError> {
        self.flush()?;
        self.write(bytes, offset)
    }

    /// Fills `bytes` with those at `offset`.
    ///
    /// # Errors
    /// When the system cannot read them, or the file ends before.
    pub fn read(&mut self, bytes: &mut [u8], offset: u64) -> Result<(), FileSaveError> {
        self.flush()?;
        self.call(SaveStep::Look, |file| {
            let mut done = 0;
            while done < bytes.len() {
                match retry(|| file.read_at(&mut bytes[done..], offset + done as u64))? {
                    0 => return Err(io::Error::from(io::ErrorKind::UnexpectedEof)),
                    read => done += read,
                }
            }
            Ok(())
        })
    }

    /// Removes all bytes from `size` on.
    ///
    /// # Errors
    /// When the system cannot shorten the file.
    pub fn truncate(&mut self, size: u64) -> Result<(), FileSaveError> {
        let keep = size.saturating_sub(self.written).min(self.buffer.len() as u64) as usize;
        self.buffer.truncate(keep);
        self.written = self.written.min(size);
        // After a failed call there may be more bytes in the file than were counted.
        let written = self.written;
        self.call(SaveStep::Write, |file| retry(|| file.set_size(written)))
    }

    /// Inserts bytes at `offset` and moves the rest of the file up.
    ///
    /// # Errors
    /// When the system cannot write them. Where the disk is full, the bytes before are unchanged and in place.
    pub fn insert(&mut self, bytes: &[u8], offset: u64) -> Result<(), FileSaveError> {
        self.flush()?;
        let (end, by) = (self.written, bytes.len() as u64);
        // Takes the room first, so that nothing has moved when there is none.
        if let Err(error) = self.write(&vec![0; bytes.len()], end) {
            let _ = self.truncate(end);
            return Err(error);
        }
        self.written += by;
        let mut piece = vec![0; BUFFER];
        let mut at = end;
        while at > offset {
            let length = (at - offset).min(BUFFER as u64);
            at -= length;
            let piece = &mut piece[..length as usize];
            self.read(piece, at)?;
            self.write(piece, at + by)?;
        }
        self.write(bytes, offset)
    }

    /// Flushes the file to the disk and gives it its name. Returns its path and size.
    ///
    /// # Errors
    /// When one of that fails. Except for [`FileSaveError::Unconfirmed`] the old file is unchanged then.
    pub fn commit(mut self) -> Result<(PathBuf, u64), FileSaveError> {
        self.flush()?;
        self.call(SaveStep::Sync, |file| retry(|| file.sync_all()))?;
        // Closed before the rename, because some systems cannot rename an open file.
        let file = self.file.take();
        drop(file);
        let renamed = retry(|| self.files.rename(&self.temporary, &self.target));
        if let Err(error) = renamed {
            let _ = retry(|| self.files.remove(&self.temporary));
            return Err(FileSaveError::at(&self.target, SaveStep::Replace)(error));
        }
        let target = std::mem::take(&mut self.target);
        match retry(|| self.files.sync_folder(folder_of(&target))) {
            Ok(()) => Ok((target, self.written)),
            Err(error) => Err(FileSaveError::Unconfirmed { path: target, error }),
        }
    }

    fn flush(&mut self) -> Result<(), FileSaveError> {
        if !self.buffer.is_empty() {
            self.write(&self.buffer, self.written)?;
            self.written += self.buffer.len() as u64;
            self.buffer.clear();
        }
        Ok(())
    }

    fn write(&self, bytes: &[u8], offset: u64) -> Result<(), FileSaveError> {
        self.call(SaveStep::Write, |file| write_all(file, bytes, offset))
    }

    fn call<T>(
        &self,
        step: SaveStep,
        work: impl FnOnce(&dyn VfsFile) -> io::Result<T>,
    ) -> Result<T, FileSaveError> {
        let file = self.file.as_deref().ok_or_else(|| io::Error::from(io::ErrorKind::NotConnected));
        file.and_then(work).map_err(FileSaveError::at(&self.target, step))
    }
}

impl Drop for GrowingFile {
    fn drop(&mut self) {
        if self.file.take().is_some() {
            // The unfinished file is useless; if it cannot be removed, it does no harm.
            let _ = retry(|| self.files.remove(&self.temporary));
        }
    }
}
