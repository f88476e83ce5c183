//! Parts of a movie that were encoded apart, joined without encoding them again.

use super::part::MoviePart;
use super::writer::{Mp4File, ticks};
use crate::error::MovieError;
use crate::report::MovieReport;
use crate::sound::MovieSound;
use crate::target::MovieTarget;
use dragonfly_anim::stage::time::StageRate;
use std::path::PathBuf;

/// Joins parts of an MP4, in any order, to the movie that one pass would have written, byte for byte; with the
/// sound of the whole movie, if there is one: parts have none.
///
/// # Errors
/// When the parts are no whole movie (a part is missing, twice there, or of another movie), or a file cannot be read or written. There is
/// no joined file then.
pub fn join_movies(
    parts: &[PathBuf],
    target: MovieTarget,
    sound: Option<MovieSound>,
) -> Result<MovieReport, MovieError> {
    let (files, path) = target.into_path("MP4")?;
    let mut opened = Vec::new();
    for part in parts {
        opened.push(MoviePart::open(&*files, part)?);
    }
    opened.sort_by_key(|part| part.label.first);
    let Some(first) = opened.first() else { return Err(MovieError::Empty) };
    let rate = StageRate::new(first.timescale.get(), first.delta)
        .filter(|rate| (first.timescale, first.delta) == ticks(*rate))
        .ok_or_else(|| first.wrong("it has no rate of a movie".to_owned()))?;
    let mut next = first.label.first;
    for part in &opened {
        check(part, first, next)?;
        next += part.frames();
    }
    let mut joined = Mp4File::create(files, &path, first.label.clone(), rate, sound)?;
    for part in &opened {
        part.samples(|bytes, is_whole| joined.picture(bytes, is_whole, || Ok(part.entry.clone())))?;
    }
    let frames = joined.frames();
    let (path, bytes) = joined.end()?;
    Ok(MovieReport { frames, path: Some(path), bytes, notices: Vec::new() })
}

/// Returns an error unless a part fits to the first one and begins at frame `next`.
fn check(part: &MoviePart, first: &MoviePart, next: u64) -> Result<(), MovieError> {
    let begins = part.label.first;
    let (label, wanted) = (&part.label, &first.label);
    let reason = if begins > next {
        format!("it begins at frame {begins}, and the frames from {next} on are missing")
    } else if begins < next {
        format!("it begins at frame {begins}, which is in another part, too")
    } else if !begins.is_multiple_of(label.group.max(1)) {
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
