//! Opus in Ogg, whose pages the crate `ogg` reads.

use super::packets::{CopiedFormat, CopiedHead, CopiedPackets, FoundPackets, Unreadable};
use ogg::{OggReadError, Packet, PacketReader};
use shiguredo_mp4::bitstream::opus::{ChannelCount, OpusSampleEntryConfig, build_opus_box};
use shiguredo_mp4::boxes::SampleEntry;
use std::cell::Cell;
use std::io::{Cursor, Read, Seek, SeekFrom};
use std::num::NonZeroU32;

pub(super) const OPUS: CopiedFormat = CopiedFormat {
    title: "Opus",
    sniff: |start| {
        start.starts_with(b"OggS") && start.windows(HEAD.len()).take(SNIFFED).any(|found| found == HEAD)
    },
    read,
};

/// Start of the first packet.
const HEAD: &[u8] = b"OpusHead";
/// Number of bytes of a file in which the first packet of Opus begins: other streams may begin before it.
const SNIFFED: usize = 1_000;
/// Ticks in a second, whatever the rate of the samples was.
const TIMESCALE: NonZeroU32 = NonZeroU32::MIN.saturating_add(48_000 - 1);
/// Ticks that a decoder needs before those that it plays.
const PRE_ROLL: u32 = 3_840;
/// Longest packet in ticks.
const LONGEST: u32 = 5_760;
/// Position of a page on which no packet ends.
const NOWHERE: u64 = u64::MAX;

/// Bytes that are read, and how far.
struct Pages<'a> {
    bytes: Cursor<&'a [u8]>,
    at: &'a Cell<u64>,
}

impl Read for Pages<'_> {
    fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
        let read = self.bytes.read(out)?;
        self.at.set(self.bytes.position());
        Ok(read)
    }
}

impl Seek for Pages<'_> {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        let at = self.bytes.seek(to)?;
        self.at.set(at);
        Ok(at)
    }
}

/// The packets of the stream so far.
#[derive(Default)]
struct OpusStream {
    serial: u32,
    bytes: Vec<u8>,
    found: FoundPackets,
    /// Ticks before the first packet: a stream may begin in the middle of another.
    before: Option<u64>,
    /// Position of the last page.
    last: u64,
}

impl OpusStream {
    /// Adds a packet; an error is a clause.
    fn add(&mut self, packet: &Packet, at: usize) -> Result<(), Unreadable> {
        let wrong = |reason: &str| Unreadable::new(at, reason);
        let duration =
            duration(&packet.data).ok_or_else(|| wrong("a packet has no duration, or a wrong one"))?;
        self.found.add(self.bytes.len(), packet.data.len(), duration)?;
        self.bytes.extend_from_slice(&packet.data);
        let position = packet.absgp_page();
        if !packet.last_in_page() || position == NOWHERE {
            return Ok(());
        }
        let ticks = self.found.ticks();
        let before = match self.before {
            Some(before) => before,
            // Only the end of a stream is at a position before the end of its packet.
            None if position < ticks && !packet.last_in_stream() => {
                return Err(wrong("the first page ends before its packets"));
            }
            None => *self.before.insert(position.saturating_sub(ticks)),
        };
        if position < self.last || position > before.saturating_add(ticks) {
            return Err(wrong("a page ends before the one before it, or after its packets"));
        }
        self.last = position;
        Ok(())
    }
}

fn read(file: Vec<u8>, start: usize) -> Result<CopiedPackets, Unreadable> {
    let at = Cell::new(0);
    let place = || start + at.get() as usize;
    let unread = |error: OggReadError| Unreadable::new(place(), problem(&error));
    let bytes = Cursor::new(file.get(start..).unwrap_or_default());
    let mut reader = PacketReader::new(Pages { bytes, at: &at });
    let no_head = || Unreadable::new(place(), "there is no stream of Opus");
    let head = loop {
        let packet = reader.read_packet().map_err(unread)?.ok_or_else(no_head)?;
        if packet.data.starts_with(HEAD) {
            break packet;
        }
        if !packet.first_in_stream() {
            return Err(no_head());
        }
    };
    let config = config(&head.data).map_err(|reason| Unreadable::new(place(), reason))?;
    let mut stream = OpusStream { serial: head.stream_serial(), ..OpusStream::default() };
    let mut is_titled = false;
    while let Some(packet) = reader.read_packet().map_err(unread)? {
        // Other streams, such as pictures, are between the pages of this one.
        if packet.stream_serial() != stream.serial {
            if packet.data.starts_with(HEAD) {
                return Err(Unreadable::new(place(), "another stream of Opus follows"));
            }
        } else if is_titled {
            stream.add(&packet, place())?;
        } else if packet.data.starts_with(b"OpusTags") {
            is_titled = true;
        } else {
            return Err(Unreadable::new(place(), "the titles are missing"));
        }
    }
    let OpusStream { bytes, found, before, last, .. } = stream;
    let skip = u64::from(config.pre_skip);
    // The position of the last page cuts what its last packet has too much.
    let all = before.map_or_else(|| found.ticks(), |before| last - before);
    let played = (all < found.ticks()).then(|| all.saturating_sub(skip));
    let roll = roll(found.longest());
    let entry = SampleEntry::Opus(build_opus_box(&config));
    found.end(bytes, CopiedHead { entry, timescale: TIMESCALE, skip, played, roll })
}

/// Returns the number of packets that a decoder needs before the one from which it plays; `longest` is the duration of the longest.
pub(super) fn roll(longest: u32) -> u16 {
    PRE_ROLL.div_ceil(longest.max(1)) as u16
}

/// Returns an error of the reader of pages as a clause.
fn problem(error: &OggReadError) -> &'static str {
    match error {
        OggReadError::NoCapturePatternFound => "there is no page",
        OggReadError::InvalidStreamStructVer(_) => "the page has an unknown version",
        OggReadError::HashMismatch(_, _) => "the page before is damaged: its checksum is wrong",
        OggReadError::ReadError(_) => "the file ends in a page",
        OggReadError::InvalidData => "a page is missing",
    }
}

/// Reads the first packet; an error is a clause.
fn config(head: &[u8]) -> Result<OpusSampleEntryConfig, &'static str> {
    let &[version, channels, skip_low, skip_high, a, b, c, d, gain_low, gain_high, family] =
        head.get(8..).and_then(|rest| rest.first_chunk()).ok_or("the first packet is too short")?;
    if version > 15 {
        return Err("its version is unknown");
    }
    let channel_count = match (family, channels) {
        (0, 1) => ChannelCount::Mono,
        (0, 2) => ChannelCount::Stereo,
        _ => return Err("it has more than two channels, or an order of its own, which cannot be copied"),
    };
    Ok(OpusSampleEntryConfig {
        channel_count,
        pre_skip: u16::from_le_bytes([skip_low, skip_high]),
        input_sample_rate: u32::from_le_bytes([a, b, c, d]),
        output_gain: i16::from_le_bytes([gain_low, gain_high]),
    })
}

/// Returns the duration of a packet in ticks; `None` for one that no decoder accepts.
fn duration(packet: &[u8]) -> Option<u32> {
    let (kind, rest) = packet.split_first()?;
    let frame = match kind >> 3 {
        speech @ 0..=11 => [480, 960, 1920, 2880][usize::from(speech & 3)],
        hybrid @ 12..=15 => [480, 960][usize::from(hybrid & 1)],
        music => [120, 240, 480, 960][usize::from(music & 3)],
    };
    let frames = match kind & 3 {
        0 => 1,
        1 | 2 => 2,
        _ => u32::from(rest.first()? & 63),
    };
    Some(frame * frames).filter(|duration| (1..=LONGEST).contains(duration))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_byte_of_a_packet_gives_its_duration() {
        // Speech of 20 ms, twice; music of 2.5 ms; hybrid of 20 ms; music of 20 ms, six and seven times.
        let cases: [(&[u8], Option<u32>); 7] = [
            (&[1 << 3 | 1], Some(1920)),
            (&[16 << 3], Some(120)),
            (&[13 << 3], Some(960)),
            (&[31 << 3 | 3, 6], Some(5760)),
            (&[31 << 3 | 3, 7], None),
            (&[31 << 3 | 3, 0], None),
            (&[], None),
        ];
        for (packet, wanted) in cases {
            assert_eq!(duration(packet), wanted, "{packet:?}");
        }
    }
}
