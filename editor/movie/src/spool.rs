//! Frames in a temporary file, compressed, to be read again in order.

use crate::error::MovieError;
use dragonfly_store::{GrowingFile, Vfs};
use miniz_oxide::deflate::compress_to_vec;
use miniz_oxide::inflate::decompress_to_vec_with_limit;
use std::path::Path;
use std::sync::Arc;

/// Effort of the compression: the least, which removes what did not change.
const EFFORT: u8 = 1;

/// Frames in a temporary file next to the movie. Dropping the value removes the file.
#[derive(Debug)]
pub(crate) struct FrameSpool {
    file: GrowingFile,
    frames: u64,
    read: u64,
    /// The frame that was added or read last.
    last: Vec<u8>,
    buffer: Vec<u8>,
}

impl FrameSpool {
    pub(crate) fn create(files: Arc<dyn Vfs>, path: &Path) -> Result<Self, MovieError> {
        let file = GrowingFile::create(files, path)?;
        Ok(Self { file, frames: 0, read: 0, last: Vec::new(), buffer: Vec::new() })
    }

    /// Returns the number of frames.
    pub(crate) fn frames(&self) -> u64 {
        self.frames
    }

    /// Adds a frame. After an error the frames before can still be read.
    pub(crate) fn add(&mut self, frame: &[u8]) -> Result<(), MovieError> {
        self.last.resize(frame.len(), 0);
        self.buffer.clear();
        self.buffer.extend(frame.iter().zip(&self.last).map(|(now, last)| now ^ last));
        let bytes = compress_to_vec(&self.buffer, EFFORT);
        let whole = self.file.size();
        let length = (bytes.len() as u64).to_le_bytes();
        if let Err(error) = self.file.append(&length).and_then(|()| self.file.append(&bytes)) {
            // Only the count matters for reading; what cannot be removed does no harm.
            let _ = self.file.truncate(whole);
            return Err(error.into());
        }
        self.last.copy_from_slice(frame);
        self.frames += 1;
        Ok(())
    }

    /// Returns the next frame, from the first one on. No frame can be added any more.
    pub(crate) fn next(&mut self) -> Result<&[u8], MovieError> {
        if self.read == 0 {
            self.last.fill(0);
        }
        let mut length = [0; 8];
        self.file.read(&mut length, self.read)?;
        let length = u64::from_le_bytes(length);
        self.buffer.resize(length as usize, 0);
        self.file.read(&mut self.buffer, self.read + 8)?;
        let changes = decompress_to_vec_with_limit(&self.buffer, self.last.len());
        let changes = changes.map_err(|error| MovieError::Frame {
            number: self.frames,
            reason: format!("its temporary file changed: {error}"),
        })?;
        self.last.iter_mut().zip(changes).for_each(|(last, change)| *last ^= change);
        self.read += 8 + length;
        Ok(&self.last)
    }
}
