//! `dragonfly [FILE…]`: the editor; where there is no display, a picture instead.

use super::choice::{Size, load, source};
use super::{Command, Failure, output, quiet, render, tell};
use crate::app::{self, AppError, Mistake, Options};
use dragonfly_document::Source;
use std::env;
use std::path::{Path, PathBuf};

/// What the editor opens.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct Arguments {
    /// Models to open (.glb, .gltf, .dfm); without any, the built-in dragonfly
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Talks instead of opening a window: one JSON edit or query a line in, one JSON answer a line out
    #[arg(long)]
    stdio: bool,
    /// Prints the table of the editor's commands: id, title, tooltip, keys, and when each can be run
    #[arg(long, conflicts_with = "stdio")]
    commands: bool,
    /// Loses the graphics device after every so many drawn frames, to show that nothing is lost with it
    #[arg(long, value_name = "FRAMES", hide = true)]
    lose_device: Option<u32>,
    /// Goes on drawing however often the device is lost
    #[arg(long, hide = true)]
    never_pause: bool,
    /// Where settings are kept, instead of the usual place
    #[arg(long, value_name = "FOLDER")]
    settings: Option<PathBuf>,
    /// Where unsaved work is recorded, instead of the usual place
    #[arg(long, value_name = "FOLDER")]
    autosave: Option<PathBuf>,
    /// Does these edits once the model is there, one JSON object a line
    #[arg(long, value_name = "EDITS", hide = true)]
    edits: Option<PathBuf>,
    /// Lets the document fail at this change
    #[arg(long, value_name = "CHANGES", hide = true)]
    fail_at: Option<u32>,
    /// Lets another part fail: panels, input, message or picture, once so many steps are done, so often
    #[arg(long, value_name = "PLACE:STEPS:TIMES", hide = true)]
    fail: Option<Mistake>,
}

impl Command for Arguments {
    fn run(self) -> Result<(), Failure> {
        if self.commands {
            return super::command_list::print();
        }
        if self.stdio {
            return super::stdio::talk(self.files.first());
        }
        if !has_display() {
            quiet::about_wayland();
            return self.draw("DISPLAY and WAYLAND_DISPLAY are not set");
        }
        match app::run(self.options()?) {
            Ok(()) => Ok(()),
            Err(AppError::Display(reason)) => self.draw(&reason),
            Err(AppError::Signal(signal)) => {
                app::end_by(signal);
                Err(Failure::Machine(format!("ended by signal {signal}")))
            }
            Err(AppError::Graphics(reason)) => Err(render::no_graphics(&reason)),
            Err(error) => Err(Failure::Machine(error.to_string())),
        }
    }
}

/// Is there anything to open a window on? Only asked where the environment says so; elsewhere there always is.
fn has_display() -> bool {
    let set = |name| env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(not(all(unix, not(target_os = "macos"))))
        || ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(set)
}

impl Arguments {
    fn options(&self) -> Result<Options, Failure> {
        let built_in = Source::BuiltIn;
        let edits = self.edits.as_deref().map(super::edit::read_edits).transpose()?.unwrap_or_default();
        Ok(Options {
            source: self.files.first().map_or(built_in, |file| source(file)),
            passed_over: self.files.len().saturating_sub(1),
            lose_device_every: self.lose_device,
            never_pause: self.never_pause,
            settings_folder: self.settings.clone(),
            autosave_folder: self.autosave.clone(),
            edits: edits.into_iter().map(|(_, edit)| edit).collect(),
            fail_at: self.fail_at,
            mistake: self.fail,
        })
    }

    /// The main job without a window: a picture of the model in the current folder, and where to get more.
    fn draw(&self, why: &str) -> Result<(), Failure> {
        tell(format_args!("no display to open a window on ({why}); drawing a picture instead"));
        let built_in = PathBuf::from(super::choice::BUILT_IN);
        let file = self.files.first().unwrap_or(&built_in);
        let source = source(file);
        let loaded = load(&source)?;
        let view = render::View { size: Size { width: 1280, height: 720 }, ..render::View::default() };
        let (title, take) = (loaded.title.clone(), loaded.model.animation.takes.first().cloned());
        // A third into the take something is on its way in most of them.
        let time = take.as_ref().map_or(0.0, |take| take.start + take.length / 3.0);
        let picture = render::draw(loaded, take.is_some().then_some(0), time, &view)?;
        let path = output::write_new(Path::new("."), &stem(&source), "png", &picture)?;
        let path = path.strip_prefix(".").unwrap_or(&path);
        output::print(|out| {
            writeln!(out, "{}", path.display())?;
            let take = take.map_or_else(String::new, |take| format!(", take {}, {time:.2} s", take.name));
            writeln!(out, "  a picture of {title}{take}, {} × {} pixels", view.size.width, view.size.height)?;
            writeln!(out, "More without a display:")?;
            writeln!(out, "  dragonfly render --help   other files, takes, times, views and sizes")?;
            writeln!(out, "  dragonfly info, pose      what is in a file, exact numbers")?;
            writeln!(
                out,
                "The editor itself opens in any desktop session, X11 or Wayland; over ssh, with `ssh -X`."
            )
        })
    }
}

/// What a picture of `source` is called.
fn stem(source: &Source) -> String {
    match source {
        Source::BuiltIn => "dragonfly".to_owned(),
        Source::File(path) => {
            path.file_stem().map_or_else(|| "model".to_owned(), |stem| stem.to_string_lossy().into_owned())
        }
    }
}
