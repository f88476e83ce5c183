//! A movie to render, and its result.

use super::error::MovieRenderError;
use super::frames::MovieFrames;
use super::movie_run::MovieRun;
use super::parts::{in_parts, render_parts};
use super::progress::{MovieNews, ProgressClock};
use super::sequence::render_sequence;
use super::source::FrameSource;
use dragonfly_document::Cancel;
use dragonfly_movie::{Movie, MovieFormat, MovieReport, MovieSettings, MovieSound, MovieTarget};
use dragonfly_runtime::ThreadHandle;
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
    /// What the user is to be told, in sentences.
    pub notices: Vec<String>,
}

impl RenderedMovie {
    pub(super) fn of(report: MovieReport, kept: u64) -> Self {
        let MovieReport { frames: _, path, bytes, notices } = report;
        Self { kept, path, bytes, notices }
    }
}

/// Renders a movie: frame by frame from `source`, in this thread, while a job of `thread` encodes those before. `news` is called for each frame. It ends
/// between two frames when `cancel` is raised: an old file is still there then, frames in files of their own and complete parts are kept.
///
/// # Errors
///
/// A frame cannot be drawn, the movie cannot be written, or it was cancelled.
pub fn render_movie(
    mut order: MovieOrder,
    source: &mut dyn FrameSource,
    thread: &ThreadHandle,
    cancel: &Cancel,
    news: &mut dyn FnMut(MovieNews<'_>),
) -> Result<RenderedMovie, MovieRenderError> {
    order.settings.first = order.frames.first();
    let clock = ProgressClock::start(order.frames.count());
    let mut run = MovieRun { source, thread, cancel, news, clock };
    if order.format.is_sequence {
        return render_sequence(order, &mut run);
    }
    if let Some(place) = in_parts(&order) {
        return render_parts(order, place, &mut run);
    }
    let MovieOrder { format, settings, frames, target, resume, sound } = order;
    let movie = match sound {
        Some(sound) => Movie::begin_with_sound(format, &settings, target, sound)?,
        None => Movie::begin(format, &settings, target)?,
    };
    let mut rendered = RenderedMovie::of(run.render(movie, frames.numbers())?, 0);
    if resume {
        let notice = format!("{} is written in one piece, of which nothing could be kept", format.title);
        rendered.notices.push(notice);
    }
    Ok(rendered)
}
