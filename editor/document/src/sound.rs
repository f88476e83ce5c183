//! Sound files as peaks for a waveform: WAV, FLAC and Ogg Vorbis. Everything here reads files and is called in jobs.

use super::Cancel;
use super::folder::open_file;
use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

/// Number of samples of a block of the finest level.
const BLOCK: u64 = 64;
/// Number of blocks of a level that are one block of the next.
const FACTOR: usize = 4;
/// Largest number of samples of a channel: about twelve hours.
const MOST_SAMPLES: u64 = 1 << 31;
/// Largest file, bytes.
const LARGEST_FILE: u64 = 4 << 30;
/// Largest number of channels.
const MOST_CHANNELS: usize = 64;

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
    /// Reads a sound file that the user named.
    ///
    /// # Errors
    ///
    /// A sentence for the user: the file cannot be read, is damaged, too long, or of another format.
    pub fn read(path: &Path, cancel: &Cancel) -> Result<Self, String> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let file = open_file(path).map_err(|error| format!("{name} {error}"))?;
        Self::read_from(file, &name, cancel)
    }

    /// Reads a sound file that is open; `name` is for messages.
    ///
    /// # Errors
    ///
    /// As [`Self::read`].
    pub fn read_from(mut file: File, name: &str, cancel: &Cancel) -> Result<Self, String> {
        let wrong = |reason: &dyn std::fmt::Display| format!("{name} cannot be read: {reason}");
        let about = file.metadata().map_err(|error| wrong(&error))?;
        if !about.is_file() || about.len() > LARGEST_FILE {
            return Err(wrong(&format!("it is no file of at most {} GB", LARGEST_FILE >> 30)));
        }
        let mut start = [0; 4];
        file.read_exact(&mut start).and_then(|()| file.rewind()).map_err(|error| wrong(&error))?;
        let reader = BufReader::with_capacity(1 << 16, file);
        let read = std::panic::AssertUnwindSafe(|| match &start {
            b"RIFF" => wav(reader, cancel),
            b"fLaC" => flac(reader, cancel),
            b"OggS" => vorbis(reader, cancel),
            _ => {
                Err(format!("it is neither WAV, FLAC nor Ogg Vorbis; convert it: ffmpeg -i {name} sound.wav"))
            }
        });
        // A decoder that panics loses only its sound.
        let peaks = std::panic::catch_unwind(read).unwrap_or_else(|_| Err("the decoder failed".to_owned()));
        peaks.map_err(|reason| wrong(&reason))
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
    fn new(rate: u32, channels: usize, cancel: &'a Cancel) -> Result<Self, String> {
        if rate == 0 || channels == 0 || channels > MOST_CHANNELS {
            return Err(format!("it has {channels} channels with {rate} samples per second"));
        }
        Ok(Self { cancel, rate, channels, values: 0, now: None, blocks: Vec::new() })
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

fn wav(reader: BufReader<File>, cancel: &Cancel) -> Result<SoundPeaks, String> {
    let mut reader = hound::WavReader::new(reader).map_err(|error| error.to_string())?;
    let spec = reader.spec();
    let mut peaks = PeakCollector::new(spec.sample_rate, usize::from(spec.channels), cancel)?;
    match spec.sample_format {
        hound::SampleFormat::Float => {
            for sample in reader.samples::<f32>() {
                peaks.push(sample.map_err(|error| error.to_string())?)?;
            }
        }
        hound::SampleFormat::Int => {
            let full = 2f32.powi(i32::from(spec.bits_per_sample.clamp(1, 32)) - 1);
            for sample in reader.samples::<i32>() {
                peaks.push(sample.map_err(|error| error.to_string())? as f32 / full)?;
            }
        }
    }
    peaks.finish()
}

fn flac(reader: BufReader<File>, cancel: &Cancel) -> Result<SoundPeaks, String> {
    let mut reader = claxon::FlacReader::new(reader).map_err(|error| error.to_string())?;
    let about = reader.streaminfo();
    let mut peaks = PeakCollector::new(about.sample_rate, about.channels as usize, cancel)?;
    let full = 2f32.powi(about.bits_per_sample.clamp(1, 32) as i32 - 1);
    for sample in reader.samples() {
        peaks.push(sample.map_err(|error| error.to_string())? as f32 / full)?;
    }
    peaks.finish()
}

fn vorbis(reader: BufReader<File>, cancel: &Cancel) -> Result<SoundPeaks, String> {
    let text = |error: lewton::VorbisError| error.to_string();
    let mut reader = lewton::inside_ogg::OggStreamReader::new(reader).map_err(text)?;
    let about = &reader.ident_hdr;
    let channels = usize::from(about.audio_channels);
    let mut peaks = PeakCollector::new(about.audio_sample_rate, channels, cancel)?;
    while let Some(packet) = reader.read_dec_packet_itl().map_err(text)? {
        for sample in packet {
            peaks.push(f32::from(sample) / 32768.0)?;
        }
    }
    peaks.finish()
}
