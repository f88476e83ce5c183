//! `dragonfly convert IN… -o OUT|DIR`: reads files of any format and writes them in another one, whole folders at once.

mod plan;
mod report;

use super::farm::{FarmEngine, FarmJob};
use super::import_options::{ImportArguments, positive};
use super::output::print;
use super::run_command::RunCommand;
use super::{Failure, tell};
use dragonfly_anim::format::Conventions;
use dragonfly_document::{
    Cancel, ConvertedFile, checked_preset, convert, make_folder, written_extensions, written_format,
};
use dragonfly_runtime::{Job, Thread};
use plan::{PlannedFile, Shard, plan};
use report::{ConvertReport, FileOutcome};
use std::io::{self, IsTerminal, Write};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Convert files and whole folders to another format, on all processors; what a format cannot hold is listed
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = format!("\
A folder stands for all models in it and in its folders; their paths are kept below DIR. A file that cannot be converted is\n\
reported and the others are converted; the exit code is 2 then. Formats that are written: {}.\n\n\
Examples:\n  dragonfly convert Walk.bvh -o Walk.glb\n  \
dragonfly convert captures -o models --to glb --scale 0.01\n  \
dragonfly convert Hero.glb -o Hero.fbx --preset unity\n  \
dragonfly convert Hero.fbx -o Hero.bvh --bake 60\n  \
dragonfly convert Hero.glb -o curves.csv\n  \
dragonfly convert captures -o models --to glb --shard 2/8 --resume\n  \
dragonfly convert captures -o models --to glb --job openjd --parts 32 > job.json\n  \
dragonfly convert Hero.x -o Hero.glb --dry-run", written_extensions()))]
pub(super) struct ConvertArguments {
    /// Files and folders to read
    #[arg(value_name = "IN", required = true)]
    inputs: Vec<PathBuf>,
    /// File to write for one input, or the folder for several; a folder is created where it is missing
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// File name extension of the files in a folder
    #[arg(long, value_name = "EXT")]
    to: Option<String>,
    /// Program for which the files are written: unity, unreal, maya or blender, for .fbx
    #[arg(long, value_name = "PRESET")]
    preset: Option<String>,
    /// Write a key at every frame of this many frames per second, with lines between them, instead of the keys and curves
    #[arg(long, value_name = "FPS", value_parser = positive)]
    bake: Option<f32>,
    /// Convert only part I of N of the files, to share the work between machines
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Skip files whose output exists and is not older than the input
    #[arg(long)]
    resume: bool,
    /// Number of files that are converted at the same time [default: the number of processors]
    #[arg(long, value_name = "COUNT")]
    jobs: Option<NonZeroUsize>,
    /// Print a job file for a farm that converts the files in parts, instead of converting them here
    #[arg(long, value_name = "ENGINE", value_enum, conflicts_with_all = ["shard", "dry_run", "json"])]
    job: Option<FarmEngine>,
    /// Number of parts of the job
    #[arg(long, value_name = "COUNT", default_value = "16", requires = "job")]
    parts: NonZeroUsize,
    /// Print what would be lost without writing anything
    #[arg(long)]
    dry_run: bool,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    import: ImportArguments,
}

impl RunCommand for ConvertArguments {
    fn run(self) -> Result<(), Failure> {
        if let Some(extension) = &self.to
            && written_format(extension).is_none()
        {
            let known = written_extensions();
            return Err(Failure::input("--to", format_args!("{extension:?} cannot be written; use {known}")));
        }
        self.check_preset()?;
        if let Some(engine) = self.job {
            return self.print_job(engine);
        }
        let conventions = self.import.conventions();
        let files = plan(&self.inputs, &self.output, self.to.as_deref(), self.shard)?;
        let resume = self.resume;
        let preset = self.preset;
        let (bake, is_written) = (self.bake, !self.dry_run);
        let orders = Orders { files, conventions, preset, bake, is_written, resume };
        let outcomes = run(orders, self.jobs)?;
        ConvertReport::of(outcomes).print(self.json)
    }
}

impl ConvertArguments {
    /// Checks that the format that is written has the preset.
    fn check_preset(&self) -> Result<(), Failure> {
        let Some(preset) = &self.preset else { return Ok(()) };
        let of_file = || self.output.extension().and_then(|extension| extension.to_str());
        let extension = self.to.as_deref().or_else(of_file).unwrap_or_default();
        // A format that is not written is reported with the file.
        let Some(format) = written_format(extension) else { return Ok(()) };
        checked_preset(&format, preset).map(drop).map_err(|reason| Failure::input("--preset", reason))
    }

    /// Prints the job file of an engine. Parts that were converted before a task failed are skipped when it is run again.
    fn print_job(&self, engine: FarmEngine) -> Result<(), Failure> {
        let mut arguments = vec!["convert".to_owned()];
        arguments.extend(self.inputs.iter().map(|path| path.display().to_string()));
        arguments.extend(["-o".to_owned(), self.output.display().to_string()]);
        let options = [
            ("--to", self.to.clone()),
            ("--preset", self.preset.clone()),
            ("--bake", self.bake.map(|rate| rate.to_string())),
            ("--jobs", self.jobs.map(|jobs| jobs.to_string())),
        ];
        let chosen = options.into_iter().filter_map(|(name, value)| Some([name.to_owned(), value?]));
        arguments.extend(chosen.flatten());
        arguments.extend(self.import.to_arguments());
        arguments.push("--resume".to_owned());
        let job =
            FarmJob::sharded("dragonfly-convert", arguments, self.parts.get()).map_err(Failure::Input)?;
        let text = engine.text(&job).map_err(Failure::Input)?;
        print(|out| out.write_all(text.as_bytes()))
    }
}

/// The files to convert, and how.
struct Orders {
    files: Vec<PlannedFile>,
    conventions: Conventions,
    preset: Option<String>,
    bake: Option<f32>,
    is_written: bool,
    resume: bool,
}

impl Orders {
    /// Converts one file.
    fn one(&self, file: &PlannedFile, cancel: &Cancel) -> FileOutcome {
        let outcome = |result| FileOutcome { file: file.clone(), result };
        if self.resume && file.is_up_to_date() {
            return outcome(Ok(None));
        }
        if self.is_written
            && file.is_in_folder
            && let Err(reason) = make_folder(&file.output)
        {
            return outcome(Err(reason));
        }
        let preset = self.preset.clone();
        let converted = convert(&file.order(self.conventions, preset, self.bake, self.is_written), cancel);
        outcome(converted.map(Some).map_err(|error| error.to_string()))
    }
}

/// Converts all files, on all processors, and returns the outcomes in the order of the files.
fn run(orders: Orders, jobs: Option<NonZeroUsize>) -> Result<Vec<FileOutcome>, Failure> {
    let count = orders.files.len();
    let processors = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let workers = jobs.map_or_else(processors, NonZeroUsize::get).min(count);
    let machine = |error: io::Error| Failure::Machine(format!("no thread could be started: {error}"));
    let thread = Thread::start("convert").map_err(machine)?;
    let (orders, next) = (Arc::new(orders), Arc::new(AtomicUsize::new(0)));
    let (sender, receiver) = flume::unbounded();
    let mut running = Vec::with_capacity(workers);
    for _ in 0..workers {
        let (orders, next, sender) = (Arc::clone(&orders), Arc::clone(&next), sender.clone());
        let work = move |cancel: &Cancel| {
            while !cancel.is_cancelled() {
                // The counter orders no other memory access.
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(file) = orders.files.get(index) else { break };
                // The receiver is there as long as the jobs are.
                let _ = sender.send((index, orders.one(file, cancel)));
            }
        };
        running.push(Job::start_oneshot(thread.handle(), "convert file", work).map_err(machine)?);
    }
    drop(sender);
    let mut outcomes: Vec<Option<FileOutcome>> = Vec::new();
    outcomes.resize_with(count, || None);
    let mut progress = ConvertProgress::new(count);
    for (index, outcome) in receiver {
        progress.tell(&outcome);
        outcomes[index] = Some(outcome);
    }
    let missing = |(index, outcome): (usize, Option<FileOutcome>)| {
        // A job that ended early: a bug of an importer, which must not hide the other files.
        let reason = "internal error, a bug of the program".to_owned();
        outcome.unwrap_or_else(|| FileOutcome { file: orders.files[index].clone(), result: Err(reason) })
    };
    Ok(outcomes.into_iter().enumerate().map(missing).collect())
}

/// Progress of a conversion on stderr: one line that changes, and a line for each failure.
struct ConvertProgress {
    total: usize,
    done: usize,
    is_terminal: bool,
}

impl ConvertProgress {
    fn new(total: usize) -> Self {
        Self { total, done: 0, is_terminal: io::stderr().is_terminal() }
    }

    fn tell(&mut self, outcome: &FileOutcome) {
        self.done += 1;
        if let Err(reason) = &outcome.result {
            self.clear();
            tell(reason);
        }
        if self.is_terminal && self.total > 1 {
            let _ = write!(io::stderr(), "\rdragonfly: {} of {} files\x1b[K", self.done, self.total);
        }
    }

    fn clear(&self) {
        if self.is_terminal && self.total > 1 {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }
}

impl Drop for ConvertProgress {
    fn drop(&mut self) {
        self.clear();
    }
}

/// The result of a file: converted, or skipped because its output was there.
type FileResult = Result<Option<ConvertedFile>, String>;
