//! Sound of a movie: packets that are copied from a file, or encoded from samples.

mod bits;
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

    pub(crate) fn into_packets(self) -> Box<dyn SoundPackets + Send> {
        self.0
    }
}
