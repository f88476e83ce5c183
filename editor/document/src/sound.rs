//! Sound files as peaks for a waveform. Everything here reads files and is called in jobs.

use super::Cancel;
use super::folder::{FileAccessError, Folder, open_file};
use dragonfly_sound::{SoundReader, SoundSamples};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Number of samples of a block of the finest level.
const BLOCK: u64 = 64;
/// Number of blocks of a level that are one block of the next.
const FACTOR: usize = 4;
/// Largest number of samples of a channel: about twelve hours.
const MOST_SAMPLES: u64 = 1 << 31;

/// Least and greatest sample of a block, in 127ths of full scale.
type BlockPeak = [i8; 2];

/// The peaks of a sound at several resolutions, all channels together. It keeps no samples.
#[derive(Clone, Debug, PartialEq)]
pub struct SoundPeaks {
    /// Samples per second.
    rate: u32,
    samples: u64,
    channels: usize,
    /// From the finest to the coarsest level.
    levels: Vec<Vec<BlockPeak>>,
}

impl SoundPeaks {
    fn of(reader: &mut SoundReader, cancel: &Cancel) -> Result<Self, String> {
        let mut peaks = PeakCollector::new(reader, cancel);
        while let Some(block) = reader.next_block()? {
            block.iter().try_for_each(|&sample| peaks.push(sample))?;
        }
        peaks.finish()
    }

    /// Returns its length in seconds.
    pub fn seconds(&self) -> f64 {
        self.samples as f64 / f64::from(self.rate.max(1))
    }

    /// Returns samples per second.
    pub fn rate(&self) -> u32 {
        self.rate
    }

    /// Returns the number of channels.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Returns the size of its peaks in bytes.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(|level| size_of_val(level.as_slice())).sum()
    }

    /// Returns the least and the greatest sample between two times, seconds, each from -1 to 1; `None` outside of the sound. It looks at
    /// a few blocks, however long that is.
    pub fn between(&self, from: f64, to: f64) -> Option<[f32; 2]> {
        let rate = f64::from(self.rate);
        let (from, to) = ((from * rate).max(0.0), (to * rate).min(self.samples as f64));
        (from < to).then_some(())?;
        let (mut block, mut level) = (BLOCK as f64, 0);
        while level + 1 < self.levels.len() && (to - from) / block >= 2.0 * FACTOR as f64 {
            (block, level) = (block * FACTOR as f64, level + 1);
        }
        let blocks = self.levels.get(level)?;
        let first = (from / block) as usize;
        let end = ((to / block).ceil() as usize).min(blocks.len());
        let peak = blocks.get(first..end)?.iter().copied().reduce(joined)?;
        Some(peak.map(|number| f32::from(number) / 127.0))
    }
}

fn joined(a: BlockPeak, b: BlockPeak) -> BlockPeak {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// A sound file by its place.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SoundSource {
    /// A file that the user chose.
    File(PathBuf),
    /// A file in a folder or below it, as a script names it; what leads elsewhere is refused.
    Below {
        /// The folder.
        folder: PathBuf,
        /// The name in the script.
        name: String,
    },
}

/// The state of a sound file, by which a later change is noticed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SoundStamp {
    written: SystemTime,
    bytes: u64,
}

impl SoundSource {
    /// Returns the present state of the file; `None` where it cannot be opened.
    pub fn stamp(&self) -> Option<SoundStamp> {
        let data = self.open().1.ok()?.metadata().ok()?;
        Some(SoundStamp { written: data.modified().ok()?, bytes: data.len() })
    }

    /// Reads the peaks of the sound.
    ///
    /// # Errors
    ///
    /// A sentence for the user: the file cannot be read, is damaged, too long, or of another format.
    pub fn peaks(&self, cancel: &Cancel) -> Result<SoundPeaks, String> {
        self.read(|reader| SoundPeaks::of(reader, cancel))
    }

    /// Reads the samples of the sound, to be played.
    ///
    /// # Errors
    ///
    /// As for [`Self::peaks`].
    pub fn samples(&self, cancel: &Cancel) -> Result<SoundSamples, String> {
        self.read(|reader| SoundSamples::read(reader, &|| cancel.is_cancelled()))
    }

    /// Checks that the sound can be read: its format, and its first samples.
    ///
    /// # Errors
    ///
    /// As for [`Self::peaks`].
    pub(super) fn check(&self) -> Result<(), String> {
        self.read(|reader| match reader.next_block()? {
            Some(_) => Ok(()),
            None => Err("it has no samples".to_owned()),
        })
    }

    fn read<T>(&self, read: impl FnOnce(&mut SoundReader) -> Result<T, String>) -> Result<T, String> {
        let (name, file) = self.open();
        let file = file.map_err(|error| format!("{name} {error}"))?;
        let read = SoundReader::new(file, &name).and_then(|mut reader| read(&mut reader));
        read.map_err(|reason| format!("{name} cannot be read: {reason}"))
    }

    /// Opens the file. Returns its name for the user, too.
    fn open(&self) -> (String, Result<File, FileAccessError>) {
        match self {
            Self::File(path) => {
                (path.file_name().unwrap_or_default().to_string_lossy().into_owned(), open_file(path))
            }
            Self::Below { folder, name } => {
                let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
                (name.clone(), Folder::new(folder).and_then(|folder| folder.open(name)))
            }
        }
    }
}

/// Collects the peaks of samples as they are decoded.
struct PeakCollector<'a> {
    cancel: &'a Cancel,
    rate: u32,
    channels: usize,
    /// Samples of all channels so far.
    values: u64,
    now: Option<BlockPeak>,
    blocks: Vec<BlockPeak>,
}

impl<'a> PeakCollector<'a> {
    fn new(reader: &SoundReader, cancel: &'a Cancel) -> Self {
        let (rate, channels) = (reader.rate(), reader.channels());
        Self { cancel, rate, channels, values: 0, now: None, blocks: Vec::new() }
    }

    /// Adds the next sample, -1 to 1; those of all channels follow one another.
    fn push(&mut self, sample: f32) -> Result<(), String> {
        let number = if sample.is_finite() { (sample.clamp(-1.0, 1.0) * 127.0).round() as i8 } else { 0 };
        let peak = [number, number];
        self.now = Some(self.now.map_or(peak, |now| joined(now, peak)));
        self.values += 1;
        if self.values.is_multiple_of(BLOCK * self.channels as u64) {
            self.blocks.extend(self.now.take());
            if self.values / self.channels as u64 > MOST_SAMPLES {
                return Err("it is longer than twelve hours".to_owned());
            }
            if self.cancel.is_cancelled() {
                return Err("cancelled".to_owned());
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<SoundPeaks, String> {
        self.blocks.extend(self.now.take());
        if self.blocks.is_empty() {
            return Err("it has no samples".to_owned());
        }
        let mut levels = vec![self.blocks];
        while let Some(last) = levels.last().filter(|last| last.len() > FACTOR) {
            let next = last.chunks(FACTOR).filter_map(|part| part.iter().copied().reduce(joined)).collect();
            levels.push(next);
        }
        let samples = self.values / self.channels as u64;
        Ok(SoundPeaks { rate: self.rate, samples, channels: self.channels, levels })
    }
}
