//! The sound of an MP4 that grows: packets are taken until the pictures end.

use super::track::{PlayedPart, TrackKind, TrackTable};
use crate::sound::{MovieSound, SoundPacket, SoundPackets};

/// The sound of a movie that is being written.
pub(super) struct GrowingSound {
    packets: Box<dyn SoundPackets + Send>,
    pub(super) table: TrackTable,
    /// Largest duration of a packet in ticks.
    longest: u32,
    /// Ticks at the start that are not played, and those after them that are.
    skip: u64,
    played: Option<u64>,
    /// A packet that could not be written.
    waiting: Option<SoundPacket>,
    is_over: bool,
    /// Why the sound is over before its end.
    error: Option<String>,
}

impl GrowingSound {
    pub(super) fn new(sound: MovieSound) -> Self {
        let packets = sound.into_packets();
        let head = packets.head();
        let table = TrackTable::new(TrackKind::Sound { roll: head.roll }, head.entry, head.timescale);
        let (longest, skip, played) = (head.longest, head.skip, head.played);
        Self { packets, table, longest, skip, played, waiting: None, is_over: false, error: None }
    }

    /// Returns the next packet while one is missing to play for as long as the pictures; only packets that end before, unless this is the end.
    pub(super) fn next(&mut self, pictures: &TrackTable, is_end: bool) -> Option<SoundPacket> {
        let until = self.skip.saturating_add(pictures.played_in(self.table.timescale));
        let missing = until.saturating_sub(self.table.duration());
        let missing = u32::try_from(missing).unwrap_or(u32::MAX);
        if missing == 0 || (!is_end && missing < self.longest) {
            return None;
        }
        if self.is_over || self.waiting.is_some() {
            return self.waiting.take();
        }
        // The pictures are worth more than the rest of a sound that cannot be read further.
        let packet = self.packets.next(missing).unwrap_or_else(|error| {
            self.error = Some(error);
            None
        });
        self.is_over = packet.is_none();
        packet
    }

    /// Takes a packet back that could not be written: it is the next one.
    pub(super) fn keep(&mut self, packet: SoundPacket) {
        self.waiting = Some(packet);
    }

    /// Ends the sound at an offset in the file; no packet follows.
    pub(super) fn cut(&mut self, offset: u64) {
        self.table.cut(offset);
        self.waiting = None;
        self.is_over = true;
    }

    /// Returns the table with the part that is played along with the pictures; `None` if nothing is.
    pub(super) fn ended(&mut self, pictures: &TrackTable) -> Option<&TrackTable> {
        if self.skip > 0 || self.played.is_some() {
            let left = self.table.duration().saturating_sub(self.skip);
            let most = pictures.played_within(self.table.timescale);
            let played = left.min(self.played.unwrap_or(left)).min(most);
            self.table.edit = Some(PlayedPart { skip: self.skip, played });
        }
        Some(&self.table).filter(|table| table.played() > 0)
    }

    /// Returns a sentence about a sound that could not be read to its end.
    pub(super) fn notice(&self) -> Option<String> {
        let error = self.error.as_ref()?;
        let seconds = self.table.duration() as f64 / f64::from(self.table.timescale.get());
        Some(format!("The sound ends at {seconds:.2} s, because the rest could not be read: {error}"))
    }
}
