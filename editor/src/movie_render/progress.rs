//! Progress of a movie.

use std::time::Instant;

/// Progress after a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovieProgress {
    /// Number of the frame in the whole movie.
    pub number: u64,
    /// Number of frames that are done, with those that were there already.
    pub done: u64,
    /// Number of all frames.
    pub of: u64,
    /// Estimated time until the last frame is done, seconds.
    pub seconds_left: f64,
}

/// Events while a movie is rendered.
#[derive(Clone, Copy, Debug)]
pub enum MovieNews<'a> {
    /// A frame was rendered.
    Frame(MovieProgress),
    /// A part of what is rendered cannot be shown, in a sentence.
    Warning(&'a str),
}

/// Counts frames, and estimates the time for the rest of them.
#[derive(Debug)]
pub(super) struct ProgressClock {
    began: Instant,
    /// Frames that were there already, and those that were rendered.
    kept: u64,
    rendered: u64,
    of: u64,
}

impl ProgressClock {
    /// Starts to count up to `of` frames.
    pub(super) fn start(of: u64) -> Self {
        Self { began: Instant::now(), kept: 0, rendered: 0, of }
    }

    /// Counts frames that need not be rendered.
    pub(super) fn keep(&mut self, frames: u64) {
        self.kept += frames;
    }

    /// Returns how many frames did not have to be rendered.
    pub(super) fn kept(&self) -> u64 {
        self.kept
    }

    /// Counts a frame that was rendered.
    pub(super) fn rendered(&mut self, number: u64) -> MovieProgress {
        self.rendered += 1;
        let done = self.kept + self.rendered;
        let left = self.of.saturating_sub(done);
        let seconds_left = self.began.elapsed().as_secs_f64() * left as f64 / self.rendered as f64;
        MovieProgress { number, done, of: self.of, seconds_left }
    }
}
