//! Sound files of tests, put together byte by byte: packets are random bytes, which nothing has to decode.

use crate::frames::{disc, rate};
use crate::tracks::sound;
use dragonfly_kit::folder::Folder;
use dragonfly_kit::random::Random;
use dragonfly_movie::{Movie, MovieFrame, MovieReport, MovieSettings, MovieSound, MovieTarget, movie_format};
use ogg::{PacketWriteEndInfo, PacketWriter};
use shiguredo_mp4::bitstream::aac::{
    AdtsEncodeConfig, AdtsMpegVersion, parse_audio_specific_config, wrap_raw_aac_in_adts,
};
use shiguredo_mp4::boxes::SampleEntry;
use std::path::Path;

const SIZE: [u32; 2] = [16, 16];

/// A sound file, and what is to be found in it.
pub(crate) struct SoundFile {
    pub(crate) name: &'static str,
    pub(crate) bytes: Vec<u8>,
    /// The bytes of each packet, and its duration in ticks.
    pub(crate) packets: Vec<(Vec<u8>, u32)>,
    pub(crate) timescale: u32,
    /// Ticks at the start that are not played, and those that are; `None` where all are.
    pub(crate) played: Option<(u64, u64)>,
    /// Offset of the last packet in the file, or of the page or header before it.
    pub(crate) last: usize,
}

fn random_bytes(random: &mut Random, least: usize, most: usize) -> Vec<u8> {
    (0..least + random.below(most - least)).map(|_| random.bits() as u8).collect()
}

/// Returns AAC in ADTS: 48,000 samples per second, two channels.
pub(crate) fn aac(random: &mut Random, count: usize) -> SoundFile {
    let config = parse_audio_specific_config(&[0x11, 0x90]).unwrap();
    let header = AdtsEncodeConfig { mpeg_version: AdtsMpegVersion::Mpeg4, original_copy: false, home: false };
    let (mut bytes, mut packets, mut last) = (Vec::new(), Vec::new(), 0);
    for _ in 0..count {
        let packet = random_bytes(random, 1, 700);
        last = bytes.len();
        bytes.extend(wrap_raw_aac_in_adts(&packet, &config, &header).unwrap());
        packets.push((packet, 1024));
    }
    SoundFile { name: "AAC", bytes, packets, timescale: 48_000, played: None, last }
}

/// Returns MP3: 44,100 samples per second, two channels, with the gaps of its encoder in a first frame without sound.
pub(crate) fn mp3(random: &mut Random, count: usize) -> SoundFile {
    let frame = |random: &mut Random, padding: usize| {
        let mut frame = vec![0xFF, 0xFB, 0x90 | (padding as u8) << 1, 0];
        frame.extend((4..417 + padding).map(|_| random.bits() as u8));
        frame
    };
    let mut bytes = frame(random, 0);
    bytes[4..].fill(0);
    bytes[36..44].copy_from_slice(b"Info\0\0\0\x0F");
    let encoder = 44 + 4 + 4 + 100 + 4;
    bytes[encoder..encoder + 9].copy_from_slice(b"LAME3.100");
    // 576 samples at the start and 1000 at the end.
    bytes[encoder + 21..encoder + 24].copy_from_slice(&[0x24, 0x03, 0xE8]);
    let (mut packets, mut last) = (Vec::new(), 0);
    for _ in 0..count {
        let padding = random.below(2);
        let packet = frame(random, padding);
        last = bytes.len();
        bytes.extend(&packet);
        packets.push((packet, 1152));
    }
    let played = Some((576 + 529, count as u64 * 1152 - 1576));
    SoundFile { name: "MP3", bytes, packets, timescale: 44_100, played, last }
}

/// Returns Opus in Ogg, of which the last packet has 100 samples too many.
pub(crate) fn opus(random: &mut Random, count: usize) -> SoundFile {
    let mut writer = PacketWriter::new(Vec::new());
    let head = b"OpusHead\x01\x02\x38\x01\x80\xBB\0\0\0\0\0".to_vec();
    writer.write_packet(head.into_boxed_slice(), 9, PacketWriteEndInfo::EndPage, 0).unwrap();
    let titles = b"OpusTags\x04\0\0\0test\0\0\0\0".to_vec();
    writer.write_packet(titles.into_boxed_slice(), 9, PacketWriteEndInfo::EndPage, 0).unwrap();
    let (mut packets, mut ticks, mut last) = (Vec::new(), 0, 0);
    for number in 0..count {
        // Music of 20 ms, one frame.
        let mut packet = vec![31 << 3];
        packet.extend(random_bytes(random, 1, 600));
        ticks += 960;
        let (end, position) = match number + 1 {
            after if after == count => (PacketWriteEndInfo::EndStream, ticks - 100),
            after if after % 7 == 0 => (PacketWriteEndInfo::EndPage, ticks),
            _ => (PacketWriteEndInfo::NormalPacket, ticks),
        };
        if number % 7 == 0 {
            last = writer.inner().len();
        }
        writer.write_packet(packet.clone().into_boxed_slice(), 9, end, position).unwrap();
        packets.push((packet, 960));
    }
    let played = Some((312, ticks - 100 - 312));
    SoundFile { name: "Opus", bytes: writer.into_inner(), packets, timescale: 48_000, played, last }
}

/// Returns FLAC, as this crate encodes it.
pub(crate) fn flac(random: &mut Random, count: usize) -> SoundFile {
    let length = count * 4096 - 1000;
    let samples: Vec<f32> = (0..length).map(|_| random.between(-1.0, 1.0)).collect();
    let folder = Folder::new("sound-flac");
    let path = folder.join("it.mp4");
    let mut samples = Some(samples);
    let read = move |out: &mut Vec<f32>| {
        out.extend(samples.take().unwrap_or_default());
        Ok(false)
    };
    let given = MovieSound::samples(44_100, 1, Box::new(read)).unwrap();
    movie(&path, (length as u64 * 24).div_ceil(44_100), given);
    let track = sound(&path);
    let SampleEntry::Flac(entry) = &track.entry else { panic!("{:?}", track.entry) };
    let mut bytes = b"fLaC\0\0\0\x22".to_vec();
    bytes.extend(&entry.dfla_box.metadata_blocks[0].block_data);
    // A block of padding, which is the last one.
    bytes.extend([0x81, 0, 0, 5, 0xFF, 0xF8, 0, 0, 0]);
    let mut last = 0;
    for (packet, _) in &track.samples {
        last = bytes.len();
        bytes.extend(packet);
    }
    SoundFile { name: "FLAC", bytes, packets: track.samples, timescale: 44_100, played: None, last }
}

/// Returns a movie with the sound of another file.
pub(crate) fn mp4(of: SoundFile) -> SoundFile {
    let folder = Folder::new("sound-mp4");
    let path = folder.join("it.mp4");
    let ticks: u64 = of.packets.iter().map(|(_, duration)| u64::from(*duration)).sum();
    let played = of.played.map_or(ticks, |(_, played)| played);
    movie(&path, (played * 24).div_ceil(u64::from(of.timescale)) + 2, MovieSound::copied(of.bytes).unwrap());
    let bytes = std::fs::read(&path).unwrap();
    SoundFile { name: "sound in MP4", bytes, last: 0, ..of }
}

/// Returns a file of every format.
pub(crate) fn all(random: &mut Random, count: usize) -> Vec<SoundFile> {
    let [one, two, three, four] = [aac, mp3, opus, flac].map(|make| make(random, count));
    let copies = [aac, mp3, opus, flac].map(|make| mp4(make(random, count)));
    [one, two, three, four].into_iter().chain(copies).collect()
}

/// Writes a movie of `count` frames at 24 per second with a sound.
pub(crate) fn movie(path: &Path, count: u64, sound: MovieSound) -> MovieReport {
    let settings = MovieSettings::new(SIZE, rate("24"));
    let format = movie_format("mp4").unwrap();
    let mut movie = Movie::begin_with_sound(format, &settings, MovieTarget::path(path), sound).unwrap();
    for number in 0..count {
        movie.frame(MovieFrame::srgb(SIZE, &disc(SIZE, number, false))).unwrap();
    }
    movie.end().unwrap()
}
