//! An MP4 that grows: samples are written as they come, and the tables are inserted before them at the end.

use super::growing_sound::GrowingSound;
use super::label::MovieLabel;
use super::moov::{MovieTables, file_type};
use super::track::{TrackKind, TrackTable, ticks};
use crate::error::MovieError;
use crate::files::MovieFile;
use crate::frame_ends::left_out;
use crate::report::MovieReport;
use crate::sound::MovieSound;
use dragonfly_anim::stage::time::StageRate;
use dragonfly_store::Vfs;
use shiguredo_mp4::boxes::SampleEntry;
use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;

/// Header of the box of samples, with a size of 64 bits.
const SAMPLES_HEADER: u64 = 16;

/// An MP4 that grows.
pub(crate) struct Mp4File {
    file: MovieFile,
    label: MovieLabel,
    rate: StageRate,
    pictures: Option<TrackTable>,
    sound: Option<GrowingSound>,
    /// Offset of the first sample, and of the end of the last complete one.
    start: u64,
    end: u64,
}

impl Mp4File {
    /// Creates a file without samples.
    pub(crate) fn create(
        files: Arc<dyn Vfs>,
        path: &Path,
        label: MovieLabel,
        rate: StageRate,
        sound: Option<MovieSound>,
    ) -> Result<Self, MovieError> {
        let mut file = MovieFile::create(files, path)?;
        file.append(&file_type().map_err(unencoded)?)?;
        let start = file.size() + SAMPLES_HEADER;
        file.append(&samples_header(0))?;
        let sound = sound.map(GrowingSound::new);
        Ok(Self { file, label, rate, pictures: None, sound, start, end: start })
    }

    /// Returns the number of pictures.
    fn frames(&self) -> u64 {
        self.pictures.as_ref().map_or(0, |pictures| pictures.sizes.len() as u64)
    }

    /// Adds a picture. `entry` describes all pictures; it is used with the first one.
    pub(crate) fn picture(
        &mut self,
        bytes: &[u8],
        is_whole: bool,
        entry: impl FnOnce() -> Result<SampleEntry, MovieError>,
    ) -> Result<(), MovieError> {
        if is_whole && self.frames() > 0 {
            // A group is a chunk, after which the sound of its time follows.
            self.add_sound(false)?;
        }
        let (timescale, duration) = ticks(self.rate);
        let offset = self.end - self.start;
        let table = match &mut self.pictures {
            Some(table) => table,
            none => {
                let entry = entry()?;
                let size = entry.video_resolution().map_or([0; 2], |(width, height)| [width, height]);
                let kind = TrackKind::Pictures { size, whole: Vec::new() };
                none.insert(TrackTable::new(kind, entry, timescale))
            }
        };
        let number = self.label.first + table.sizes.len() as u64;
        let full = || MovieError::Frame { number, reason: "MP4 has no more room".to_owned() };
        let place = u32::try_from(table.sizes.len() + 1).ok().and_then(NonZeroU32::new).ok_or_else(full)?;
        let size = u32::try_from(bytes.len()).map_err(|_| full())?;
        self.file.append(bytes)?;
        table.add(offset, size, duration, is_whole);
        match &mut table.kind {
            TrackKind::Pictures { whole, .. } if is_whole => whole.push(place),
            TrackKind::Pictures { .. } | TrackKind::Sound { .. } => {}
        }
        self.end += u64::from(size);
        Ok(())
    }

    /// Adds the sound of the pictures so far: whole packets, or at the end all of it.
    fn add_sound(&mut self, is_end: bool) -> Result<(), MovieError> {
        let (Some(pictures), Some(sound)) = (&self.pictures, &mut self.sound) else { return Ok(()) };
        let mut opens = true;
        while let Some(packet) = sound.next(pictures, is_end) {
            if let Err(error) = self.file.append(&packet.bytes) {
                sound.keep(packet);
                return Err(error.into());
            }
            let size = packet.bytes.len() as u32;
            sound.table.add(self.end - self.start, size, packet.duration, opens);
            self.end += u64::from(size);
            opens = false;
        }
        Ok(())
    }

    /// Writes the tables. `notices` are those of the pictures.
    pub(crate) fn end(mut self, notices: Vec<String>) -> Result<MovieReport, MovieError> {
        self.close()?;
        let all = self.frames();
        self.commit(notices, all)
    }

    /// Writes the tables. Where the disk has no room for everything, the last groups of pictures are left out until it has.
    #[cfg_attr(not(feature = "h264"), allow(dead_code))]
    pub(crate) fn end_with_room(mut self, notices: Vec<String>) -> Result<MovieReport, MovieError> {
        let all = self.frames();
        let mut groups = 1;
        while let Err(error) = self.close() {
            // Samples that were moved already cannot be moved back.
            if !error.is_out_of_room() || self.file.size() > self.end || !self.leave_out(groups) {
                return Err(error);
            }
            groups *= 2;
        }
        self.commit(notices, all)
    }

    /// Makes the bytes a complete file, except for its name.
    fn close(&mut self) -> Result<(), MovieError> {
        self.file.truncate(self.end)?;
        self.add_sound(true)?;
        let Some(pictures) = self.pictures.as_ref().filter(|table| !table.sizes.is_empty()) else {
            return Err(MovieError::Empty);
        };
        let sound = self.sound.as_mut().and_then(|sound| sound.ended(pictures));
        let tracks = [pictures].into_iter().chain(sound).collect();
        let length = self.end - self.start;
        let tables = MovieTables { label: &self.label, tracks, start: self.start, length };
        let tables = tables.encode().map_err(unencoded)?;
        let header = self.start - SAMPLES_HEADER;
        self.file.overwrite(&samples_header(length), header)?;
        Ok(self.file.insert(&tables, header)?)
    }

    /// Leaves out the last groups of pictures with their sound, or half of the pictures where there are fewer groups. Returns whether
    /// pictures are left.
    fn leave_out(&mut self, groups: usize) -> bool {
        let Some(pictures) = &mut self.pictures else { return false };
        let begins = match &pictures.kind {
            TrackKind::Pictures { whole, .. } => {
                whole.len().checked_sub(groups).filter(|at| *at > 0).and_then(|at| whole.get(at))
            }
            TrackKind::Sound { .. } => None,
        };
        let first = begins.map_or(pictures.sizes.len() / 2, |number| number.get() as usize - 1);
        let Some(offset) = pictures.offset_of(first).filter(|_| first > 0) else { return false };
        pictures.cut(offset);
        if let Some(sound) = &mut self.sound {
            sound.cut(offset);
        }
        self.end = self.start + offset;
        true
    }

    /// Gives the file its name; `all` is the number of frames that were to be in it.
    fn commit(self, mut notices: Vec<String>, all: u64) -> Result<MovieReport, MovieError> {
        let frames = self.frames();
        notices.extend(left_out(frames, all));
        notices.extend(self.sound.as_ref().and_then(GrowingSound::notice));
        let (path, bytes) = self.file.commit()?;
        Ok(MovieReport { frames, path: Some(path), bytes, left_out: all - frames, notices })
    }
}

fn samples_header(length: u64) -> [u8; SAMPLES_HEADER as usize] {
    let mut header = [0; SAMPLES_HEADER as usize];
    header[..4].copy_from_slice(&1_u32.to_be_bytes());
    header[4..8].copy_from_slice(b"mdat");
    header[8..].copy_from_slice(&(length + SAMPLES_HEADER).to_be_bytes());
    header
}

/// Returns an error of the encoder of boxes, which never refuses the boxes of this crate.
pub(crate) fn unencoded(error: shiguredo_mp4::Error) -> MovieError {
    MovieError::Settings { format: "MP4", reason: error.to_string() }
}
