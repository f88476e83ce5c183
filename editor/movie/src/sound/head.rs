//! Packets of sound, and what is known of them before the first one.

use shiguredo_mp4::boxes::SampleEntry;
use std::num::NonZeroU32;

/// Appends the next samples of all channels, one after the other, from -1 to 1. Returns false at the end; an error is a clause. A source that
/// gives none many times in a row without an end counts as one that cannot be read.
pub type ReadSamples = Box<dyn FnMut(&mut Vec<f32>) -> Result<bool, String> + Send>;

/// The description of a sound.
#[derive(Clone, Debug)]
pub(crate) struct SoundHead {
    /// The description of the packets in an MP4.
    pub(crate) entry: SampleEntry,
    /// Ticks in a second.
    pub(crate) timescale: NonZeroU32,
    /// Largest duration of a packet in ticks.
    pub(crate) longest: u32,
    /// Number of ticks at the start that are decoded and not played.
    pub(crate) skip: u64,
    /// Number of ticks after these that are played; `None` for all.
    pub(crate) played: Option<u64>,
    /// Number of packets that a decoder needs before the one from which it plays.
    pub(crate) roll: u16,
}

/// A packet of sound.
#[derive(Clone, Debug, Default)]
pub(crate) struct SoundPacket {
    pub(crate) bytes: Vec<u8>,
    /// Duration in ticks.
    pub(crate) duration: u32,
}

/// Packets of sound in order.
pub(crate) trait SoundPackets {
    /// Returns the description of the sound.
    fn head(&self) -> SoundHead;

    /// Returns the next packet; of at most `most` ticks where packets can be made shorter; `None` at the end. An error is a clause.
    fn next(&mut self, most: u32) -> Result<Option<SoundPacket>, String>;
}
