//! The loop that renders the frames of a movie.

use super::error::MovieRenderError;
use super::frame_pipe::FramePipe;
use super::progress::{MovieNews, ProgressClock};
use super::source::FrameSource;
use dragonfly_document::Cancel;
use dragonfly_movie::{Movie, MovieReport};
use dragonfly_runtime::ThreadHandle;

/// Returns the report of a movie that has all of its frames.
pub(super) fn whole(report: MovieReport) -> Result<MovieReport, MovieRenderError> {
    match report.left_out {
        0 => Ok(report),
        frames => Err(MovieRenderError::Full(frames)),
    }
}

/// A movie that is being rendered, in one piece or in several.
pub(super) struct MovieRun<'a> {
    pub(super) source: &'a mut dyn FrameSource,
    /// The thread that the encoder belongs to.
    pub(super) thread: &'a ThreadHandle,
    pub(super) cancel: &'a Cancel,
    pub(super) news: &'a mut dyn FnMut(MovieNews<'_>),
    pub(super) clock: ProgressClock,
}

impl MovieRun<'_> {
    /// Renders frames into a movie, and completes it.
    pub(super) fn render(
        &mut self,
        movie: Movie,
        numbers: impl Iterator<Item = u64>,
    ) -> Result<MovieReport, MovieRenderError> {
        let pipe = FramePipe::start(self.thread, movie)?;
        for number in numbers {
            if self.cancel.is_cancelled() {
                return Err(MovieRenderError::Cancelled);
            }
            let frame = self.source.frame(number)?;
            for warning in self.source.take_warnings() {
                (self.news)(MovieNews::Warning(&warning));
            }
            pipe.frame(number, frame)?;
            (self.news)(MovieNews::Frame(self.clock.rendered(number)));
        }
        whole(pipe.end()?)
    }
}
