//! Frames in a temporary file, compressed, to be read again in order.

use crate::error::MovieError;
use crate::frame_ends::{FrameEnds, close_with_room};
use dragonfly_store::{GrowingFile, Vfs};
use miniz_oxide::deflate::compress_to_vec;
use miniz_oxide::inflate::decompress_to_vec_with_limit;
use std::path::Path;
use std::sync::Arc;

/// Effort of the compression: the least, which removes what did not change.
const EFFORT: u8 = 1;
/// Bytes before each frame: the number of its bytes.
const HEADER: u64 = 8;

/// Frames in a temporary file next to the movie. Dropping the value removes the file.
#[derive(Debug)]
pub(crate) struct FrameSpool {
    file: GrowingFile,
    ends: FrameEnds,
    /// Number of frames that are left, of those that were added.
    frames: u64,
    /// Number of frames that were read, and the offset of the next one.
    taken: u64,
    read: u64,
    /// The frame that was added or read last.
    last: Vec<u8>,
    buffer: Vec<u8>,
}

impl FrameSpool {
    pub(crate) fn create(files: Arc<dyn Vfs>, path: &Path) -> Result<Self, MovieError> {
        Ok(Self {
            file: GrowingFile::create(files, path)?,
            ends: FrameEnds::default(),
            frames: 0,
            taken: 0,
            read: 0,
            last: Vec::new(),
            buffer: Vec::new(),
        })
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
        let length = (bytes.len() as u64).to_le_bytes();
        if let Err(error) = self.file.append(&length).and_then(|()| self.file.append(&bytes)) {
            // Only the count matters for reading; what cannot be removed does no harm.
            let _ = self.file.truncate(self.ends.whole());
            return Err(error.into());
        }
        self.last.copy_from_slice(frame);
        self.frames += 1;
        self.ends.add(self.file.size());
        Ok(())
    }

    /// Begins to read: no frame can be added any more. Where the disk has no room for the last frames, they are left out.
    pub(crate) fn rewind(&mut self) -> Result<(), MovieError> {
        let settle = |spool: &mut Self| {
            spool.file.truncate(spool.ends.whole())?;
            Ok(spool.file.overwrite(&[], 0)?)
        };
        close_with_room(self, settle, |spool| spool.ends.leave_out())?;
        self.frames = self.ends.frames();
        self.last.fill(0);
        Ok(())
    }

    /// Returns a frame, which is after those that were returned; `None` if it was removed.
    pub(crate) fn frame(&mut self, number: u64) -> Result<Option<&[u8]>, MovieError> {
        if number >= self.frames {
            return Ok(None);
        }
        while self.taken <= number {
            self.next()?;
        }
        Ok(Some(&self.last))
    }

    /// Reads the next frame.
    fn next(&mut self) -> Result<(), MovieError> {
        let length = self.length_at(self.read)?;
        self.buffer.resize(length as usize, 0);
        self.file.read(&mut self.buffer, self.read + HEADER)?;
        let changes = decompress_to_vec_with_limit(&self.buffer, self.last.len());
        let changes = changes.map_err(|error| MovieError::Frame {
            number: self.taken,
            reason: format!("its temporary file changed: {error}"),
        })?;
        self.last.iter_mut().zip(changes).for_each(|(last, change)| *last ^= change);
        self.taken += 1;
        self.read += HEADER + length;
        Ok(())
    }

    /// Removes the later half of the frames that were not read, to make room on the disk. Returns whether there were any.
    pub(crate) fn shorten(&mut self) -> Result<bool, MovieError> {
        if self.taken >= self.frames {
            return Ok(false);
        }
        let left = self.taken + (self.frames - self.taken) / 2;
        let mut end = self.read;
        for _ in self.taken..left {
            end += HEADER + self.length_at(end)?;
        }
        self.file.truncate(end)?;
        self.frames = left;
        Ok(true)
    }

    /// Returns the number of bytes of the frame at an offset.
    fn length_at(&mut self, offset: u64) -> Result<u64, MovieError> {
        let mut length = [0; HEADER as usize];
        self.file.read(&mut length, offset)?;
        Ok(u64::from_le_bytes(length))
    }
}
