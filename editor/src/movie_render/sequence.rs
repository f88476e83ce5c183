//! Movies with a file for each frame.

use super::error::MovieRenderError;
use super::movie_run::MovieRun;
use super::order::{MovieOrder, RenderedMovie};
use dragonfly_movie::{Movie, MovieTarget, SequenceName};

/// Renders a sequence. Resumed, it keeps the frames that are there and show the same.
pub(super) fn render_sequence(
    order: MovieOrder,
    run: &mut MovieRun<'_>,
) -> Result<RenderedMovie, MovieRenderError> {
    let MovieOrder { format, settings, frames, target, resume, .. } = order;
    let mut missing: Vec<u64> = frames.numbers().collect();
    if let (true, MovieTarget::Path { files, path }) = (resume, &target)
        && let Some(name) = SequenceName::parse(path)
    {
        missing.retain(|&number| !name.has_frame(&**files, number, &settings.tag));
    }
    run.clock.keep(frames.count() - missing.len() as u64);
    if missing.is_empty() {
        return Ok(RenderedMovie { kept: run.clock.kept(), ..RenderedMovie::default() });
    }
    let movie = Movie::begin(format, &settings, target)?;
    let report = run.render(movie, missing.into_iter())?;
    Ok(RenderedMovie::of(report, run.clock.kept()))
}
