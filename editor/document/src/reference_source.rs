//! Reference pictures: a picture, a numbered sequence of pictures, or an animated GIF. Everything here reads files and is called in jobs.

use super::Cancel;
use super::images::{DecodedImage, decode_within};
use dragonfly_anim::data::Image;
use image::AnimationDecoder;
use image::codecs::gif::GifDecoder;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Longest side of a reference picture as it is kept, pixels; larger ones are halved.
pub const REFERENCE_SIDE: u32 = 2048;
/// Largest file of a picture, bytes.
const LARGEST_FILE: u64 = 256 << 20;
/// Largest number of files of a folder that are looked at, and of frames of an animated picture.
const MOST_FILES: usize = 200_000;
/// Largest number of frames of a sequence.
const MOST_FRAMES: u64 = 1_000_000;
/// File name extensions of videos.
const VIDEOS: [&str; 10] = ["mp4", "mov", "mkv", "webm", "avi", "m4v", "mpg", "mpeg", "wmv", "ogv"];

/// The frames of a reference, as a survey found them. A copy is cheap.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceSource {
    kind: ReferenceKind,
    /// Width and height of the first frame in its file, pixels.
    size: [u32; 2],
}

/// The kind of a reference.
#[derive(Clone, Debug, PartialEq)]
enum ReferenceKind {
    Picture(Arc<Path>),
    /// Numbers and files, ascending by number.
    Sequence(Arc<[(u64, PathBuf)]>),
    Animated {
        path: Arc<Path>,
        frames: usize,
        /// Frames per second.
        rate: f32,
    },
}

impl ReferenceSource {
    /// Finds the frames of a reference by the path of a picture. With `sequence`, pictures in its folder whose names differ only in the
    /// number at the end are its other frames.
    ///
    /// # Errors
    ///
    /// A sentence for the user: the file cannot be read, is no picture, or is too large.
    pub fn survey(path: &Path, sequence: bool, cancel: &Cancel) -> Result<Self, String> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        if VIDEOS.contains(&extension.as_str()) {
            let name = name(path);
            return Err(format!(
                "{name} is a video: convert it to images and choose the first one: ffmpeg -i {name} out_%04d.png"
            ));
        }
        let bytes = read(path)?;
        if bytes.starts_with(b"GIF8")
            && let Some(found) = Self::animated(path, &bytes, cancel)?
        {
            return Ok(found);
        }
        let first = decode(path, bytes)?;
        let size = [first.width, first.height];
        let files = if sequence { numbered(path, cancel) } else { Vec::new() };
        let kind = if files.len() > 1 {
            ReferenceKind::Sequence(files.into())
        } else {
            ReferenceKind::Picture(path.into())
        };
        Ok(Self { kind, size })
    }

    /// Returns the animation in the bytes of a GIF; `None` for a single frame.
    fn animated(path: &Path, bytes: &[u8], cancel: &Cancel) -> Result<Option<Self>, String> {
        let (mut frames, mut seconds, mut size) = (0usize, 0.0, [0; 2]);
        for_each_frame(bytes, |at, frame| {
            let (numerator, denominator) = frame.delay().numer_denom_ms();
            seconds += numerator as f32 / denominator.max(1) as f32 / 1000.0;
            (frames, size) = (at + 1, [frame.buffer().width(), frame.buffer().height()]);
            !cancel.is_cancelled() && frames < MOST_FILES
        })
        .map_err(|reason| format!("{} cannot be shown: {reason}", name(path)))?;
        // Programs treat frames without a duration as those of a tenth of a second.
        let rate = if seconds > 0.0 { frames as f32 / seconds } else { 10.0 };
        let kind = ReferenceKind::Animated { path: path.into(), frames, rate };
        Ok((frames > 1).then_some(Self { kind, size }))
    }

    /// Returns the number of frames, at least 1. The numbers of a sequence that have no file count as well.
    pub fn frames(&self) -> usize {
        match &self.kind {
            ReferenceKind::Picture(_) => 1,
            ReferenceKind::Sequence(files) => {
                let (first, last) =
                    (files.first().map_or(0, |file| file.0), files.last().map_or(0, |file| file.0));
                (last - first).min(MOST_FRAMES - 1) as usize + 1
            }
            ReferenceKind::Animated { frames, .. } => *frames,
        }
    }

    /// Returns its own frame rate, frames per second; `None` where the files have none.
    pub fn rate(&self) -> Option<f32> {
        match &self.kind {
            ReferenceKind::Animated { rate, .. } => Some(*rate),
            ReferenceKind::Picture(_) | ReferenceKind::Sequence(_) => None,
        }
    }

    /// Returns the width and height of its first frame, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Decodes up to `count` frames from `first` on, and passes each on with its index until that returns false.
    pub fn decode(
        &self,
        first: usize,
        count: usize,
        mut pass: impl FnMut(usize, Result<DecodedImage, String>) -> bool,
    ) {
        match &self.kind {
            ReferenceKind::Picture(path) => {
                pass(0, read(path).and_then(|bytes| decode(path, bytes)));
            }
            ReferenceKind::Sequence(files) => {
                let start = files.first().map_or(0, |file| file.0);
                for frame in first..(first + count).min(self.frames()) {
                    // A number without a file shows the file before it.
                    let at = files.partition_point(|file| file.0 - start <= frame as u64);
                    let Some((_, path)) = files.get(at.saturating_sub(1)) else { return };
                    if !pass(frame, read(path).and_then(|bytes| decode(path, bytes))) {
                        return;
                    }
                }
            }
            ReferenceKind::Animated { path, frames, .. } => {
                let last = (first + count).min(*frames);
                let decoded = read(path).and_then(|bytes| {
                    for_each_frame(&bytes, |at, frame| {
                        if at < first {
                            return true;
                        }
                        let buffer = frame.into_buffer();
                        let (width, height) = buffer.dimensions();
                        let image = DecodedImage { width, height, pixels: buffer.into_raw() };
                        at < last && pass(at, Ok(image)) && at + 1 < last
                    })
                });
                if let Err(reason) = decoded {
                    pass(first, Err(reason));
                }
            }
        }
    }
}

/// Returns the name of a file for messages.
fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Reads a file of a limited size.
fn read(path: &Path) -> Result<Vec<u8>, String> {
    let wrong = |reason: &dyn std::fmt::Display| format!("{} cannot be read: {reason}", name(path));
    let file = File::open(path).map_err(|error| wrong(&error))?;
    let about = file.metadata().map_err(|error| wrong(&error))?;
    if !about.is_file() {
        return Err(wrong(&"it is no file"));
    }
    if about.len() > LARGEST_FILE {
        return Err(wrong(&format!("it is larger than {} MB", LARGEST_FILE >> 20)));
    }
    let mut bytes = Vec::new();
    let read = BufReader::new(file).take(LARGEST_FILE).read_to_end(&mut bytes);
    read.map_err(|error| wrong(&error))?;
    Ok(bytes)
}

/// Decodes a picture.
fn decode(path: &Path, bytes: Vec<u8>) -> Result<DecodedImage, String> {
    let image = Image { bytes: bytes.into(), ..Image::default() };
    decode_within(&image, REFERENCE_SIDE)
        .map_err(|reason| format!("{} cannot be shown: {reason}", name(path)))
}

/// Decodes the frames of a GIF one after another until `pass` returns false. A decoder that panics fails.
fn for_each_frame(bytes: &[u8], mut pass: impl FnMut(usize, image::Frame) -> bool) -> Result<(), String> {
    let work = std::panic::AssertUnwindSafe(|| {
        let mut decoder = GifDecoder::new(std::io::Cursor::new(bytes)).map_err(|error| error.to_string())?;
        let mut limits = image::Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(4096), Some(4096));
        image::ImageDecoder::set_limits(&mut decoder, limits).map_err(|error| error.to_string())?;
        for (at, frame) in decoder.into_frames().enumerate() {
            if !pass(at, frame.map_err(|error| error.to_string())?) {
                break;
            }
        }
        Ok(())
    });
    std::panic::catch_unwind(work).unwrap_or_else(|_| Err("the decoder failed".to_owned()))
}

/// Returns the number at the end of the name of a file without its extension, and the part of the name before it.
fn number_of(path: &Path) -> Option<(String, u64)> {
    let stem = path.file_stem()?.to_str()?;
    let digits = stem.len() - stem.trim_end_matches(|letter: char| letter.is_ascii_digit()).len();
    let (before, number) = stem.split_at(stem.len() - digits);
    Some((before.to_owned(), number.parse().ok()?))
}

/// Returns the files in the folder of `path` whose names differ only in the number at the end, ascending by number.
fn numbered(path: &Path, cancel: &Cancel) -> Vec<(u64, PathBuf)> {
    let Some((before, own)) = number_of(path) else { return Vec::new() };
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut files = vec![(own, path.to_owned())];
    for entry in entries.take(MOST_FILES).map_while(|entry| entry.ok().filter(|_| !cancel.is_cancelled())) {
        let other = entry.path();
        if other.extension() == path.extension()
            && let Some((other_before, number)) = number_of(&other)
            && other_before == before
            && number != own
        {
            files.push((number, other));
        }
    }
    files.sort();
    files.dedup_by_key(|file| file.0);
    files
}
