//! Peaks of sound files: WAV in several sample formats, FLAC and Ogg Vorbis; files that are refused.

use dragonfly_document::{Cancel, SoundPeaks, SoundSource};
use dragonfly_kit::folder::Folder;
use std::path::Path;

fn read(path: &Path) -> Result<SoundPeaks, String> {
    SoundSource::File(path.to_path_buf()).peaks(&Cancel::default())
}

/// Returns the bytes of a WAV file with one channel at 8,000 samples per second, 16 bits each.
fn wav(samples: &[i16], channels: u16) -> Vec<u8> {
    let data: Vec<u8> = samples.iter().flat_map(|sample| sample.to_le_bytes()).collect();
    let rate = 8000u32;
    let mut bytes = b"RIFF".to_vec();
    bytes.extend((36 + data.len() as u32).to_le_bytes());
    bytes.extend(b"WAVEfmt ");
    bytes.extend(16u32.to_le_bytes());
    bytes.extend(1u16.to_le_bytes());
    bytes.extend(channels.to_le_bytes());
    bytes.extend(rate.to_le_bytes());
    bytes.extend((rate * u32::from(channels) * 2).to_le_bytes());
    bytes.extend((channels * 2).to_le_bytes());
    bytes.extend(16u16.to_le_bytes());
    bytes.extend(b"data");
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(data);
    bytes
}

/// Returns the bytes of a FLAC file of one block with one sample that repeats: 16 bits, one channel, 8,000 samples per second.
fn flac(sample: i16, block: u16) -> Vec<u8> {
    let mut info = Vec::new();
    info.extend(block.to_be_bytes());
    info.extend(block.to_be_bytes());
    info.extend([0; 6]);
    // 20 bits of rate, 3 of channels - 1, 5 of bits - 1, 36 of samples.
    let packed = (8000u64 << 44) | (15 << 36) | u64::from(block);
    info.extend(packed.to_be_bytes());
    info.extend([0; 16]);
    let mut bytes = b"fLaC".to_vec();
    bytes.extend([0x80, 0, 0, info.len() as u8]);
    bytes.extend(info);
    // Frame: block size in 16 bits at the end of the header, rate 8 kHz, one channel, 16 bits, frame number 0.
    let mut frame = vec![0xff, 0xf8, 0x74, 0x08, 0];
    frame.extend((block - 1).to_be_bytes());
    frame.push(crc(&frame, 8, 0x07) as u8);
    // A constant subframe.
    frame.push(0);
    frame.extend(sample.to_be_bytes());
    let sum = crc(&frame, 16, 0x8005) as u16;
    frame.extend(sum.to_be_bytes());
    bytes.extend(frame);
    bytes
}

fn crc(bytes: &[u8], width: u32, polynomial: u32) -> u32 {
    let mask = (1u32 << width) - 1;
    bytes.iter().fold(0, |sum, byte| {
        (0..8).fold(sum ^ (u32::from(*byte) << (width - 8)), |sum, _| {
            let carries = sum >> (width - 1) & 1 == 1;
            (sum << 1 ^ if carries { polynomial } else { 0 }) & mask
        })
    })
}

#[test]
fn the_peaks_of_any_stretch_are_those_of_its_samples() {
    let folder = Folder::new("sound-peaks");
    let path = folder.join("ramp.wav");
    // Ten seconds: silence, then a ramp up to full scale, in two channels of opposite sign.
    let sample = |at: i32| if at < 40_000 { 0 } else { ((at - 40_000) * 32_767 / 40_000) as i16 };
    let samples: Vec<i16> = (0..80_000).flat_map(|at| [sample(at), -sample(at)]).collect();
    std::fs::write(&path, wav(&samples, 2)).expect("a file");
    let peaks = read(&path).expect("a sound");
    assert_eq!((peaks.rate(), peaks.channels(), peaks.seconds()), (8000, 2, 10.0));
    for (from, to) in [(0.0, 4.9), (5.0, 6.0), (7.0, 7.1), (0.0, 10.0), (9.99, 12.0), (-3.0, 0.5)] {
        let inside = |at: &i32| (from..to).contains(&(f64::from(*at) / 8000.0));
        let most = (0..80_000).filter(inside).map(|at| f32::from(sample(at)) / 32_768.0).fold(0.0, f32::max);
        let [low, high] = peaks.between(from, to).expect("samples");
        // A peak is that of whole blocks, which reach a little farther.
        let slack = 0.01 + (to - from) as f32 * 0.06;
        assert!(
            (high - most).abs() < slack && (low + most).abs() < slack,
            "{from} {to}: {low} {high}, {most}"
        );
    }
    assert_eq!([peaks.between(10.1, 11.0), peaks.between(-2.0, -1.0), peaks.between(3.0, 3.0)], [None; 3]);
    assert!(peaks.bytes() < 4 * 80_000 / 64, "{} bytes of peaks", peaks.bytes());
}

#[test]
fn a_flac_file_has_the_peaks_of_its_samples() {
    let folder = Folder::new("sound-flac");
    let path = folder.join("tone.flac");
    std::fs::write(&path, flac(-16_384, 4096)).expect("a file");
    let peaks = read(&path).expect("a sound");
    assert_eq!((peaks.rate(), peaks.channels()), (8000, 1));
    assert!((peaks.seconds() - 0.512).abs() < 1e-9);
    let [low, high] = peaks.between(0.1, 0.2).expect("samples");
    assert!((low + 0.5).abs() < 0.01 && (high + 0.5).abs() < 0.01, "{low} {high}");
}

#[test]
fn damaged_files_and_other_formats_are_refused_with_a_message() {
    let folder = Folder::new("sound-broken");
    let whole = wav(&[1000; 4000], 1);
    let mut no_rate = whole.clone();
    no_rate[24..28].fill(0);
    for (name, bytes, says) in [
        ("cut.wav", &whole[..30], "cut.wav cannot be read"),
        ("rate.wav", &no_rate[..], "rate.wav cannot be read"),
        ("empty.wav", &wav(&[], 1)[..], "it has no samples"),
        ("broken.flac", &b"fLaC and nothing else"[..], "broken.flac cannot be read"),
        ("broken.ogg", &b"OggS and nothing else"[..], "broken.ogg cannot be read"),
        ("song.mp3", &b"ID3\x04 a song"[..], "song.mp3 cannot be read"),
        ("song.m4a", &b"\0\0\0\x20ftypM4A and nothing else"[..], "ffmpeg -i song.m4a sound.wav"),
        ("short.wav", &b"RI"[..], "short.wav cannot be read"),
    ] {
        let path = folder.join(name);
        std::fs::write(&path, bytes).expect("a file");
        let refused = read(&path).map(drop).expect_err(name);
        assert!(refused.contains(says), "{name}: {refused}");
    }
    let cancelled = Cancel::default();
    cancelled.cancel();
    std::fs::write(folder.join("whole.wav"), whole).expect("a file");
    assert!(SoundSource::File(folder.join("whole.wav")).peaks(&cancelled).is_err());
    assert!(read(&folder.join("missing.wav")).is_err());
}
