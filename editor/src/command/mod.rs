//! The command line: a new command is a file here, with a type of arguments that implements [`RunCommand`], and a line in the
//! list `subcommands!`.
//!
//! Results go to stdout, messages and progress to stderr. Exit codes: 0 done, 1 the check or comparison found
//! something, 2 wrong input, 3 system error.

mod check;
mod choice;
mod command_list;
mod convert;
mod demo;
mod diff;
mod diff_picture;
mod edit;
mod explain;
mod failure;
mod farm;
mod import_options;
mod info;
mod info_figure;
mod log;
mod movie;
mod open;
mod output;
mod pack;
mod pose;
mod progress;
mod quiet;
mod render;
mod retarget;
mod run_command;
mod scene;
mod stdio;
mod table;
mod take_lint;
mod takes;
mod time_argument;

pub use failure::{Failure, tell};

use crate::app::Options;
use clap::Parser;
use dragonfly_fbx::child;
use run_command::RunCommand;
use std::ffi::OsString;
use std::panic::{self, AssertUnwindSafe};
use std::process::ExitCode;

/// Declares [`Commands`] from a list of `Name => module::Type` lines; the name in lower case is the subcommand.
macro_rules! subcommands {
    ($($Name:ident => $Arguments:ty,)*) => {
        /// All subcommands; without one, the editor opens.
        #[derive(Debug, clap::Subcommand)]
        enum Commands {
            $($Name($Arguments),)*
        }

        impl RunCommand for Commands {
            fn run(self) -> Result<(), Failure> {
                match self { $(Self::$Name(arguments) => arguments.run(),)* }
            }
        }
    };
}

subcommands! {
    Info => info::InfoArguments,
    Check => check::CheckArguments,
    Diff => diff::DiffArguments,
    Pose => pose::PoseArguments,
    Explain => explain::ExplainArguments,
    Render => render::RenderArguments,
    Movie => movie::MovieArguments,
    Script => scene::ScriptArguments,
    Edit => edit::EditArguments,
    Retarget => retarget::RetargetArguments,
    Convert => convert::ConvertArguments,
    Takes => takes::TakesArguments,
    Pack => pack::PackArguments,
    Unpack => pack::UnpackArguments,
    Demo => demo::DemoArguments,
}

const HELP: &str = "\
Examples:
  dragonfly                         open the editor with the built-in dragonfly
  dragonfly Fox.glb                 open a model in the editor
  dragonfly info Fox.glb            list the contents of a file
  dragonfly check Fox.glb           find errors and suspicious data in a file
  dragonfly diff Fox.glb Fox2.glb   compare the takes of two files
  dragonfly render demo: -o fly.png --take cruise --time 0.4
                                    render an image without a window
  dragonfly movie duel.meproj -o duel.mp4
                                    render a movie without a window; --resume goes on after an interruption
  dragonfly pose Fox.glb --time 0.5 --json
                                    print exact poses for other programs
  dragonfly explain Fox.glb --time 0.5 --bone b_Head_05
                                    print every step that leads to the pose of a bone
  dragonfly script duel.xml         list when each action of a scene begins and ends
  dragonfly edit Fox.glb --edits changes.jsonl -o Fox2.glb
                                    apply edits without a window; the rest of the file is unchanged
  dragonfly retarget Walk.glb Hero.glb -o Hero2.glb
                                    put takes of one figure on another
  dragonfly convert captures -o models --to glb
                                    convert a folder of files to another format
  dragonfly takes add Hero.glb captures/*.glb -o Hero2.glb
                                    add the takes of other files to a model
  dragonfly pack duel.meproj -o duel.zip
                                    collect a project with everything that it needs
  dragonfly --commands              list the commands of the editor with their shortcuts

FILE can be `demo:` for the built-in model.
Exit codes: 0 done, 1 the check or comparison found something, 2 wrong input, 3 system error,
also when the window or its display is gone.
DRAGONFLY_LOG=info (or debug, trace) logs details to stderr.";

/// The parsed command line.
#[derive(Debug, Parser)]
#[command(
    name = "dragonfly",
    version,
    about = "Dragonfly, an editor for skeletal animation",
    after_help = HELP,
    args_conflicts_with_subcommands = true,
    disable_help_subcommand = true
)]
struct CommandLine {
    #[command(subcommand)]
    command: Option<Commands>,
    #[command(flatten)]
    open: open::OpenArguments,
}

/// Runs the program: parses the command line, carries it out, and returns the exit code.
///
/// A panic inside does not escape: it is reported, and the exit code is 3.
pub fn main() -> ExitCode {
    main_with(std::env::args_os(), Options::default())
}

/// Runs the program with these arguments, the first of which is its name; `options` are the defaults of the editor.
///
/// Started as the child that parses FBX, the process does that and nothing else.
pub fn main_with(arguments: impl IntoIterator<Item = OsString>, options: Options) -> ExitCode {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    if child::is_requested(arguments.iter().cloned()) {
        return child::serve();
    }
    log::start();
    log::quiet_panics();
    let command_line = CommandLine::parse_from(arguments);
    match panic::catch_unwind(AssertUnwindSafe(|| run(command_line, options))) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(failure)) => failure.report(),
        Err(panic) => {
            tell(format_args!(
                "internal error, a bug of the program: {}\n  Your files are whole: a file that was being saved \
                 is as it was before or as it was to become. DRAGONFLY_LOG=debug shows what led to it.",
                dragonfly_runtime::panic_text(&*panic)
            ));
            ExitCode::from(3)
        }
    }
}

fn run(command_line: CommandLine, options: Options) -> Result<(), Failure> {
    match command_line.command {
        None => command_line.open.open(options),
        Some(command) => command.run(),
    }
}
