//! An MP4 that is rendered in parts, which are joined at the end. Each part is complete or not there, so that a movie that was interrupted is resumed.

use super::error::MovieRenderError;
use super::movie_run::{MovieRun, whole};
use super::order::{MovieOrder, RenderedMovie};
use dragonfly_document::make_folder;
use dragonfly_movie::{
    GROUP, Movie, MovieFormat, MovieSettings, MovieTarget, has_movie, join_movies, movie_parts,
};
use dragonfly_store::{Vfs, remove_unfinished};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Name of the format that has parts.
const FORMAT: &str = "mp4";

/// Returns whether parts of a movie in this format can be rendered apart: files of frames, or parts that are joined.
pub fn has_parts(format: &MovieFormat) -> bool {
    format.is_sequence || format.name == FORMAT
}

/// Returns the folder of the parts of a movie, next to its file.
pub fn parts_folder(movie: &Path) -> PathBuf {
    let mut name = movie.as_os_str().to_owned();
    name.push(".parts");
    name.into()
}

/// Returns the frames and the file of a movie that is rendered in parts; `None` for others.
pub(super) fn in_parts(order: &MovieOrder) -> Option<(Range<u64>, Arc<dyn Vfs>, PathBuf)> {
    let range = order.frames.range().filter(|_| order.format.name == FORMAT)?;
    match &order.target {
        MovieTarget::Path { files, path } => Some((range, Arc::clone(files), path.clone())),
        MovieTarget::Stream(_) => None,
    }
}

/// Renders a movie in parts, or in one piece where it has only one.
pub(super) fn render_parts(
    order: MovieOrder,
    (range, files, path): (Range<u64>, Arc<dyn Vfs>, PathBuf),
    run: &mut MovieRun<'_>,
) -> Result<RenderedMovie, MovieRenderError> {
    let folder = PartFolder { files: Arc::clone(&files), folder: parts_folder(&path) };
    let settings = &order.settings;
    let count = range.end - range.start;
    if order.resume && has_movie(&*files, &path, settings, count) {
        run.clock.keep(count);
        // The program may have been killed between the last two steps of an earlier run.
        folder.remove();
        return Ok(RenderedMovie { kept: count, path: Some(path), ..RenderedMovie::default() });
    }
    let parts = movie_parts(range.clone(), GROUP);
    if parts.len() < 2 {
        let movie = match order.sound {
            Some(sound) => Movie::begin_with_sound(order.format, settings, order.target, sound)?,
            None => Movie::begin(order.format, settings, order.target)?,
        };
        let report = run.render(movie, range)?;
        folder.remove();
        return Ok(RenderedMovie::of(report, 0));
    }
    let rendered = render_all(&order, &folder, &parts, run);
    if rendered.is_err() {
        folder.remove_if_empty();
    }
    let (paths, notices) = rendered?;
    if run.cancel.is_cancelled() {
        return Err(MovieRenderError::Cancelled);
    }
    let mut report = whole(join_movies(&paths, range, order.target, order.sound)?)?;
    folder.remove();
    report.notices.splice(0..0, notices);
    Ok(RenderedMovie::of(report, run.clock.kept()))
}

/// Renders the parts that are missing. Returns the paths of all parts, and the notes for the user about one of them.
fn render_all(
    order: &MovieOrder,
    folder: &PartFolder,
    parts: &[(u64, u64)],
    run: &mut MovieRun<'_>,
) -> Result<(Vec<PathBuf>, Vec<String>), MovieRenderError> {
    let mut paths = Vec::with_capacity(parts.len());
    let mut notices = Vec::new();
    for &(first, count) in parts {
        let path = folder.path(first, count);
        let settings = MovieSettings { first, ..order.settings.clone() };
        if order.resume && has_movie(&*folder.files, &path, &settings, count) {
            run.clock.keep(count);
        } else {
            make_folder(&path).map_err(MovieRenderError::Folder)?;
            let target = MovieTarget::Path { files: Arc::clone(&folder.files), path: path.clone() };
            let movie = Movie::begin(order.format, &settings, target)?;
            notices = run.render(movie, first..first + count)?.notices;
        }
        paths.push(path);
    }
    Ok((paths, notices))
}

/// The folder of the parts of one movie.
struct PartFolder {
    files: Arc<dyn Vfs>,
    folder: PathBuf,
}

impl PartFolder {
    /// Returns the path of a part.
    fn path(&self, first: u64, count: u64) -> PathBuf {
        self.folder.join(format!("{first:04}-{:04}.mp4", first + count - 1))
    }

    /// Removes the parts, and the folder if nothing else is in it. What cannot be removed does no harm.
    fn remove(&self) {
        let names = self.files.list(&self.folder).unwrap_or_default();
        for name in names.iter().filter(|name| name.to_str().is_some_and(is_part_name)) {
            let _ = self.files.remove(&self.folder.join(name));
        }
        remove_unfinished(&*self.files, &self.folder, &is_part_name);
        self.remove_if_empty();
    }

    fn remove_if_empty(&self) {
        let _ = std::fs::remove_dir(&self.folder);
    }
}

/// Returns whether a file is a part by its name.
fn is_part_name(name: &str) -> bool {
    let numbers = name.strip_suffix(".mp4").and_then(|stem| stem.split_once('-'));
    let is_number = |text: &str| text.len() >= 4 && text.bytes().all(|byte| byte.is_ascii_digit());
    numbers.is_some_and(|(first, last)| is_number(first) && is_number(last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_with_the_names_of_parts_are_removed() {
        let found = ["0000-0047.mp4", "12345-12392.mp4", "0-47.mp4", "a-b.mp4", "0000-0047.txt", "0000.mp4"];
        assert_eq!(found.map(is_part_name), [true, true, false, false, false, false]);
    }
}
