//! Rendering a movie here.

use super::super::{Failure, tell};
use super::arguments::MovieArguments;
use super::content::MovieContent;
use super::ffmpeg::FfmpegRun;
use super::ffmpeg_sound::FfmpegSound;
use super::frames_argument::ChosenFrames;
use super::interrupt::Interrupt;
use super::output_choice::{format_of, is_stdout};
use super::printer::ProgressPrinter;
use crate::movie_render::{
    MovieNews, MovieOrder, MovieRenderError, RenderedMovie, has_parts, parts_folder, render_movie,
};
use dragonfly_document::{Cancel, make_folder};
use dragonfly_movie::{GROUP, MovieError, MovieFormat, MovieSettings, MovieTarget};
use dragonfly_runtime::Thread;
use std::io;

/// Renders the movie that the arguments describe.
pub(super) fn run(arguments: &MovieArguments) -> Result<(), Failure> {
    let output = &arguments.output;
    let is_external = arguments.external_ffmpeg.is_some();
    if is_external && is_stdout(output) {
        return Err(Failure::input("-o -", "ffmpeg needs the name of a file"));
    }
    let named = if is_external { Some("y4m") } else { arguments.format.as_deref() };
    let format = format_of(named, output)?;
    if is_stdout(output) && !format.can_stream {
        return Err(Failure::input("-o -", format_args!("{} cannot be streamed; use y4m", format.title)));
    }
    let content = MovieContent::of(arguments)?;
    let frames = ChosenFrames::of(&arguments.frames, content.frames)?;
    check_frames(format, &frames)?;
    let cancel = Cancel::default();
    let interrupt = Interrupt::watch(&cancel);
    let rendered = render(arguments, format, content, &frames, &cancel);
    if rendered.is_err() && cancel.is_cancelled() {
        tell_cancelled(arguments, format);
        interrupt.end();
    }
    report(arguments, &frames, &rendered?);
    Ok(())
}

/// Checks that the format can have these frames.
fn check_frames(format: &MovieFormat, frames: &ChosenFrames) -> Result<(), Failure> {
    let ChosenFrames { movie, rendered, is_part } = frames;
    let refused = |reason: String| Err(Failure::input("--frames", reason));
    if rendered.range().is_none() && !format.is_sequence {
        return refused(format!("{} has every frame; only png and exr can leave some out", format.title));
    }
    if *is_part && !has_parts(format) {
        return refused(format!("{} is written in one piece; mp4, png and exr have parts", format.title));
    }
    if *is_part && !format.is_sequence {
        let begins = rendered.first() == movie.first() || rendered.first().is_multiple_of(GROUP);
        let ends = rendered.last() == movie.last() || (rendered.last() + 1).is_multiple_of(GROUP);
        if !begins || !ends {
            let example = format!("such as {GROUP}+{GROUP} or 0+{}", 2 * GROUP);
            return refused(format!(
                "parts of an MP4 begin and end at multiples of {GROUP} frames, {example}"
            ));
        }
    }
    Ok(())
}

/// Renders frames of the content.
fn render(
    arguments: &MovieArguments,
    format: &'static MovieFormat,
    content: MovieContent,
    frames: &ChosenFrames,
    cancel: &Cancel,
) -> Result<RenderedMovie, Failure> {
    let thread = Thread::start("movie")
        .map_err(|error| Failure::Machine(format!("no thread could be started: {error}")))?;
    let mut printer = ProgressPrinter::new(arguments.progress, &content.title);
    let settings = MovieSettings {
        coarseness: arguments.quality,
        tag: content.tag(format, cancel)?,
        ..MovieSettings::new(content.size(), content.rate)
    };
    let mut warn = |text: &str| printer.tell(MovieNews::Warning(text));
    let sound = match format.has_sound && !frames.is_part {
        true => content.sound(&frames.rendered, cancel, &mut warn)?,
        false => None,
    };
    let is_external = arguments.external_ffmpeg.is_some();
    if content.has_sound() && !format.has_sound && !is_external {
        warn("its sounds are left out: only an MP4 has sound");
    }
    let output = &arguments.output;
    if !is_stdout(output) {
        make_folder(output).map_err(Failure::Input)?;
    }
    let samples = if is_external { content.samples(&frames.rendered, cancel, &mut warn)? } else { None };
    // Its file is removed when the movie is complete or given up.
    let for_ffmpeg = samples.map(|samples| FfmpegSound::write(output, samples, cancel)).transpose()?;
    let mut source = content.into_frames(format)?;
    let (target, encoder) = match arguments.external_ffmpeg.as_deref() {
        Some(words) => {
            let (encoder, input) = FfmpegRun::start(words, output, for_ffmpeg.as_ref(), thread.handle())?;
            (MovieTarget::Stream(Box::new(input)), Some(encoder))
        }
        None if is_stdout(output) => (MovieTarget::Stream(Box::new(io::stdout())), None),
        None => (MovieTarget::path(output), None),
    };
    let resume = arguments.resume;
    let order = MovieOrder { format, settings, frames: frames.rendered, target, resume, sound };
    let mut news = |news: MovieNews<'_>| printer.tell(news);
    let rendered = render_movie(order, &mut source, thread.handle(), cancel, &mut news);
    drop(printer);
    if let Some(encoder) = encoder {
        match &rendered {
            // An encoder that ended before has the reason for what could not be written to it.
            Ok(_) | Err(MovieRenderError::Movie(MovieError::Stream(_))) => encoder.end()?,
            Err(_) => encoder.kill(),
        }
    }
    rendered.map_err(Failure::from)
}

/// Prints what is kept of a movie that was cancelled.
fn tell_cancelled(arguments: &MovieArguments, format: &MovieFormat) {
    let parts = parts_folder(&arguments.output);
    if format.is_sequence {
        tell("cancelled; the frames so far are kept, and --resume renders the others");
    } else if parts.is_dir() {
        let parts = parts.display();
        tell(format_args!("cancelled; complete parts are kept in {parts}, and --resume renders the others"));
    } else {
        tell("cancelled; the movie is not complete");
    }
}

/// Prints what was written.
fn report(arguments: &MovieArguments, frames: &ChosenFrames, rendered: &RenderedMovie) {
    for notice in &rendered.notices {
        tell(notice);
    }
    let output = &arguments.output;
    if is_stdout(output) {
        return;
    }
    let count = frames.rendered.count();
    let noun = if count == 1 { "frame" } else { "frames" };
    let kept = match rendered.kept {
        0 => String::new(),
        kept => format!(", {kept} of them kept"),
    };
    tell(format_args!("wrote {} ({count} {noun}{kept})", output.display()));
}
