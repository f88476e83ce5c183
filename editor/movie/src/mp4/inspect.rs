//! Files of movies looked at without reading their frames: which frames a part has, and whether a movie is already there.

use super::part::MoviePart;
use crate::error::MovieError;
use crate::settings::{GROUP, MovieSettings};
use dragonfly_store::Vfs;
use std::ops::Range;
use std::path::Path;

/// Returns the numbers of the frames of a part of an MP4.
///
/// # Errors
/// When the file cannot be read, or is no part of a movie of this program.
pub fn part_frames(files: &dyn Vfs, path: &Path) -> Result<Range<u64>, MovieError> {
    let head = MoviePart::open(files, path)?.into_head();
    Ok(head.label.first..head.label.first + head.frames)
}

/// Returns whether there is a complete MP4 of `frames` frames with these settings, with sound or without; equal tags mean equal size and
/// rate.
pub fn has_movie(files: &dyn Vfs, path: &Path, settings: &MovieSettings, frames: u64) -> bool {
    let Ok(movie) = MoviePart::open_any(files, path) else { return false };
    let (head, label) = (movie.head(), &movie.head().label);
    (label.first, label.group, label.coarseness, &label.tag, head.frames)
        == (settings.first, GROUP, settings.coarseness, &settings.tag, frames)
        && movie.is_whole()
}
