//! Files of every format have the samples that they were made of.

use dragonfly_kit::folder::{Folder, data};
use dragonfly_sound::{SOUND_FORMATS, SoundReader, SoundSamples, is_sound_file};
use std::f64::consts::TAU;
use std::fs::File;
use std::path::Path;

/// Returns left and right of the tones in the files: sines of 440 and 660 Hz.
fn tones(seconds: f64) -> [f64; 2] {
    [0.5 * (TAU * 440.0 * seconds).sin(), 0.4 * (TAU * 660.0 * seconds).sin()]
}

pub(crate) fn samples(path: &Path) -> Result<SoundSamples, String> {
    let file = File::open(path).map_err(|error| error.to_string())?;
    SoundSamples::read(&mut SoundReader::new(file, "it")?, &|| false)
}

/// Writes a WAV file.
pub(crate) fn wav(path: &Path, channels: u16, rate: u32, samples: &[f32]) {
    let spec = hound::WavSpec {
        channels,
        sample_rate: rate,
        bits_per_sample: 32,
        sample_format: hound::SampleFormat::Float,
    };
    let mut writer = hound::WavWriter::create(path, spec).expect("a file");
    samples.iter().for_each(|&sample| writer.write_sample(sample).expect("a sample"));
    writer.finalize().expect("a file");
}

#[test]
fn the_tones_of_each_format_are_those_that_were_encoded() {
    // Largest root mean square of the error; the last two formats leave out parts.
    for (name, length, most) in
        [("tones.flac", 0.5, 1e-4), ("tones.ogg", 1.5, 0.02), ("tones.mp3", 0.5, 0.02)]
    {
        let samples = samples(&data("sound").join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!((samples.seconds() - length).abs() < 1e-9, "{name}: {} s", samples.seconds());
        for side in 0..2 {
            let errors = (500..10_500).map(|frame| {
                let seconds = f64::from(frame) / 22_050.0;
                (f64::from(samples.at(seconds)[side]) - tones(seconds)[side]).powi(2)
            });
            let error = (errors.sum::<f64>() / 10_000.0).sqrt();
            assert!(error < most, "{name}, side {side}: {error} of {most}");
        }
    }
}

#[test]
fn a_sound_is_read_in_blocks_that_together_are_all_of_it() {
    for (name, frames) in [("tones.flac", 11_025), ("tones.ogg", 33_075), ("tones.mp3", 11_025)] {
        let mut reader = SoundReader::new(File::open(data("sound").join(name)).unwrap(), name).unwrap();
        assert_eq!((reader.rate(), reader.channels()), (22_050, 2), "{name}");
        let (mut values, mut blocks) = (0, 0);
        while let Some(block) = reader.next_block().unwrap() {
            assert!(!block.is_empty() && block.iter().all(|sample| sample.abs() < 1.1), "{name}");
            values += block.len();
            blocks += 1;
        }
        assert_eq!(values, 2 * frames, "{name}");
        assert!(blocks > 1, "{name}: {blocks} blocks");
    }
}

#[test]
fn one_channel_is_on_both_sides_and_channels_beyond_two_are_too() {
    let folder = Folder::new("sound-channels");
    let path = folder.join("it.wav");
    let played = |channels: u16, frame: &[f32]| {
        wav(&path, channels, 8_000, &frame.repeat(10));
        samples(&path).unwrap().at(0.0005)
    };
    let near = |have: [f32; 2], want: [f32; 2]| {
        assert!(have.iter().zip(want).all(|(have, want)| (have - want).abs() < 1e-4), "{have:?} of {want:?}");
    };
    near(played(1, &[0.25]), [0.25; 2]);
    near(played(2, &[0.25, -0.5]), [0.25, -0.5]);
    let middle = 0.2 * std::f32::consts::FRAC_1_SQRT_2;
    near(played(3, &[0.25, -0.5, 0.2]), [0.25 + middle, -0.5 + middle]);
    // Louder than full scale is full scale, and no number is silence.
    near(played(2, &[7.0, f32::NAN]), [1.0, 0.0]);
}

#[test]
fn between_two_frames_a_sample_is_on_the_line_between_them_and_outside_there_is_silence() {
    let folder = Folder::new("sound-between");
    let path = folder.join("it.wav");
    wav(&path, 1, 10, &[0.0, 0.5, -0.5]);
    let samples = samples(&path).unwrap();
    assert_eq!(samples.seconds(), 0.3);
    for (seconds, wanted) in
        [(-0.01, 0.0), (0.0, 0.0), (0.05, 0.25), (0.1, 0.5), (0.15, 0.0), (0.2, -0.5), (0.3, 0.0)]
    {
        let played = samples.at(seconds)[0];
        assert!((played - wanted).abs() < 1e-4, "{played} at {seconds} s, not {wanted}");
    }
    assert_eq!(samples.at(f64::NAN), [0.0; 2]);
}

#[test]
fn files_are_sounds_by_the_extensions_of_the_formats() {
    assert!(SOUND_FORMATS.iter().flat_map(|format| format.extensions).all(|extension| {
        is_sound_file(Path::new(&format!("a.{extension}")))
            && is_sound_file(Path::new(&format!("A.{}", extension.to_uppercase())))
    }));
    assert!(!["a.glb", "wav", "a.", "a.wav.zip"].iter().any(|name| is_sound_file(Path::new(name))));
}

#[test]
fn what_is_no_sound_is_refused_with_the_formats_that_are() {
    let folder = Folder::new("sound-other");
    for (name, bytes) in
        [("a.txt", b"not a sound, but long enough".as_slice()), ("empty.wav", b""), ("short.ogg", b"Og")]
    {
        std::fs::write(folder.join(name), bytes).unwrap();
        let error = samples(&folder.join(name)).unwrap_err();
        assert!(error.contains("WAV, FLAC, Ogg Vorbis, MP3") && error.contains("ffmpeg"), "{name}: {error}");
    }
    assert!(samples(folder.path()).is_err(), "a folder");
}
