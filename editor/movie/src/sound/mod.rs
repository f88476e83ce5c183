//! Sound of a movie: packets that are copied from a file, or encoded from samples.

mod bits;
mod flac;

use crate::error::MovieError;
use shiguredo_mp4::boxes::SampleEntry;
use std::fmt;
use std::num::NonZeroU32;

/// Appends the next samples of all channels, one after the other, from -1 to 1. Returns false at the end; an error is a clause. A source that
/// gives none many times in a row without an end counts as one that cannot be read.
pub type ReadSamples = Box<dyn FnMut(&mut Vec<f32>) -> Result<bool, String> + Send>;

/// The sound of a movie, from its start on; what is longer than the movie is cut.
pub struct MovieSound(Box<dyn SoundPackets + Send>);

impl fmt::Debug for MovieSound {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "MovieSound({} per second)", self.0.timescale())
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

/// Largest duration of a packet in ticks.
pub(crate) const LONGEST_PACKET: u32 = 8192;

/// A packet of sound.
#[derive(Clone, Debug, Default)]
pub(crate) struct SoundPacket {
    pub(crate) bytes: Vec<u8>,
    /// Duration in ticks.
    pub(crate) duration: u32,
}

/// Packets of sound in order.
pub(crate) trait SoundPackets {
    /// Returns ticks in a second.
    fn timescale(&self) -> NonZeroU32;

    /// Returns the description of the packets.
    fn entry(&self) -> SampleEntry;

    /// Returns the next packet, of at most [`LONGEST_PACKET`] ticks; of at most `most` where packets can be made shorter; `None` at the end. An
    /// error is a clause.
    fn next(&mut self, most: u32) -> Result<Option<SoundPacket>, String>;
}
