//! Sound in an MP4.

use crate::frames::{disc, rate};
use crate::judge::{ffmpeg, probe, samples};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::random::{Random, seed};
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_movie::{
    GROUP, MOVIE_FORMATS, Movie, MovieFrame, MovieSettings, MovieSound, MovieTarget, ReadSamples,
    join_movies, movie_format,
};
use std::path::Path;
use std::sync::Arc;

const SIZE: [u32; 2] = [32, 32];

/// Returns samples in blocks of a length that has nothing to do with that of packets.
fn blocks(samples: &[f32], channels: usize) -> ReadSamples {
    let mut rest: Vec<f32> = samples.iter().rev().copied().collect();
    Box::new(move |out| {
        for _ in 0..777 * channels {
            out.extend(rest.pop());
        }
        Ok(!rest.is_empty())
    })
}

fn write(path: &Path, count: u64, sound: Option<MovieSound>) {
    let settings = MovieSettings::new(SIZE, rate("24000/1001"));
    let format = movie_format("mp4").unwrap();
    let target = MovieTarget::path(path);
    let mut movie = match sound {
        Some(sound) => Movie::begin_with_sound(format, &settings, target, sound).unwrap(),
        None => Movie::begin(format, &settings, target).unwrap(),
    };
    for number in 0..count {
        movie.frame(MovieFrame::srgb(SIZE, &disc(SIZE, number, false))).unwrap();
    }
    movie.end().unwrap();
}

/// Returns samples of all kinds: tones, silence, noise, and the loudest that there are.
fn any_sound(length: usize, random: &mut Random) -> Vec<f32> {
    let mut samples = Vec::new();
    while samples.len() < length {
        let (kind, volume, step) = (random.below(5), random.unit(), 0.3 * random.unit());
        samples.extend((0..random.below(20_000)).map(|at| match kind {
            0 => 0.0,
            1 => random.between(-1.0, 1.0),
            2 => [-1.5, 1.5, f32::NAN][random.below(3)],
            _ => volume * (at as f32 * step).sin(),
        }));
    }
    samples.truncate(length);
    samples
}

fn levels(samples: &[f32]) -> Vec<i16> {
    let level =
        |sample: &f32| if sample.is_nan() { 0 } else { (sample.clamp(-1.0, 1.0) * 32_767.0).round() as i16 };
    samples.iter().map(level).collect()
}

#[test]
fn ffmpeg_decodes_every_sample_of_the_sound_until_the_movie_ends() {
    let folder = Folder::new("sound");
    let path = folder.join("it.mp4");
    let seed = seed(92_771);
    let mut random = Random::new(seed);
    // Rate, channels, frames of the movie, and samples of the sound, which may be longer or shorter.
    for (per_second, channels, count, length) in [
        (48_000, 2, 130, 300_000),
        (44_100, 1, 60, 60_000),
        (48_000, 2, 1, 10),
        (96_000, 6, 50, 500_000),
        (8_000, 2, 40, 4097),
    ] {
        let given = any_sound(length * channels, &mut random);
        let sound = MovieSound::samples(per_second, channels, blocks(&given, channels)).unwrap();
        write(&path, count, Some(sound));
        if !ffmpeg() {
            return;
        }
        let about = format!("seed {seed}, {per_second} Hz, {channels} channels, {count} frames");
        let whole = (count as u128 * 1001 * u128::from(per_second)).div_ceil(24_000) as usize;
        let wanted = &levels(&given)[..whole.min(length) * channels];
        let found = samples(&path);
        assert_eq!(found.len(), wanted.len(), "{about}");
        assert!(found == wanted, "{about}: other samples");
        let about_sound = probe(&path, "a:0");
        let expected = [
            ("codec_name", "flac"),
            ("sample_rate", &per_second.to_string()),
            ("channels", &channels.to_string()),
        ];
        expected.iter().for_each(|(key, value)| assert_eq!(about_sound[*key], *value, "{about}: {key}"));
        assert_eq!(probe(&path, "v:0")["nb_read_frames"], count.to_string());
    }
}

#[test]
fn parts_are_joined_with_the_sound_of_the_whole_movie() {
    let folder = Folder::new("sound-join");
    let given = any_sound(2 * 300_000, &mut Random::new(3));
    let sound = || MovieSound::samples(48_000, 2, blocks(&given, 2)).unwrap();
    let [one, joined] = ["one.mp4", "joined.mp4"].map(|name| folder.join(name));
    let count = 2 * GROUP + 7;
    write(&one, count, Some(sound()));
    let mut parts = Vec::new();
    for (first, count) in dragonfly_movie::movie_parts(0..count, GROUP) {
        let path = folder.join(&format!("{first}.mp4"));
        let settings = MovieSettings { first, ..MovieSettings::new(SIZE, rate("24000/1001")) };
        crate::frames::write_disc("mp4", &settings, &path, count, false);
        parts.push(path);
    }
    join_movies(&parts, 0..count, MovieTarget::path(&joined), Some(sound())).unwrap();
    assert!(std::fs::read(&one).unwrap() == std::fs::read(&joined).unwrap());
    let settings = MovieSettings::new(SIZE, rate("24000/1001"));
    assert!(dragonfly_movie::has_movie(&dragonfly_store::RealFiles, &joined, &settings, count));
    // Sound in a part would be lost or repeated.
    let error = join_movies(&[joined], 0..count, MovieTarget::path(&one), None).unwrap_err().to_string();
    assert!(error.contains("it has sound"), "{error}");
}

#[test]
fn sound_that_cannot_be_is_an_error() {
    let folder = Folder::new("sound-refused");
    let silence = || blocks(&[0.0; 100], 1);
    for (per_second, channels) in [(0, 1), (700_000, 1), (48_000, 0), (48_000, 9)] {
        assert!(MovieSound::samples(per_second, channels, silence()).is_err());
    }
    let settings = MovieSettings::new(SIZE, rate("24"));
    for format in MOVIE_FORMATS.iter().filter(|format| !format.has_sound) {
        let sound = MovieSound::samples(48_000, 1, silence()).unwrap();
        let begun = Movie::begin_with_sound(format, &settings, MovieTarget::path(folder.join("it")), sound);
        assert!(begun.unwrap_err().to_string().contains("sound"), "{}", format.name);
    }
}

#[test]
fn a_tone_needs_less_than_half_of_its_samples_and_silence_hardly_anything() {
    let folder = Folder::new("sound-size");
    let tone = |at: u32, loud: f32| [loud * (at as f32 * 0.05).sin(), loud * (at as f32 * 0.05 + 0.3).sin()];
    let size = |loud: Option<f32>| {
        let path = folder.join("it.mp4");
        let sound = loud.map(|loud| {
            let samples: Vec<f32> = (0..96_000).flat_map(|at| tone(at, loud)).collect();
            MovieSound::samples(48_000, 2, blocks(&samples, 2)).unwrap()
        });
        write(&path, 48, sound);
        std::fs::metadata(&path).unwrap().len()
    };
    let [silent, loud, none] = [Some(0.0), Some(0.5), None].map(size);
    let samples = 96_000 * 4;
    assert!(loud - none < samples / 2, "{} bytes of {samples}", loud - none);
    assert!(silent - none < 2_000, "{}", silent - none);
}

/// Begins a movie with sound on a disk that is full for the calls `from..=to`. Returns it with the number of frames that were written.
fn on_full_disk(path: &Path, given: &[f32], [from, to]: [u64; 2]) -> Option<(Movie, u64)> {
    let sound = MovieSound::samples(48_000, 2, blocks(given, 2)).unwrap();
    let files = FaultyFiles::between(from, to, Fault::Full);
    let target = MovieTarget::Path { files: Arc::new(files), path: path.to_path_buf() };
    let settings = MovieSettings { coarseness: 10, ..MovieSettings::new(SIZE, rate("24000/1001")) };
    let mut movie = Movie::begin_with_sound(movie_format("mp4").unwrap(), &settings, target, sound).ok()?;
    let mut count = 0;
    while count < 5 * GROUP && movie.frame(MovieFrame::srgb(SIZE, &disc(SIZE, count, false))).is_ok() {
        count += 1;
    }
    Some((movie, count))
}

#[test]
fn after_a_packet_that_could_not_be_written_the_sound_goes_on_with_that_packet() {
    let folder = Folder::new("sound-full");
    let given = any_sound(2 * 700_000, &mut Random::new(11));
    let mut interrupted = 0;
    for call in 1..60 {
        let path = folder.join("it.mp4");
        let Some((movie, count)) = on_full_disk(&path, &given, [call, call]) else { continue };
        if count == 0 || movie.end().is_err() || count == 5 * GROUP {
            continue;
        }
        interrupted += 1;
        if !ffmpeg() {
            continue;
        }
        let found = samples(&path);
        assert!(!found.is_empty() && found == levels(&given)[..found.len()], "call {call}: other samples");
    }
    assert!(interrupted > 1, "{interrupted} movies were interrupted");
}

#[test]
fn a_sound_that_cannot_be_read_to_its_end_costs_no_picture() {
    let folder = Folder::new("sound-broken");
    let path = folder.join("it.mp4");
    let settings = MovieSettings::new(SIZE, rate("24"));
    let silent: fn(u32) -> Result<bool, String> =
        |calls| if calls < 2 { Ok(true) } else { Err("the file is damaged at byte 71".to_owned()) };
    let endless: fn(u32) -> Result<bool, String> = |_| Ok(true);
    for (answer, words) in [(silent, "damaged at byte 71"), (endless, "does not end")] {
        let mut calls = 0;
        let read: ReadSamples = Box::new(move |out| {
            calls += 1;
            out.extend([0.25; 9_600].iter().filter(|_| calls < 3));
            answer(calls)
        });
        let sound = MovieSound::samples(48_000, 1, read).unwrap();
        let target = MovieTarget::path(&path);
        let mut movie =
            Movie::begin_with_sound(movie_format("mp4").unwrap(), &settings, target, sound).unwrap();
        for number in 0..2 * GROUP {
            movie.frame(MovieFrame::srgb(SIZE, &disc(SIZE, number, false))).unwrap();
        }
        let report = movie.end().unwrap();
        assert_eq!(report.frames, 2 * GROUP);
        let [notice] = report.notices.as_slice() else { panic!("{:?}", report.notices) };
        assert!(notice.starts_with("The sound ends at ") && notice.contains(words), "{notice}");
    }
}
