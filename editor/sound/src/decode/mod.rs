//! Sound files as samples, block by block. A format is one file here and one row of [`SOUND_FORMATS`].

mod flac;
mod mp3;
mod vorbis;
mod wav;

use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

/// Largest file, bytes.
const LARGEST_FILE: u64 = 4 << 30;
/// Largest number of channels.
const MOST_CHANNELS: usize = 64;
/// Bytes at the start of a file by which formats are recognized.
const START: usize = 16;

/// Begins to decode a file.
type OpenDecoder = fn(BufReader<File>) -> Result<Box<dyn Decoder>, String>;

/// A format of sound files.
#[derive(Clone, Copy, Debug)]
pub struct SoundFormat {
    /// Name for messages.
    pub title: &'static str,
    /// Extensions of file names, lower case.
    pub extensions: &'static [&'static str],
    /// Returns whether the first bytes of a file are those of this format.
    pub sniff: fn(&[u8]) -> bool,
    open: OpenDecoder,
}

/// All formats.
pub const SOUND_FORMATS: &[SoundFormat] = &[wav::WAV, flac::FLAC, vorbis::VORBIS, mp3::MP3];

/// A decoder in the middle of a file.
trait Decoder {
    /// Returns samples per second.
    fn rate(&self) -> u32;

    /// Returns the number of channels.
    fn channels(&self) -> usize;

    /// Adds the next samples to `out`, from -1 to 1, those of all channels one after the other. Returns false at the end.
    fn read(&mut self, out: &mut Vec<f32>) -> Result<bool, String>;
}

/// A sound file that is read from its start to its end.
pub struct SoundReader {
    decoder: Box<dyn Decoder>,
    block: Vec<f32>,
}

impl std::fmt::Debug for SoundReader {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "SoundReader({} channels, {} Hz)", self.channels(), self.rate())
    }
}

impl SoundReader {
    /// Begins to read a file; `name` is for messages.
    ///
    /// # Errors
    ///
    /// A sentence: the file cannot be read, is damaged, or of another format.
    pub fn new(mut file: File, name: &str) -> Result<Self, String> {
        let about = file.metadata().map_err(|error| error.to_string())?;
        if !about.is_file() || about.len() > LARGEST_FILE {
            return Err(format!("it is no file of at most {} GB", LARGEST_FILE >> 30));
        }
        let mut start = [0; START];
        let mut length = 0;
        while length < START {
            match file.read(&mut start[length..]).map_err(|error| error.to_string())? {
                0 => break,
                more => length += more,
            }
        }
        file.rewind().map_err(|error| error.to_string())?;
        let format =
            SOUND_FORMATS.iter().find(|format| (format.sniff)(&start[..length])).ok_or_else(|| {
                let titles: Vec<&str> = SOUND_FORMATS.iter().map(|format| format.title).collect();
                format!("it is none of {}; convert it: ffmpeg -i {name} sound.wav", titles.join(", "))
            })?;
        let reader = BufReader::with_capacity(1 << 16, file);
        let decoder = guarded(|| (format.open)(reader))?;
        let (rate, channels) = (decoder.rate(), decoder.channels());
        if rate == 0 || channels == 0 || channels > MOST_CHANNELS {
            return Err(format!("it has {channels} channels with {rate} samples per second"));
        }
        Ok(Self { decoder, block: Vec::new() })
    }

    /// Returns samples per second; at least 1.
    pub fn rate(&self) -> u32 {
        self.decoder.rate()
    }

    /// Returns the number of channels, 1 to 64.
    pub fn channels(&self) -> usize {
        self.decoder.channels()
    }

    /// Returns the next samples, from -1 to 1, those of all channels one after the other; `None` at the end.
    ///
    /// # Errors
    ///
    /// The reason why the rest of the file cannot be decoded.
    pub fn next_block(&mut self) -> Result<Option<&[f32]>, String> {
        self.block.clear();
        let Self { decoder, block } = self;
        // A decoder may return an empty block before the end.
        while block.is_empty() {
            if !guarded(|| decoder.read(block))? {
                break;
            }
        }
        Ok((!self.block.is_empty()).then_some(&self.block))
    }
}

/// Runs a decoder of another crate. One that panics is like one that fails.
fn guarded<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(work))
        .unwrap_or_else(|_| Err("the decoder failed".to_owned()))
}

/// Returns whether a file is a sound by its name.
pub fn is_sound_file(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    SOUND_FORMATS.iter().any(|format| format.extensions.contains(&extension.as_str()))
}
