//! Packets of a file in memory, found once and copied one after the other.

use crate::sound::head::{SoundHead, SoundPacket, SoundPackets};
use shiguredo_mp4::boxes::SampleEntry;
use std::num::NonZeroU32;

/// Most packets of a file: those of a day in the shortest usual packets.
const MOST_PACKETS: usize = 1 << 23;

/// Why a file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unreadable {
    /// Offset of the byte.
    pub(super) at: usize,
    /// A clause.
    pub(super) reason: String,
}

impl Unreadable {
    pub(super) fn new(at: usize, reason: impl Into<String>) -> Self {
        Self { at, reason: reason.into() }
    }
}

/// A format of files whose packets are copied.
pub(super) struct CopiedFormat {
    /// Title for the user.
    pub(super) title: &'static str,
    /// Returns whether the first bytes after tags are those of this format.
    pub(super) sniff: fn(&[u8]) -> bool,
    /// Finds the packets of a file, which begins at an offset after tags.
    pub(super) read: fn(Vec<u8>, usize) -> Result<CopiedPackets, Unreadable>,
}

/// A packet in a file.
#[derive(Clone, Copy, Debug)]
struct PacketPlace {
    start: usize,
    size: u32,
    duration: u32,
}

/// Packets that were found in a file, in order.
#[derive(Debug, Default)]
pub(super) struct FoundPackets {
    packets: Vec<PacketPlace>,
    ticks: u64,
    bytes: u64,
    longest: u32,
    largest: u32,
}

impl FoundPackets {
    /// Returns the duration of all packets in ticks.
    pub(super) fn ticks(&self) -> u64 {
        self.ticks
    }

    /// Returns the number of bytes of all packets.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Returns the number of bytes of the largest packet.
    pub(super) fn largest(&self) -> u32 {
        self.largest
    }

    /// Returns the duration of the longest packet.
    pub(super) fn longest(&self) -> u32 {
        self.longest
    }

    /// Returns bits per second.
    pub(super) fn bit_rate(&self, timescale: NonZeroU32) -> u32 {
        let bits = u128::from(self.bytes) * 8 * u128::from(timescale.get());
        u32::try_from(bits / u128::from(self.ticks.max(1))).unwrap_or(u32::MAX)
    }

    /// Adds the packet of `size` bytes at `start`.
    pub(super) fn add(&mut self, start: usize, size: usize, duration: u32) -> Result<(), Unreadable> {
        if self.packets.len() == MOST_PACKETS {
            return Err(Unreadable::new(start, format!("there are more than {MOST_PACKETS} packets")));
        }
        let size = u32::try_from(size).map_err(|_| Unreadable::new(start, "a packet is too large"))?;
        self.packets.push(PacketPlace { start, size, duration });
        self.ticks += u64::from(duration);
        self.bytes += u64::from(size);
        self.longest = self.longest.max(duration);
        self.largest = self.largest.max(size);
        Ok(())
    }

    /// Returns the packets, which are in `bytes`; an error if there are none.
    pub(super) fn end(self, bytes: Vec<u8>, about: CopiedHead) -> Result<CopiedPackets, Unreadable> {
        if self.ticks == 0 {
            return Err(Unreadable::new(bytes.len(), "it has no sound"));
        }
        let CopiedHead { entry, timescale, skip, played, roll } = about;
        let head = SoundHead { entry, timescale, longest: self.longest, skip, played, roll };
        Ok(CopiedPackets { head, bytes, packets: self.packets, next: 0 })
    }
}

/// The part of a [`SoundHead`] that a format reads.
pub(super) struct CopiedHead {
    pub(super) entry: SampleEntry,
    pub(super) timescale: NonZeroU32,
    pub(super) skip: u64,
    pub(super) played: Option<u64>,
    pub(super) roll: u16,
}

/// Packets that are copied.
pub(in crate::sound) struct CopiedPackets {
    head: SoundHead,
    bytes: Vec<u8>,
    packets: Vec<PacketPlace>,
    next: usize,
}

impl SoundPackets for CopiedPackets {
    fn head(&self) -> SoundHead {
        self.head.clone()
    }

    fn next(&mut self, _most: u32) -> Result<Option<SoundPacket>, String> {
        let Some(place) = self.packets.get(self.next) else { return Ok(None) };
        let bytes = self.bytes.get(place.start..).and_then(|bytes| bytes.get(..place.size as usize));
        let bytes = bytes.ok_or_else(|| format!("its packet {} is outside of the file", self.next))?;
        self.next += 1;
        Ok(Some(SoundPacket { bytes: bytes.to_vec(), duration: place.duration }))
    }
}
