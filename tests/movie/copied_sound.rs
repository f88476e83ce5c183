//! Sound whose packets are copied from a file without encoding them again.

use crate::judge::{ffmpeg, probe, samples};
use crate::sound_files::{SoundFile, aac, all, flac, movie, mp3, mp4, opus};
use crate::tracks::sound;
use dragonfly_kit::counting::peak;
use dragonfly_kit::folder::{Folder, takes_long};
use dragonfly_kit::mutate::Mutator;
use dragonfly_kit::random::{Random, seed};
use dragonfly_kit::skip::{TestNeed, skip};
use dragonfly_movie::{MOVIE_FORMATS, Movie, MovieSettings, MovieSound, MovieTarget};
use shiguredo_mp4::boxes::SampleEntry;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Returns the reason why a file cannot be copied.
fn error(bytes: Vec<u8>) -> String {
    MovieSound::copied(bytes).map(|sound| format!("{sound:?}")).unwrap_err().to_string()
}

#[test]
fn the_packets_of_every_format_are_in_the_movie_byte_for_byte() {
    let folder = Folder::new("sound-copied");
    let path = folder.join("it.mp4");
    let seed = seed(71_003);
    for file in all(&mut Random::new(seed), 24) {
        let about = format!("seed {seed}, {}", file.name);
        assert_eq!(MovieSound::copied_format(&file.bytes), Some(file.name), "{about}");
        let report = movie(&path, 60, MovieSound::copied(file.bytes).unwrap());
        assert_eq!(report.notices, [""; 0], "{about}");
        let found = sound(&path);
        assert_eq!((found.samples.len(), found.timescale), (file.packets.len(), file.timescale), "{about}");
        assert!(found.samples == file.packets, "{about}: other packets");
        let edit = file.played.map(|(skip, played)| {
            // In ticks of the movie, rounded up.
            let ticks = u128::from(played) * u128::from(found.movie.0);
            (ticks.div_ceil(u128::from(file.timescale)) as u64, skip as i64)
        });
        assert_eq!(found.edit, edit, "{about}");
        let rolls = !matches!(found.entry, SampleEntry::Flac(_)) && file.timescale != 44_100;
        assert_eq!(found.others, if rolls { vec![*b"sgpd", *b"sbgp"] } else { vec![] }, "{about}");
    }
}

#[test]
fn a_sound_that_is_longer_than_the_movie_ends_with_the_packet_at_its_end() {
    let folder = Folder::new("sound-cut");
    let path = folder.join("it.mp4");
    for file in all(&mut Random::new(5), 60) {
        for count in [1, 24, 50] {
            let given = MovieSound::copied(file.bytes.clone()).unwrap();
            movie(&path, count, given);
            let found = sound(&path);
            let about = format!("{}, {count} frames", file.name);
            let skip = file.played.map_or(0, |(skip, _)| skip);
            let until = skip + count * u64::from(file.timescale) / 24;
            let longest = found.samples.iter().map(|(_, duration)| u64::from(*duration)).max().unwrap();
            let whole = file.packets.iter().map(|(_, duration)| u64::from(*duration)).sum::<u64>();
            if whole > until {
                assert!((until..until + longest).contains(&found.ticks()), "{about}: {}", found.ticks());
            }
            assert!(found.samples == file.packets[..found.samples.len()], "{about}");
            let pictures = count * u64::from(found.movie.0) / 24;
            match found.edit {
                Some((played, _)) => assert!(played <= pictures && found.movie.1 == pictures, "{about}"),
                None => assert!(found.movie.1 >= pictures, "{about}"),
            }
        }
    }
}

#[test]
fn tags_before_and_after_the_sound_are_not_copied() {
    let mut random = Random::new(8);
    let mut before = b"ID3\x04\0\0\0\0\x02\x01".to_vec();
    before.resize(10 + 257, 0xFF);
    let mut after = b"TAG".to_vec();
    after.resize(128, 0xFF);
    for make in [aac, mp3, flac] {
        let file: SoundFile = make(&mut random, 5);
        let tagged = [&before, &file.bytes, &after].map(|part: &Vec<u8>| part.as_slice()).concat();
        assert_eq!(MovieSound::copied_format(&tagged), Some(file.name));
        let folder = Folder::new("sound-tags");
        let path = folder.join("it.mp4");
        movie(&path, 24, MovieSound::copied(tagged).unwrap());
        assert!(sound(&path).samples == file.packets, "{}", file.name);
    }
}

#[test]
fn a_damaged_file_is_an_error_with_the_offset_of_the_byte() {
    let mut random = Random::new(2);
    for make in [aac, mp3, flac] {
        let file = make(&mut random, 20);
        let wanted = format!("the sound: {}, byte {}: ", file.name, file.last);
        // It ends in its last packet, or what is there is none.
        let cut = file.bytes[..file.bytes.len() - 1].to_vec();
        assert!(error(cut).starts_with(&wanted), "{}", file.name);
        let mut broken = file.bytes.clone();
        broken[file.last] = 0;
        let place = error(broken);
        // A frame of FLAC has no length: without the next one, it is the frame before that has no end.
        assert!(place.starts_with(&wanted) || file.name == "FLAC", "{place}");
    }
    let file = opus(&mut random, 20);
    let mut broken = file.bytes.clone();
    broken[file.last + 100] ^= 1;
    let found = error(broken);
    assert!(found.contains("checksum") && found.contains(", byte "), "{found}");
    let place: usize = found.split("byte ").nth(1).unwrap().split(':').next().unwrap().parse().unwrap();
    assert!((file.last..=file.bytes.len()).contains(&place), "{found}, from {} on", file.last);
    let file = mp4(aac(&mut random, 20));
    let mut broken = file.bytes.clone();
    let table = broken.windows(4).rposition(|kind| kind == b"stco").unwrap();
    broken[table + 12..table + 16].copy_from_slice(&(file.bytes.len() as u32).to_be_bytes());
    assert!(error(broken).contains(&format!("byte {}: packet 1 is empty, or outside", file.bytes.len())));
}

#[test]
fn files_of_other_formats_are_named_as_such() {
    let mut riff = b"RIFF\0\0\0\0WAVEfmt ".to_vec();
    riff.resize(100, 0);
    let mut vorbis = b"OggS\0\x02".to_vec();
    vorbis.resize(28, 0);
    vorbis.extend(b"\x01vorbis");
    for bytes in
        [riff, vorbis, Vec::new(), vec![0xFF], vec![0; 1000], b"ID3\x04\0\0\x7F\x7F\x7F\x7F".to_vec()]
    {
        assert_eq!(MovieSound::copied_format(&bytes), None);
        assert_eq!(error(bytes), "the sound: the file is none of FLAC, Opus, sound in MP4, AAC, MP3");
    }
    let mut changes = aac(&mut Random::new(1), 3).bytes;
    let last = changes.len();
    let more = changes.clone();
    changes.extend(more);
    // Another rate.
    changes[last + 2] = changes[last + 2] & !0x3C | 4 << 2;
    assert_eq!(error(changes), format!("the sound: AAC, byte {last}: the rate or the channels change"));
}

#[test]
fn mutants_of_files_are_an_error_with_a_place_or_a_sound() {
    let seed = seed(60_606);
    let words: &[&[u8]] =
        &[b"OggS", b"moov", b"stsz", b"stts", b"elst", b"\xff\xfb\x90\0", b"\xff\xf1", b"\xff\xf8\xc9"];
    let mutants = if takes_long() { 200_000 } else { 400 };
    let folder = Folder::new("sound-mutants");
    let path = folder.join("it.mp4");
    for file in all(&mut Random::new(seed), 12) {
        let mut mutator = Mutator::new(seed, words);
        let files = vec![file.bytes];
        let mut good = 0;
        for number in 0..mutants {
            let about = format!("seed {seed}, {}, {number}", file.name);
            let bytes = mutator.mutant(&files);
            let length = bytes.len() as u64;
            let (memory, read) = peak(|| MovieSound::copied(bytes));
            assert!(memory < 100 * length + 100_000, "{about}: {memory} bytes of memory for {length}");
            match read {
                Ok(sound) => {
                    good += 1;
                    if good % 20 == 1 {
                        movie(&path, 3, sound);
                    }
                }
                Err(error) => {
                    let text = error.to_string();
                    assert!(text.contains(", byte ") || text.contains("is none of"), "{about}: {text}");
                }
            }
        }
        assert!(good < mutants, "seed {seed}, {}: no mutant was found to be damaged", file.name);
    }
}

#[test]
fn a_file_that_looks_like_the_next_frame_everywhere_is_read_once() {
    // Each frame header promises the next number, and the checksum over the frame is never right: a reader that sums from the start of the
    // frame each time does not end.
    let file = flac(&mut Random::new(4), 3);
    let second = file.bytes.len() - file.packets[1..].iter().map(|(bytes, _)| bytes.len()).sum::<usize>();
    let header = file.bytes[second..second + 8].to_vec();
    let mut hostile = file.bytes[..second - 2].to_vec();
    while hostile.len() < 8 << 20 {
        hostile.extend(&header);
    }
    assert!(error(hostile).contains("the frame is damaged"));
}

#[test]
fn more_packets_than_a_day_has_are_refused_without_the_memory_for_them() {
    if !takes_long() {
        return;
    }
    // Packets of a byte after headers of seven.
    let one = aac(&mut Random::new(1), 1).bytes[..7].to_vec();
    let mut packet = one.clone();
    // The length of a frame has 13 bits in three bytes.
    (packet[3], packet[4], packet[5]) = (packet[3] & !3, 1, packet[5] & 0x1F);
    packet.push(0);
    let bytes = packet.repeat((1 << 23) + 1);
    let length = bytes.len() as u64;
    let (memory, read) = peak(|| MovieSound::copied(bytes));
    let text = read.unwrap_err().to_string();
    assert!(text.contains("more than 8388608 packets"), "{text}");
    assert!(memory < 7 * length, "{memory} bytes for a file of {length}");
}

#[test]
fn formats_without_sound_refuse_one_that_is_copied() {
    let folder = Folder::new("sound-copied-refused");
    let file = aac(&mut Random::new(1), 5).bytes;
    for format in MOVIE_FORMATS.iter().filter(|format| !format.has_sound) {
        let sound = MovieSound::copied(file.clone()).unwrap();
        let settings = MovieSettings::new([8, 8], crate::frames::rate("24"));
        let begun = Movie::begin_with_sound(format, &settings, MovieTarget::path(folder.join("it")), sound);
        let error = begun.unwrap_err().to_string();
        assert!(error.contains("cannot have sound; choose MP4"), "{error}");
    }
}

/// Encodes a tone of 2.2 s with ffmpeg; `None`, counted as not run, if it has no such encoder.
fn encoded(folder: &Folder, name: &str, encoder: &str) -> Option<PathBuf> {
    let path = folder.join(name);
    let tone = "sine=frequency=440:duration=2.2:sample_rate=48000";
    let mut command = Command::new("ffmpeg");
    command.args(["-v", "error", "-nostdin", "-y", "-f", "lavfi", "-i", tone, "-ac", "2", "-c:a", encoder]);
    let output = command.arg(&path).output().unwrap();
    if !output.status.success() {
        skip(TestNeed::Evaluators, format!("ffmpeg has no encoder {encoder}"));
        return None;
    }
    Some(path)
}

/// Returns the samples of a file as ffmpeg decodes it, whatever it complains about.
fn decoded(path: &Path) -> Vec<i16> {
    let mut command = Command::new("ffmpeg");
    command.args(["-v", "error", "-nostdin", "-i"]).arg(path);
    let output = command.args(["-map", "0:a", "-f", "s16le", "-c:a", "pcm_s16le", "-"]).output().unwrap();
    assert!(output.status.success());
    output.stdout.as_chunks::<2>().0.iter().map(|sample| i16::from_le_bytes(*sample)).collect()
}

#[test]
fn ffmpeg_decodes_a_copied_sound_to_the_samples_of_its_file() {
    if !ffmpeg() {
        return;
    }
    let folder = Folder::new("sound-ffmpeg");
    let path = folder.join("it.mp4");
    for (name, encoder, codec, longest) in [
        ("it.aac", "aac", "aac", 1024),
        ("it.m4a", "aac", "aac", 1024),
        ("it.mp3", "libmp3lame", "mp3", 1152),
        ("it.opus", "libopus", "opus", 960),
        ("it.flac", "flac", "flac", 4608),
    ] {
        let Some(file) = encoded(&folder, name, encoder) else { continue };
        let wanted = decoded(&file);
        // 1.75 s, and longer than the sound.
        for count in [42, 60] {
            movie(&path, count, MovieSound::copied(std::fs::read(&file).unwrap()).unwrap());
            let found = samples(&path);
            let about = format!("{name}, {count} frames: {} samples of {}", found.len(), wanted.len());
            let expected = wanted.len().min(count as usize * 2000 * 2);
            assert!(
                (expected..=expected + 2 * longest).contains(&found.len()),
                "{about}, {expected} expected"
            );
            let common = found.len().min(wanted.len());
            assert!(found[..common] == wanted[..common], "{about}: other samples");
            assert_eq!(probe(&path, "a:0")["codec_name"], codec);
            assert_eq!(probe(&path, "v:0")["nb_read_frames"], count.to_string());
        }
    }
    if let Some(file) = encoded(&folder, "other.m4a", "alac") {
        let error = error(std::fs::read(&file).unwrap());
        assert!(error.contains("alac") && error.contains("not copied"), "{error}");
    }
}
