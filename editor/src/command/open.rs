//! `dragonfly [FILE…]`: opens the editor; without a display, renders an image instead.

use super::choice::{load, source_as};
use super::import_options::ImportArguments;
use super::{Failure, output, quiet, render, tell};
use crate::app::{self, AppError, Options};
use dragonfly_document::{Source, formats};
use std::env;
use std::path::{Path, PathBuf};

/// Returns the help text of the files to open, with the extensions of all formats.
fn models_help() -> String {
    format!("Models to open ({}); without any, the built-in dragonfly", formats().extension_list())
}

/// Arguments of the editor.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct OpenArguments {
    #[arg(value_name = "FILE", help = models_help())]
    files: Vec<PathBuf>,
    /// Run without a window: read one JSON edit or query per line from stdin, write one JSON answer per line to stdout
    #[arg(long)]
    stdio: bool,
    /// Folder for the journal of --stdio, instead of the default one; `off` records nothing
    #[arg(long, value_name = "FOLDER|off", requires = "stdio")]
    journal: Option<PathBuf>,
    /// List the commands of the editor: id, title, tooltip, keys, and condition
    #[arg(long, conflicts_with = "stdio")]
    commands: bool,
    /// Folder for settings, instead of the default one
    #[arg(long, value_name = "FOLDER")]
    settings: Option<PathBuf>,
    /// Folder for journals of unsaved work, instead of the default one
    #[arg(long, value_name = "FOLDER")]
    autosave: Option<PathBuf>,
    #[command(flatten)]
    import: ImportArguments,
}

impl OpenArguments {
    /// Opens the editor, with `base` for everything that the command line does not set.
    pub(super) fn open(self, base: Options) -> Result<(), Failure> {
        if self.commands {
            return super::command_list::print();
        }
        if self.stdio {
            return super::stdio::talk(self.files.first(), self.journal, self.autosave);
        }
        if !has_display() {
            quiet::about_wayland();
            return self.draw("DISPLAY and WAYLAND_DISPLAY are not set");
        }
        match app::run(self.options(base)) {
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

/// Returns whether a display is available: on X11 and Wayland systems if the environment names one, elsewhere always.
fn has_display() -> bool {
    let set = |name| env::var_os(name).is_some_and(|value| !value.is_empty());
    cfg!(not(all(unix, not(target_os = "macos"))))
        || ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(set)
}

impl OpenArguments {
    fn options(&self, base: Options) -> Options {
        let built_in = Source::BuiltIn;
        Options {
            source: self.files.first().map_or(built_in, |file| source_as(file, &self.import)),
            passed_over: self.files.len().saturating_sub(1),
            settings_folder: self.settings.clone(),
            autosave_folder: self.autosave.clone(),
            ..base
        }
    }

    /// Renders an image of the model into the current folder, and prints the commands that need no display.
    fn draw(&self, why: &str) -> Result<(), Failure> {
        tell(format_args!("no display to open a window on ({why}); rendering an image instead"));
        let built_in = PathBuf::from(super::choice::BUILT_IN);
        let file = self.files.first().unwrap_or(&built_in);
        let source = source_as(file, &self.import);
        let loaded = load(&source)?;
        let view = render::RenderView::default();
        let [width, height] = render::USUAL_SIZE;
        let (title, take) = (loaded.title.clone(), loaded.model.animation.takes.first().cloned());
        // Most takes show a characteristic pose at a third of their length.
        let time = take.as_ref().map_or(0.0, |take| take.start + take.length / 3.0);
        let picture = render::draw(loaded, take.is_some().then_some(0), time, &view)?;
        let path = output::write_new(Path::new("."), &stem(&source), "png", &picture)?;
        let path = path.strip_prefix(".").unwrap_or(&path);
        output::print(|out| {
            writeln!(out, "{}", path.display())?;
            let take = take.map_or_else(String::new, |take| format!(", take {}, {time:.2} s", take.name));
            writeln!(out, "  an image of {title}{take}, {width} × {height} pixels")?;
            writeln!(out, "More without a display:")?;
            writeln!(out, "  dragonfly render --help   other files, takes, times, cameras and sizes")?;
            writeln!(out, "  dragonfly info, pose      contents of a file, exact numbers")?;
            writeln!(
                out,
                "The editor itself opens in any desktop session, X11 or Wayland; over ssh, with `ssh -X`."
            )
        })
    }
}

/// Returns the file stem of an image of `source`.
fn stem(source: &Source) -> String {
    match source {
        Source::BuiltIn => "dragonfly".to_owned(),
        Source::File(path) | Source::FileAs(path, _) => {
            path.file_stem().map_or_else(|| "model".to_owned(), |stem| stem.to_string_lossy().into_owned())
        }
    }
}
