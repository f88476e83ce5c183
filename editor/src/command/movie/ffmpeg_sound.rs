//! The sounds of a movie for the command ffmpeg: a file of samples next to the movie, which is removed after it.

use super::super::Failure;
use crate::movie_render::{SOUND_CHANNELS, SOUND_RATE};
use dragonfly_document::Cancel;
use dragonfly_movie::ReadSamples;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file of samples: 32-bit floating-point numbers, little-endian, of the channels in turn. Dropping it removes the file.
pub(super) struct FfmpegSound {
    path: PathBuf,
}

impl FfmpegSound {
    /// Writes all samples to a file next to `movie`. Ends early when it is cancelled.
    pub(super) fn write(movie: &Path, read: ReadSamples, cancel: &Cancel) -> Result<Self, Failure> {
        let mut name = movie.as_os_str().to_owned();
        // Several programs may write movies in one folder.
        name.push(format!(".sound-{}", std::process::id()));
        let path = PathBuf::from(name);
        let failed = |error: io::Error| Failure::Machine(format!("{}: {error}", path.display()));
        // A file that was there before is not its own, and stays.
        let file = File::create_new(&path).map_err(failed)?;
        let sound = Self { path: path.clone() };
        write_all(file, read, cancel).map_err(failed)?;
        Ok(sound)
    }

    /// Returns the arguments by which ffmpeg reads the file.
    pub(super) fn arguments(&self) -> Vec<OsString> {
        let mut path = OsString::from("file:");
        path.push(&self.path);
        let [rate, channels] = [SOUND_RATE, u32::from(SOUND_CHANNELS)].map(|count| count.to_string());
        let mut arguments: Vec<OsString> =
            ["-f", "f32le", "-ar", &rate, "-ac", &channels, "-i"].map(OsString::from).into();
        arguments.push(path);
        arguments
    }
}

impl Drop for FfmpegSound {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

fn write_all(file: File, mut read: ReadSamples, cancel: &Cancel) -> io::Result<()> {
    let mut file = BufWriter::new(file);
    let mut samples = Vec::new();
    loop {
        samples.clear();
        let is_more = read(&mut samples).map_err(io::Error::other)?;
        for sample in &samples {
            file.write_all(&sample.to_le_bytes())?;
        }
        if !is_more || cancel.is_cancelled() {
            return file.flush();
        }
    }
}
