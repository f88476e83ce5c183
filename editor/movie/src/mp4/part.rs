//! A part of a movie, read from its file. Its tables are checked before anything is copied.

use super::label::MovieLabel;
use crate::error::MovieError;
use dragonfly_store::{Vfs, VfsFile};
use shiguredo_mp4::aux::SampleTableAccessor;
use shiguredo_mp4::boxes::{MoovBox, SampleEntry, StblBox};
use shiguredo_mp4::{BoxType, Decode};
use std::io;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};

/// Largest tables that are read, in bytes: those of a day at 60 frames per second are far smaller.
const LARGEST_TABLES: u64 = 256 << 20;
/// Largest sample that is read, in bytes.
const LARGEST_SAMPLE: u32 = 256 << 20;

/// The label, encoding and length of a part of a movie.
pub(super) struct PartHead {
    pub(super) path: PathBuf,
    pub(super) label: MovieLabel,
    pub(super) entry: SampleEntry,
    pub(super) timescale: NonZeroU32,
    pub(super) delta: u32,
    /// Number of frames.
    pub(super) frames: u64,
}

impl PartHead {
    /// Returns an error about the part.
    pub(super) fn wrong(&self, reason: String) -> MovieError {
        MovieError::Part { path: self.path.clone(), reason }
    }

    /// Returns whether everything but the path is equal.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        (&self.label, &self.entry, self.timescale, self.delta, self.frames)
            == (&other.label, &other.entry, other.timescale, other.delta, other.frames)
    }
}

/// A part of a movie, whose file is open.
pub(super) struct MoviePart {
    head: PartHead,
    file: Box<dyn VfsFile>,
    size: u64,
    table: SampleTableAccessor<StblBox>,
    has_sound: bool,
}

impl MoviePart {
    /// Opens a part and reads its tables. A part has no sound.
    pub(super) fn open(files: &dyn Vfs, path: &Path) -> Result<Self, MovieError> {
        let part = Self::open_any(files, path)?;
        if part.has_sound {
            return Err(part.wrong("it has sound; parts are joined before the sound is added".to_owned()));
        }
        Ok(part)
    }

    /// Opens a part, or a whole movie that may have sound, and reads its tables.
    pub(super) fn open_any(files: &dyn Vfs, path: &Path) -> Result<Self, MovieError> {
        let wrong = |reason: String| MovieError::Part { path: path.to_path_buf(), reason };
        let unread = |error: io::Error| wrong(error.to_string());
        let file = files.open(path).map_err(unread)?;
        let size = file.metadata().map_err(unread)?.size;
        let tables = tables(&*file, size).map_err(unread)?;
        let tables = tables.ok_or_else(|| wrong("it is no complete MP4".to_owned()))?;
        let damaged = |error: shiguredo_mp4::Error| wrong(format!("its tables are damaged: {error}"));
        let (tables, _) = MoovBox::decode(&tables).map_err(damaged)?;
        let label = tables.unknown_boxes.iter().find_map(MovieLabel::from_box);
        let label = label.ok_or_else(|| wrong("it is no part of a movie of this program".to_owned()))?;
        let mut tracks = tables.trak_boxes.into_iter();
        let track = tracks.next().ok_or_else(|| wrong("it has no pictures".to_owned()))?;
        let has_sound = tracks.next().is_some();
        let timescale = track.mdia_box.mdhd_box.timescale;
        let table = track.mdia_box.minf_box.stbl_box;
        let ([entry], [durations]) = (table.stsd_box.entries.as_slice(), table.stts_box.entries.as_slice())
        else {
            return Err(wrong("its frames are not all alike".to_owned()));
        };
        let (entry, delta) = (entry.clone(), durations.sample_delta);
        let table = SampleTableAccessor::new(table)
            .map_err(|error| wrong(format!("its tables are damaged: {error}")))?;
        let frames = u64::from(table.sample_count());
        // Each frame has at least a byte: one that is claimed only is found before anything is copied.
        if frames > size || label.first.checked_add(frames).is_none() {
            return Err(wrong(format!("its tables claim {frames} frames in {size} bytes")));
        }
        let head = PartHead { path: path.to_path_buf(), label, entry, timescale, delta, frames };
        Ok(Self { head, file, size, table, has_sound })
    }

    /// Returns label, encoding and length.
    pub(super) fn head(&self) -> &PartHead {
        &self.head
    }

    /// Closes the file and returns label, encoding and length.
    pub(super) fn into_head(self) -> PartHead {
        self.head
    }

    /// Returns whether the file has the bytes of all samples.
    pub(super) fn is_whole(&self) -> bool {
        let end = |offset: u64, size: u32| offset.checked_add(u64::from(size));
        let mut samples = self.table.samples();
        samples
            .all(|sample| end(sample.data_offset(), sample.data_size()).is_some_and(|end| end <= self.size))
    }

    fn wrong(&self, reason: String) -> MovieError {
        self.head.wrong(reason)
    }

    /// Calls `add` with the bytes of each sample in order, and whether it needs no other sample.
    pub(super) fn samples(
        &self,
        mut add: impl FnMut(&[u8], bool) -> Result<(), MovieError>,
    ) -> Result<(), MovieError> {
        let mut bytes = Vec::new();
        for (number, sample) in (self.head.label.first..).zip(self.table.samples()) {
            let is_whole = sample.is_sync_sample();
            let begins_group =
                number.is_multiple_of(self.head.label.group) || number == self.head.label.first;
            if is_whole != begins_group {
                return Err(self.wrong(format!("frame {number} begins no group, or one where none begins")));
            }
            let size = sample.data_size();
            if size > LARGEST_SAMPLE {
                return Err(self.wrong(format!("frame {number} has {size} bytes")));
            }
            let end = sample.data_offset().checked_add(u64::from(size));
            if end.is_none_or(|end| end > self.size) {
                return Err(self.wrong(format!("the file ends before frame {number}")));
            }
            bytes.resize(size as usize, 0);
            read(&*self.file, &mut bytes, sample.data_offset())
                .map_err(|error| self.wrong(error.to_string()))?;
            add(&bytes, is_whole)?;
        }
        Ok(())
    }
}

/// Returns the bytes of the box of tables; `None` if the file ends before.
fn tables(file: &dyn VfsFile, end: u64) -> io::Result<Option<Vec<u8>>> {
    let mut at = 0;
    while at < end {
        let mut header = [0; 16];
        let length = (end - at).min(16) as usize;
        read(file, &mut header[..length], at)?;
        let [size, kind, large @ ..] = header.as_chunks::<4>().0 else { return Ok(None) };
        let size = match u32::from_be_bytes(*size) {
            0 => end - at,
            1 => u64::from_be_bytes(*large.as_flattened().first_chunk().unwrap_or(&[0; 8])),
            size => u64::from(size),
        };
        if size < 8 || size > end - at {
            return Ok(None);
        }
        if BoxType::Normal(*kind) == MoovBox::TYPE {
            if size > LARGEST_TABLES {
                return Ok(None);
            }
            let mut bytes = vec![0; size as usize];
            read(file, &mut bytes, at)?;
            return Ok(Some(bytes));
        }
        at += size;
    }
    Ok(None)
}

fn read(file: &dyn VfsFile, bytes: &mut [u8], offset: u64) -> io::Result<()> {
    let mut done = 0;
    while done < bytes.len() {
        match file.read_at(&mut bytes[done..], offset + done as u64) {
            Ok(0) => return Err(io::Error::from(io::ErrorKind::UnexpectedEof)),
            Ok(read) => done += read,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}
