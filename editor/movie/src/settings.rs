//! Settings of a movie.

use crate::error::MovieError;
use crate::frame::LARGEST_SIDE;
use dragonfly_anim::stage::time::StageRate;
use std::ops::Range;

/// Number of frames of a group: each begins with a frame that needs no other one, and parts of a movie are whole groups.
pub const GROUP: u64 = 48;

/// Largest number of a first frame: a million years.
const LAST_FRAME: u64 = 1 << 50;

/// Settings of a movie.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MovieSettings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Frames per second.
    pub rate: StageRate,
    /// Coarseness of formats with loss, from 10 (best) to 45 (smallest file); 24 is good and 27 small.
    pub coarseness: u8,
    /// Number of the first frame: the number in the first file name of a sequence. In an MP4, groups begin at the multiples of [`GROUP`] and
    /// at this frame, so that it begins its movie or is such a multiple.
    pub first: u64,
    /// Whether an animation begins again after its end; only for formats that are images.
    pub repeats: bool,
    /// Identity of what is rendered, at most 200 bytes: parts of an MP4 with different ones are not joined, and a frame in a file of its own
    /// is recognized by it. Without line ends.
    pub tag: String,
}

impl MovieSettings {
    /// Creates settings for a movie of good quality that starts at frame 0.
    pub fn new(size: [u32; 2], rate: StageRate) -> Self {
        Self { size, rate, coarseness: 24, first: 0, repeats: true, tag: String::new() }
    }

    /// Returns an error unless the settings are possible in a format with sides of up to `side` pixels.
    pub(crate) fn check(&self, format: &'static str, side: u32) -> Result<(), MovieError> {
        let side = side.min(LARGEST_SIDE);
        let [width, height] = self.size;
        let wrong = |reason| Err(MovieError::Settings { format, reason });
        if width == 0 || height == 0 || width > side || height > side {
            return wrong(format!(
                "a movie of {width} × {height} pixels: from 1 × 1 to {side} × {side} are possible"
            ));
        }
        if !(10..=45).contains(&self.coarseness) {
            return wrong(format!("a coarseness of {}: from 10 to 45 are possible", self.coarseness));
        }
        if self.first > LAST_FRAME {
            return wrong(format!(
                "a movie that begins at frame {}: at most {LAST_FRAME} is possible",
                self.first
            ));
        }
        if self.tag.len() > 200 {
            return wrong(format!("a tag of {} bytes: at most 200 are possible", self.tag.len()));
        }
        Ok(())
    }
}

/// Returns the first frame and the number of frames of each part, when `frames` are rendered in parts of about `length` frames. Parts end at
/// whole groups, so that the joined parts are what one pass writes.
pub fn movie_parts(frames: Range<u64>, length: u64) -> Vec<(u64, u64)> {
    let length = length.div_ceil(GROUP).max(1).saturating_mul(GROUP);
    let mut parts = Vec::new();
    let mut next = frames.start;
    while next < frames.end {
        let end = (next / length + 1).saturating_mul(length).min(frames.end);
        parts.push((next, end - next));
        next = end;
    }
    parts
}
