//! AAC in ADTS: each packet after a header with its length.

use super::packets::{CopiedFormat, CopiedHead, CopiedPackets, FoundPackets, Unreadable};
use super::tag;
use shiguredo_mp4::bitstream::aac::{
    AudioSpecificConfig, Mp4aSampleEntryConfig, build_mp4a_box, parse_adts_frame, parse_audio_specific_config,
};
use shiguredo_mp4::boxes::SampleEntry;
use shiguredo_mp4::descriptors::EsDescriptor;
use std::num::NonZeroU32;

pub(super) const AAC: CopiedFormat = CopiedFormat {
    title: "AAC",
    sniff: |start| matches!(start, [0xFF, second, ..] if second & 0xF6 == 0xF0),
    read,
};

/// Samples of a packet.
const PACKET: u32 = 1024;
/// Number of packets that a decoder needs before the one from which it plays.
pub(super) const ROLL: u16 = 1;
/// Largest size of the buffer of a decoder that the description of AAC has.
const LARGEST_BUFFER: u32 = 0xFF_FFFF;

fn read(file: Vec<u8>, start: usize) -> Result<CopiedPackets, Unreadable> {
    let mut found = FoundPackets::default();
    let mut config: Option<AudioSpecificConfig> = None;
    let mut at = start;
    while let Some(rest) = file.get(at..).filter(|rest| !tag::is_end(rest)) {
        let wrong = |error: shiguredo_mp4::Error| Unreadable::new(at, error.reason);
        let (header, packet) = parse_adts_frame(rest).map_err(wrong)?;
        let now = config_of(header.sampling_frequency_index, header.channel_configuration.as_u8());
        let now = now.map_err(wrong)?;
        if *config.get_or_insert_with(|| now.clone()) != now {
            return Err(Unreadable::new(at, "the rate or the channels change"));
        }
        let length = usize::from(header.frame_length);
        found.add(at + length - packet.len(), packet.len(), PACKET)?;
        at += length;
    }
    let config = config.ok_or_else(|| Unreadable::new(at, "it has no sound"))?;
    let timescale = NonZeroU32::new(config.sampling_frequency.hz()).unwrap_or(NonZeroU32::MIN);
    let bit_rate = found.bit_rate(timescale);
    let entry = Mp4aSampleEntryConfig {
        es_id: EsDescriptor::MIN_ES_ID,
        buffer_size_db: found.largest().min(LARGEST_BUFFER),
        max_bitrate: bit_rate,
        avg_bitrate: bit_rate,
    };
    let entry = build_mp4a_box(&config, &entry).map_err(|error| Unreadable::new(start, error.reason))?;
    // The file does not contain how many samples its encoder added at the start.
    let head = CopiedHead { entry: SampleEntry::Mp4a(entry), timescale, skip: 0, played: None, roll: ROLL };
    found.end(file, head)
}

/// Returns the configuration that a header means: AAC LC with a rate of the table of rates and a number of channels.
fn config_of(rate: u8, channels: u8) -> Result<AudioSpecificConfig, shiguredo_mp4::Error> {
    // Five bits of the kind of object, four of the rate, four of the channels, and three flags.
    let bits = 2 << 11 | u16::from(rate) << 7 | u16::from(channels) << 3;
    parse_audio_specific_config(&bits.to_be_bytes())
}
