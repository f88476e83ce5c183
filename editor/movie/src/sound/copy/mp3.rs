//! MP3: frames of MPEG layer III, each with a header that gives its length. A first frame without sound may contain how many samples the encoder
//! added at both ends.

use super::packets::{CopiedFormat, CopiedHead, CopiedPackets, FoundPackets, Unreadable};
use super::tag;
use shiguredo_mp4::boxes::{AudioSampleEntryFields, EsdsBox, Mp4aBox, SampleEntry};
use shiguredo_mp4::descriptors::{DecoderConfigDescriptor, EsDescriptor, SlConfigDescriptor};
use shiguredo_mp4::{FixedPointNumber, Uint};
use std::num::NonZeroU32;

pub(super) const MP3: CopiedFormat =
    CopiedFormat { title: "MP3", sniff: |start| Mp3Header::read(start).is_ok(), read };

/// Kinds of objects of MPEG-1 and MPEG-2 audio in an MP4.
pub(super) const MPEG1: u8 = 0x6B;
pub(super) const MPEG2: u8 = 0x69;

/// Samples that every decoder adds at the start.
const DECODER_DELAY: u64 = 529;

/// Bit rates of MPEG-1 and of MPEG-2 in thousands, by their index from 1.
const BIT_RATES: [[u32; 14]; 2] = [
    [32, 40, 48, 56, 64, 80, 96, 112, 128, 160, 192, 224, 256, 320],
    [8, 16, 24, 32, 40, 48, 56, 64, 80, 96, 112, 128, 144, 160],
];

/// Samples per second of MPEG-1; later versions have half and a quarter.
const RATES: [u32; 3] = [44_100, 48_000, 32_000];

/// The header of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Mp3Header {
    /// Whether it is MPEG-1, whose frames have twice the samples.
    is_first_version: bool,
    rate: u32,
    channels: u16,
    /// Number of bytes of the frame.
    length: usize,
}

impl Mp3Header {
    /// Reads a header; an error is a clause.
    fn read(bytes: &[u8]) -> Result<Self, &'static str> {
        let &[first, second, third, fourth, ..] = bytes else { return Err("the file ends in a header") };
        if first != 0xFF || second & 0xE0 != 0xE0 {
            return Err("there is no frame");
        }
        let halvings = match second >> 3 & 3 {
            0b11 => 0,
            0b10 => 1,
            0b00 => 2,
            _ => return Err("the frame has an unknown version"),
        };
        if second >> 1 & 3 != 0b01 {
            return Err("the frame is not of layer III");
        }
        let bit_rate = match third >> 4 {
            0 => return Err("the frame has no bit rate, and so no length"),
            index => BIT_RATES[usize::from(halvings > 0)].get(usize::from(index) - 1),
        };
        let bit_rate = *bit_rate.ok_or("the frame has an unknown bit rate")?;
        let rate =
            *RATES.get(usize::from(third >> 2 & 3)).ok_or("the frame has an unknown rate")? >> halvings;
        let is_first_version = halvings == 0;
        let padding = usize::from(third >> 1 & 1);
        let eighths = if is_first_version { 144 } else { 72 };
        let length = (eighths * bit_rate * 1000 / rate) as usize + padding;
        Ok(Self { is_first_version, rate, channels: if fourth >> 6 == 3 { 1 } else { 2 }, length })
    }

    /// Returns the number of samples of a frame.
    fn samples(self) -> u32 {
        if self.is_first_version { 1152 } else { 576 }
    }

    /// Returns whether another frame belongs to the same sound.
    fn fits(self, other: Self) -> bool {
        (self.is_first_version, self.rate, self.channels)
            == (other.is_first_version, other.rate, other.channels)
    }

    /// Returns what a frame contains instead of sound: the samples that the encoder added at the start and at the end, if it is known;
    /// `None` for a frame with sound.
    fn gaps(self, frame: &[u8]) -> Option<Option<[u64; 2]>> {
        // After the header and what a frame with sound has at its start.
        let side = match (self.is_first_version, self.channels) {
            (true, 1) | (false, 2) => 17,
            (true, _) => 32,
            (false, _) => 9,
        };
        if frame.get(36..40) == Some(b"VBRI") {
            return Some(None);
        }
        let (kind, rest) = frame.get(4 + side..)?.split_first_chunk::<4>()?;
        if kind != b"Xing" && kind != b"Info" {
            return None;
        }
        Some(encoder_gaps(rest))
    }
}

/// Returns the samples that an encoder added at the start and at the end, from what follows the name of a frame without sound.
fn encoder_gaps(rest: &[u8]) -> Option<[u64; 2]> {
    let (flags, rest) = rest.split_first_chunk::<4>()?;
    let flags = u32::from_be_bytes(*flags);
    // The numbers of frames and bytes, a table of places, and the quality.
    let present = [4, 4, 100, 4].into_iter().enumerate().filter(|(bit, _)| flags >> bit & 1 == 1);
    let skipped = present.map(|(_, length)| length).sum::<usize>();
    let encoder = rest.get(skipped..)?;
    if ![b"LAME", b"Lavf", b"Lavc"].iter().any(|name| encoder.starts_with(*name)) {
        return None;
    }
    let gaps = encoder.get(21..24)?.iter().fold(0, |number, byte| number << 8 | u64::from(*byte));
    Some([gaps >> 12, gaps & 0xFFF])
}

fn read(file: Vec<u8>, start: usize) -> Result<CopiedPackets, Unreadable> {
    let mut found = FoundPackets::default();
    let mut first: Option<Mp3Header> = None;
    let mut gaps = None;
    let mut at = start;
    while let Some(rest) = file.get(at..).filter(|rest| !tag::is_end(rest)) {
        let header = Mp3Header::read(rest).map_err(|reason| Unreadable::new(at, reason))?;
        let frame = rest.get(..header.length);
        let frame = frame.ok_or_else(|| Unreadable::new(at, "the file ends in a frame"))?;
        if !first.get_or_insert(header).fits(header) {
            return Err(Unreadable::new(at, "the version, the rate or the channels change"));
        }
        match header.gaps(frame).filter(|_| at == start) {
            Some(known) => gaps = known,
            None => found.add(at, header.length, header.samples())?,
        }
        at += header.length;
    }
    let header = first.ok_or_else(|| Unreadable::new(at, "it has no sound"))?;
    let timescale = NonZeroU32::new(header.rate).unwrap_or(NonZeroU32::MIN);
    let entry = entry(header, found.bit_rate(timescale), found.largest());
    let (skip, played) = match gaps {
        Some([before, after]) => (before + DECODER_DELAY, Some(found.ticks().saturating_sub(before + after))),
        None => (0, None),
    };
    found.end(file, CopiedHead { entry, timescale, skip, played, roll: 0 })
}

/// Returns the description of the frames in an MP4.
fn entry(header: Mp3Header, bit_rate: u32, largest: u32) -> SampleEntry {
    let decoder = DecoderConfigDescriptor {
        object_type_indication: if header.is_first_version { MPEG1 } else { MPEG2 },
        stream_type: DecoderConfigDescriptor::STREAM_TYPE_AUDIO,
        up_stream: DecoderConfigDescriptor::UP_STREAM_FALSE,
        buffer_size_db: Uint::new(largest),
        max_bitrate: bit_rate,
        avg_bitrate: bit_rate,
        dec_specific_info: None,
    };
    let es = EsDescriptor {
        es_id: EsDescriptor::MIN_ES_ID,
        stream_priority: EsDescriptor::LOWEST_STREAM_PRIORITY,
        depends_on_es_id: None,
        url_string: None,
        ocr_es_id: None,
        dec_config_descr: decoder,
        sl_config_descr: SlConfigDescriptor,
    };
    SampleEntry::Mp4a(Mp4aBox {
        audio: AudioSampleEntryFields {
            data_reference_index: AudioSampleEntryFields::DEFAULT_DATA_REFERENCE_INDEX,
            channelcount: header.channels,
            samplesize: AudioSampleEntryFields::DEFAULT_SAMPLESIZE,
            samplerate: FixedPointNumber::new(header.rate as u16, 0),
        },
        esds_box: EsdsBox { es },
        unknown_boxes: Vec::new(),
    })
}
