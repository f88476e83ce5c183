//! `dragonfly movie … --job ENGINE -o FILE`: a job file for a farm, which renders the movie in parts and joins them.

use super::super::farm::{FarmEngine, FarmJob, PartNumbers};
use super::super::output::write_file;
use super::super::{Failure, tell};
use super::arguments::MovieArguments;
use super::content::MovieContent;
use super::frames_argument::{ChosenFrames, FramesArgument};
use super::output_choice::{format_of, is_stdout};
use crate::movie_render::has_parts;
use dragonfly_movie::GROUP;
use std::path::{Path, PathBuf};

/// Writes the job file.
pub(super) fn write(arguments: &MovieArguments, engine: FarmEngine) -> Result<(), Failure> {
    let movie = arguments.movie.clone().unwrap_or_else(|| movie_of(arguments));
    let format = format_of(arguments.format.as_deref(), &movie)?;
    if !has_parts(format) {
        let reason = format!("{} is written in one piece; mp4, png and exr have parts", format.title);
        return Err(Failure::input("--job", reason));
    }
    let chunk = arguments.chunk.get();
    if !format.is_sequence && !chunk.is_multiple_of(GROUP) {
        let reason = format!("{chunk} is no multiple of {GROUP}, as parts of an MP4 have");
        return Err(Failure::input("--chunk", reason));
    }
    let content = MovieContent::of(arguments)?;
    let frames = ChosenFrames::of(&arguments.frames, content.frames)?;
    if frames.is_part {
        return Err(Failure::input("--frames", "a job is made for a whole movie; write a range"));
    }
    let frames = frames.movie;
    if frames.range().is_none() && !format.is_sequence {
        return Err(Failure::input(
            "--frames",
            "an MP4 has every frame; only png and exr can leave some out",
        ));
    }
    let first = frames.first() / chunk * chunk;
    let numbers = PartNumbers { first, step: chunk, count: (frames.last() - first) / chunk + 1 };
    let mut starts = (0..numbers.count).map(|part| first + part * chunk);
    if let Some(empty) = starts.find(|start| frames.within(*start..start + chunk).is_none()) {
        let reason =
            format!("the part of {chunk} frames from {empty} on has none of those that are rendered");
        return Err(Failure::input("--chunk", reason));
    }
    let what = what(arguments);
    let mut render = what.clone();
    render.extend(how(arguments));
    render.push("--resume".to_owned());
    let job = if format.is_sequence {
        let output = movie.display().to_string();
        FarmJob::of_frames("dragonfly-movie", render, numbers, |_| output.clone(), None)
    } else {
        let folder = parts_of(&movie);
        let output = |part: &str| folder.join(format!("{part}.mp4")).display().to_string();
        let mut last = what;
        last.extend(["--join".to_owned(), folder.display().to_string()]);
        last.extend(["-o".to_owned(), movie.display().to_string()]);
        FarmJob::of_frames("dragonfly-movie", render, numbers, output, Some(last))
    };
    let text = job.and_then(|job| engine.text(&job)).map_err(Failure::Input)?;
    write_file(&arguments.output, text.as_bytes())?;
    if !is_stdout(&arguments.output) {
        let (parts, output) = (numbers.count, arguments.output.display());
        tell(format_args!("wrote {output} ({parts} parts of {})", movie.display()));
    }
    Ok(())
}

/// Returns the movie of a job where the user names none.
fn movie_of(arguments: &MovieArguments) -> PathBuf {
    let stem = arguments.file.as_deref().and_then(Path::file_stem).unwrap_or("dragonfly".as_ref());
    let stem = if stem == "demo:" { "dragonfly".as_ref() } else { stem };
    let named = |extension: &str| {
        let mut name = stem.to_owned();
        name.push(extension);
        PathBuf::from(name)
    };
    match arguments.format.as_deref() {
        Some(format @ ("png" | "exr")) => {
            let mut folder = stem.to_owned();
            folder.push("-frames");
            Path::new(&folder).join(named(&format!(".####.{format}")))
        }
        Some(_) | None => named(".mp4"),
    }
}

/// Returns the folder of the parts of a movie.
fn parts_of(movie: &Path) -> PathBuf {
    let mut name = movie.file_stem().unwrap_or_default().to_owned();
    name.push("-parts");
    movie.with_file_name(name)
}

/// Returns the arguments that choose what the movie shows, and when.
fn what(arguments: &MovieArguments) -> Vec<String> {
    let mut list = vec!["movie".to_owned()];
    list.extend(arguments.file.as_ref().map(|file| file.display().to_string()));
    let options = [
        ("--take", arguments.take.written().map(str::to_owned)),
        ("--script", arguments.script.name().map(str::to_owned)),
        ("--shot", arguments.shot.clone()),
        ("--camera", arguments.camera.as_ref().and_then(|camera| camera.written().map(str::to_owned))),
        ("--fps", arguments.fps.map(|rate| rate.to_string())),
    ];
    let chosen = options.into_iter().filter_map(|(name, value)| Some([name.to_owned(), value?]));
    list.extend(chosen.flatten());
    for frames in &arguments.frames {
        if let FramesArgument::Range { first, last, step } = frames {
            list.extend(["--frames".to_owned(), format!("{first}-{last}x{step}")]);
        }
    }
    list.extend(arguments.import.to_arguments());
    list
}

/// Returns the arguments that choose how its frames are rendered and encoded.
fn how(arguments: &MovieArguments) -> Vec<String> {
    let mut list = arguments.view.to_arguments();
    let options = [
        ("--format", arguments.format.clone()),
        ("--quality", Some(arguments.quality.to_string()).filter(|_| arguments.quality != 24)),
    ];
    let chosen = options.into_iter().filter_map(|(name, value)| Some([name.to_owned(), value?]));
    list.extend(chosen.flatten());
    list
}
