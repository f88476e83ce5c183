//! Renders a movie in the way of its format: as files, in parts, or in one piece.

use super::error::MovieRenderError;
use super::movie_run::MovieRun;
use super::order::{MovieOrder, RenderedMovie};
use super::parts::{in_parts, render_parts};
use super::progress::{MovieNews, ProgressClock};
use super::sequence::render_sequence;
use super::source::FrameSource;
use dragonfly_document::Cancel;
use dragonfly_movie::Movie;
use dragonfly_runtime::ThreadHandle;

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
