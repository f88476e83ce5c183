//! Sound of a movie: packets that are copied from a file, or encoded from samples.

mod bits;
mod copy;
mod flac;
mod head;

pub use head::ReadSamples;
pub(crate) use head::{SoundPacket, SoundPackets};

use crate::error::MovieError;
use std::fmt;

/// The sound of a movie, from its start on; what is longer than the movie is cut.
pub struct MovieSound(Box<dyn SoundPackets + Send>);

impl fmt::Debug for MovieSound {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "MovieSound({} per second)", self.0.head().timescale)
    }
}

impl MovieSound {
    /// Creates a sound of samples, `rate` per second for each of `channels` channels. It is encoded without loss, with 16 bits.
    ///
    /// # Errors
    /// When there are no channels or more than 8, or a rate that is 0 or above 655,350.
    pub fn samples(rate: u32, channels: usize, read: ReadSamples) -> Result<Self, MovieError> {
        let encoder = flac::FlacEncoder::new(rate, channels, read).map_err(MovieError::Sound)?;
        Ok(Self(Box::new(encoder)))
    }

    /// Creates a sound of the packets of a file, given as its bytes, which are copied without encoding them again: AAC (also in an MP4), FLAC,
    /// Opus (in Ogg or MP4) and MP3. All of the file is examined at once, and it stays in memory.
    ///
    /// # Errors
    /// When the file has another format, or is damaged; the message has the offset of the byte. Such a sound may still be decoded by another
    /// program or crate, and given as samples.
    pub fn copied(file: Vec<u8>) -> Result<Self, MovieError> {
        let packets = copy::read(file).map_err(MovieError::Sound)?;
        Ok(Self(Box::new(packets)))
    }

    /// Returns the title of the format of a file that [`Self::copied`] reads, by its first bytes; `None` for another format. More than the first
    /// thousand bytes are needed only after tags.
    pub fn copied_format(start: &[u8]) -> Option<&'static str> {
        copy::format_of(start)
    }

    pub(crate) fn into_packets(self) -> Box<dyn SoundPackets + Send> {
        self.0
    }
}
