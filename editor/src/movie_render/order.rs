//! A movie to render, and its result.

use super::frames::MovieFrames;
use dragonfly_movie::{MovieFormat, MovieReport, MovieSettings, MovieSound, MovieTarget};
use std::path::PathBuf;

/// A movie to render.
#[derive(Debug)]
pub struct MovieOrder {
    /// The format.
    pub format: &'static MovieFormat,
    /// Size, rate, coarseness and identity; the first frame is that of [`Self::frames`].
    pub settings: MovieSettings,
    /// The frames. Only a sequence can leave some out.
    pub frames: MovieFrames,
    /// The destination.
    pub target: MovieTarget,
    /// Whether frames and parts that are there and have the same identity are kept.
    pub resume: bool,
    /// The sound of all frames, for a format that has sound.
    pub sound: Option<MovieSound>,
}

/// A movie that was rendered.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RenderedMovie {
    /// Number of frames that were there already.
    pub kept: u64,
    /// The file, or that of the last frame that was rendered; `None` for a stream, and for a sequence of which every frame was there.
    pub path: Option<PathBuf>,
    /// Number of bytes that were written; of a sequence without the frames that were there.
    pub bytes: u64,
    /// Notes for the user, in sentences.
    pub notices: Vec<String>,
}

impl RenderedMovie {
    pub(super) fn of(report: MovieReport, kept: u64) -> Self {
        let MovieReport { frames: _, left_out: _, path, bytes, notices } = report;
        Self { kept, path, bytes, notices }
    }
}
