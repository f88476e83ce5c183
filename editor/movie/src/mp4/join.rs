//! Parts of a movie that were encoded apart, joined without encoding them again.

use super::part::{MoviePart, PartHead};
use super::track::ticks;
use super::writer::Mp4File;
use crate::error::MovieError;
use crate::report::MovieReport;
use crate::sound::MovieSound;
use crate::target::MovieTarget;
use dragonfly_anim::stage::time::StageRate;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// Joins parts of an MP4, in any order, to the movie of `frames` that one pass would have written, byte for byte; with the
/// sound of the whole movie, if there is one: parts have none. One part is open at a time.
///
/// # Errors
/// When the parts are not these frames (a part is missing, twice there, or of another movie), or a file cannot be read or written. There is
/// no joined file then.
pub fn join_movies(
    parts: &[PathBuf],
    frames: Range<u64>,
    target: MovieTarget,
    sound: Option<MovieSound>,
) -> Result<MovieReport, MovieError> {
    join_movies_with(parts, frames, target, sound, &mut |_, _| true)
}

/// Joins parts as [`join_movies`]. `progress` receives the number of frames that were copied and that of all, before each frame, and returns
/// whether to continue.
///
/// # Errors
/// As [`join_movies`], and [`MovieError::Cancelled`] where `progress` returned false.
pub fn join_movies_with(
    parts: &[PathBuf],
    frames: Range<u64>,
    target: MovieTarget,
    sound: Option<MovieSound>,
    progress: &mut dyn FnMut(u64, u64) -> bool,
) -> Result<MovieReport, MovieError> {
    let (files, path) = target.into_path("MP4")?;
    let mut heads = Vec::new();
    for part in parts {
        heads.push(MoviePart::open(&*files, part)?.into_head());
    }
    heads.sort_by_key(|part| part.label.first);
    let Some(first) = heads.first().filter(|_| !frames.is_empty()) else { return Err(MovieError::Empty) };
    let rate = StageRate::new(first.timescale.get(), first.delta)
        .filter(|rate| (first.timescale, first.delta) == ticks(*rate))
        .ok_or_else(|| first.wrong("it has no rate of a movie".to_owned()))?;
    let (mut next, mut last) = (frames.start, first);
    for part in &heads {
        check(part, first, next, frames.start)?;
        next = next.saturating_add(part.frames);
        if next > frames.end {
            return Err(
                part.wrong(format!("it goes on after the end of the movie, which has {} frames", frames.end))
            );
        }
        last = part;
    }
    if next < frames.end {
        return Err(
            last.wrong(format!("it ends before frame {next}, and the frames from there on are missing"))
        );
    }
    let mut copied = 0;
    let mut joined = Mp4File::create(Arc::clone(&files), &path, first.label.clone(), rate, sound)?;
    for head in &heads {
        let part = MoviePart::open(&*files, &head.path)?;
        if !part.head().is_same(head) {
            return Err(head.wrong("it was changed while the parts were joined".to_owned()));
        }
        part.samples(|bytes, is_whole| {
            if !progress(copied, frames.end - frames.start) {
                return Err(MovieError::Cancelled);
            }
            copied += 1;
            joined.picture(bytes, is_whole, || Ok(head.entry.clone()))
        })?;
    }
    joined.end(Vec::new())
}

/// Returns an error unless a part of a movie that begins at frame `start` fits to the first part and begins at frame `next`.
fn check(part: &PartHead, first: &PartHead, next: u64, start: u64) -> Result<(), MovieError> {
    let begins = part.label.first;
    let (label, wanted) = (&part.label, &first.label);
    let reason = if begins > next {
        format!("it begins at frame {begins}, and the frames from {next} on are missing")
    } else if begins < next {
        format!("it begins at frame {begins}, which is in another part, too")
    } else if begins != start && !begins.is_multiple_of(label.group.max(1)) {
        format!("it begins at frame {begins}, in the middle of a group; the part before it is not complete")
    } else if (part.timescale, part.delta) != (first.timescale, first.delta) {
        "it has another number of frames per second".to_owned()
    } else if (label.group, label.coarseness, &label.tag) != (wanted.group, wanted.coarseness, &wanted.tag) {
        "it is a part of another movie, or has other settings".to_owned()
    } else if part.entry != first.entry {
        "its pictures have another size or encoding".to_owned()
    } else {
        return Ok(());
    };
    Err(part.wrong(reason))
}
