//! `dragonfly movie [FILE] --join PART… -o out.mp4`: parts of an MP4 put together without encoding them again.

use super::super::{Failure, tell};
use super::arguments::MovieArguments;
use super::content::MovieContent;
use super::frames_argument::ChosenFrames;
use super::output_choice::is_stdout;
use crate::movie_render::MovieFrames;
use dragonfly_document::{Cancel, make_folder};
use dragonfly_movie::{MovieTarget, join_movies, part_frames};
use dragonfly_store::RealFiles;
use std::fs;
use std::path::{Path, PathBuf};

/// Joins the parts.
pub(super) fn join(arguments: &MovieArguments) -> Result<(), Failure> {
    let output = &arguments.output;
    if is_stdout(output) {
        return Err(Failure::input("-o -", "an MP4 cannot be written to standard output"));
    }
    let parts = listed(&arguments.join)?;
    let content = arguments.file.is_some().then(|| MovieContent::of(arguments)).transpose()?;
    let all = match &content {
        Some(content) => content.frames,
        None => frames_of(&parts)?,
    };
    let chosen = ChosenFrames::of(&arguments.frames, all)?;
    let Some(range) = chosen.rendered.range() else {
        return Err(Failure::input("--frames", "an MP4 has every frame"));
    };
    let mut warn = |text: &str| tell(format_args!("warning: {text}"));
    let sound = content.map(|content| content.sound(&chosen.rendered, &Cancel::default(), &mut warn));
    let sound = sound.transpose()?.flatten();
    make_folder(output).map_err(Failure::Input)?;
    let report = join_movies(&parts, range, MovieTarget::path(output), sound)?;
    for notice in &report.notices {
        tell(notice);
    }
    tell(format_args!("wrote {} ({} parts, {} frames)", output.display(), parts.len(), report.frames));
    Ok(())
}

/// Returns the parts, those of a folder in place of it.
fn listed(named: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut parts = Vec::new();
    for path in named {
        if !path.is_dir() {
            parts.push(path.clone());
            continue;
        }
        let failed = |error: std::io::Error| Failure::input(path.display(), error);
        let is_part = |path: &Path| {
            let hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
            !hidden && path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mp4"))
        };
        let mut found = Vec::new();
        for entry in fs::read_dir(path).map_err(failed)? {
            found.push(entry.map_err(failed)?.path());
        }
        found.retain(|path| is_part(path));
        found.sort();
        if found.is_empty() {
            return Err(Failure::input(path.display(), "has no parts (.mp4)"));
        }
        parts.extend(found);
    }
    Ok(parts)
}

/// Returns the frames from the first to the last one of all parts.
fn frames_of(parts: &[PathBuf]) -> Result<MovieFrames, Failure> {
    let (mut first, mut end) = (u64::MAX, 0);
    for part in parts {
        let frames = part_frames(&RealFiles, part)?;
        (first, end) = (first.min(frames.start), end.max(frames.end));
    }
    MovieFrames::new(first..end).ok_or_else(|| Failure::input("--join", "the parts have no frames"))
}
