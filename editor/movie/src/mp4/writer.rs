//! An MP4 that grows: samples are written as they come, and the tables are inserted before them at the end.

use super::label::MovieLabel;
use super::moov::{MovieTables, file_type};
use crate::error::MovieError;
use crate::report::MovieReport;
use crate::sound::{LONGEST_PACKET, MovieSound, SoundPacket, SoundPackets};
use dragonfly_anim::stage::time::StageRate;
use dragonfly_store::{GrowingFile, Vfs};
use shiguredo_mp4::boxes::SampleEntry;
use std::num::NonZeroU32;
use std::path::Path;
use std::sync::Arc;

/// Header of the box of samples, with a size of 64 bits.
const SAMPLES_HEADER: u64 = 16;
/// Lowest number of ticks in a second: some players round times of coarser ones.
const FEWEST_TICKS: u32 = 10_000;

/// Samples that follow each other in the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleChunk {
    /// Offset from the first sample of the file.
    pub(super) offset: u64,
    pub(super) samples: u32,
}

/// Kind of a track, with what only that kind has.
#[derive(Clone, Debug)]
pub(super) enum TrackKind {
    /// Pictures: their size, and the numbers, from 1, of those that need no other one.
    Pictures { size: [u16; 2], whole: Vec<NonZeroU32> },
    /// Sound.
    Sound,
}

/// The samples of a track.
#[derive(Clone, Debug)]
pub(super) struct TrackTable {
    pub(super) kind: TrackKind,
    pub(super) entry: SampleEntry,
    /// Ticks in a second.
    pub(super) timescale: NonZeroU32,
    /// Numbers of samples that follow each other, and the duration of each.
    pub(super) durations: Vec<(u32, u32)>,
    pub(super) sizes: Vec<u32>,
    pub(super) chunks: Vec<SampleChunk>,
}

impl TrackTable {
    fn new(kind: TrackKind, entry: SampleEntry, timescale: NonZeroU32) -> Self {
        Self { kind, entry, timescale, durations: Vec::new(), sizes: Vec::new(), chunks: Vec::new() }
    }

    /// Returns the duration of all samples.
    pub(super) fn duration(&self) -> u64 {
        self.durations.iter().map(|(count, each)| u64::from(*count) * u64::from(*each)).sum()
    }

    /// Returns the duration in other ticks, rounded up.
    pub(super) fn duration_in(&self, timescale: NonZeroU32) -> u64 {
        let ticks = u128::from(self.duration()) * u128::from(timescale.get());
        ticks.div_ceil(u128::from(self.timescale.get())) as u64
    }

    /// Adds a sample at an offset; `opens` begins a chunk with it.
    fn add(&mut self, offset: u64, size: u32, duration: u32, opens: bool) {
        match self.chunks.last_mut().filter(|_| !opens) {
            Some(chunk) => chunk.samples += 1,
            None => self.chunks.push(SampleChunk { offset, samples: 1 }),
        }
        match self.durations.last_mut().filter(|(_, each)| *each == duration) {
            Some((count, _)) => *count += 1,
            None => self.durations.push((1, duration)),
        }
        self.sizes.push(size);
    }
}

/// Returns ticks in a second and in a frame, so that the rate is exact.
pub(super) fn ticks(rate: StageRate) -> (NonZeroU32, u32) {
    let (frames, seconds) = rate.fraction();
    let mut by = 1;
    while frames * by < FEWEST_TICKS {
        by *= 2;
    }
    (NonZeroU32::MIN.saturating_add(frames * by - 1), seconds * by)
}

/// The sound of a movie that is being written.
struct GrowingSound {
    packets: Box<dyn SoundPackets + Send>,
    table: TrackTable,
    /// A packet that could not be written.
    waiting: Option<SoundPacket>,
    is_over: bool,
    /// Why the sound is over before its end.
    error: Option<String>,
}

impl GrowingSound {
    fn new(sound: MovieSound) -> Self {
        let packets = sound.into_packets();
        let table = TrackTable::new(TrackKind::Sound, packets.entry(), packets.timescale());
        Self { packets, table, waiting: None, is_over: false, error: None }
    }

    /// Returns the next packet; `None` at the end, and where the sound cannot be read further: the pictures are worth more than the rest of it.
    fn next(&mut self, most: u32) -> Option<SoundPacket> {
        if self.is_over || self.waiting.is_some() {
            return self.waiting.take();
        }
        let packet = self.packets.next(most).unwrap_or_else(|error| {
            self.error = Some(error);
            None
        });
        self.is_over = packet.is_none();
        packet
    }

    /// Returns a sentence about a sound that could not be read to its end.
    fn notice(&self) -> Option<String> {
        let error = self.error.as_ref()?;
        let seconds = self.table.duration() as f64 / f64::from(self.table.timescale.get());
        Some(format!("The sound ends at {seconds:.2} s, because the rest could not be read: {error}"))
    }
}

/// An MP4 that grows.
pub(crate) struct Mp4File {
    file: GrowingFile,
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
        let mut file = GrowingFile::create(files, path)?;
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
            TrackKind::Pictures { .. } | TrackKind::Sound => {}
        }
        self.end += u64::from(size);
        Ok(())
    }

    /// Adds the sound of the pictures so far: whole packets, or at the end all of it.
    fn add_sound(&mut self, is_end: bool) -> Result<(), MovieError> {
        let (Some(pictures), Some(sound)) = (&self.pictures, &mut self.sound) else { return Ok(()) };
        let until = pictures.duration_in(sound.table.timescale);
        let mut opens = true;
        let mut now = sound.table.duration();
        while now < until {
            let left = u32::try_from(until - now).unwrap_or(u32::MAX);
            if !is_end && left < LONGEST_PACKET {
                break;
            }
            let Some(packet) = sound.next(left) else { break };
            if let Err(error) = self.file.append(&packet.bytes) {
                sound.waiting = Some(packet);
                return Err(error.into());
            }
            let size = packet.bytes.len() as u32;
            sound.table.add(self.end - self.start, size, packet.duration, opens);
            self.end += u64::from(size);
            now += u64::from(packet.duration);
            opens = false;
        }
        Ok(())
    }

    /// Writes the tables. `notices` are those of the pictures.
    pub(crate) fn end(mut self, mut notices: Vec<String>) -> Result<MovieReport, MovieError> {
        self.file.truncate(self.end)?;
        self.add_sound(true)?;
        let pictures = self.pictures.as_ref().filter(|table| !table.sizes.is_empty());
        let sound = self.sound.as_ref().map(|sound| &sound.table).filter(|table| !table.sizes.is_empty());
        let tracks = [pictures.ok_or(MovieError::Empty)?].into_iter().chain(sound).collect();
        let length = self.end - self.start;
        let tables = MovieTables { label: &self.label, tracks, start: self.start, length };
        let tables = tables.encode().map_err(unencoded)?;
        let header = self.start - SAMPLES_HEADER;
        self.file.overwrite(&samples_header(length), header)?;
        self.file.insert(&tables, header)?;
        notices.extend(self.sound.as_ref().and_then(GrowingSound::notice));
        let frames = self.frames();
        let (path, bytes) = self.file.commit()?;
        Ok(MovieReport { frames, path: Some(path), bytes, notices })
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
