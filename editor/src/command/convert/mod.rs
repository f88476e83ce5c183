//! `dragonfly convert IN… -o OUT|DIR`: reads files of any format and writes them in another one, whole folders at once.

mod pipeline;
mod plan;
mod progress;
mod report;
mod texture_choice;

use super::Failure;
use super::farm::{FarmEngine, FarmJob};
use super::import_options::{ImportArguments, positive};
use super::output::print;
use super::run_command::RunCommand;
use dragonfly_document::{
    BoneMap, ConversionOrder, checked_preset, checked_textures, written_extensions, written_format,
};
use pipeline::{Orders, run};
use plan::{Shard, plan};
use report::ConvertReport;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;
pub(super) use texture_choice::TextureChoice;

/// Convert files and whole folders to another format, on all processors; what a format cannot hold is listed
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = format!("\
A folder stands for all models in it and in its folders; their paths are kept below DIR. A file that cannot be converted is\n\
reported and the others are converted; the exit code is 2 then. Formats that are written: {}.\n\n\
Examples:\n  dragonfly convert Walk.bvh -o Walk.glb\n  \
dragonfly convert captures -o models --to glb --scale 0.01\n  \
dragonfly convert Hero.glb -o Hero.fbx --preset unity --textures beside\n  \
dragonfly convert Hero.fbx -o Hero.bvh --bake 60\n  \
dragonfly convert Hero.glb -o curves.csv\n  \
dragonfly convert Walk.bvh -o Walk.fbx --map unreal.json\n  \
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
    /// Place of the images, for .fbx: in the file, or in files next to it, whose names begin with its own [default: embedded]
    #[arg(long, value_name = "PLACE", value_enum)]
    textures: Option<TextureChoice>,
    /// Give bones other names, as in a map of bones: the first name of each pair becomes the second
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Write a key at every frame of this many frames per second, with lines between them, instead of the keys and curves; for .obj, a
    /// file for each frame of the first take
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
        self.check_choices()?;
        if let Some(engine) = self.job {
            return self.print_job(engine);
        }
        let files = plan(&self.inputs, &self.output, self.to.as_deref(), self.shard)?;
        let renames = self.map.as_deref().map(BoneMap::read).transpose().map_err(Failure::Input)?;
        let choices = ConversionOrder {
            conventions: self.import.conventions(),
            renames: renames.map(Arc::new),
            preset: self.preset,
            textures: self.textures.map(TextureChoice::placement),
            bake: self.bake,
            is_written: !self.dry_run,
            input: PathBuf::new(),
            output: PathBuf::new(),
        };
        let outcomes = run(Orders { files, choices, resume: self.resume }, self.jobs)?;
        ConvertReport::of(outcomes).print(self.json)
    }
}

impl ConvertArguments {
    /// Checks that the format that is written has the preset, and leaves the choice of textures.
    fn check_choices(&self) -> Result<(), Failure> {
        let of_file = || self.output.extension().and_then(|extension| extension.to_str());
        let extension = self.to.as_deref().or_else(of_file).unwrap_or_default();
        // A format that is not written is reported with the file.
        let Some(format) = written_format(extension) else { return Ok(()) };
        if let Some(preset) = &self.preset {
            checked_preset(&format, preset).map_err(|reason| Failure::input("--preset", reason))?;
        }
        if let Some(textures) = self.textures {
            checked_textures(&format, textures.placement())
                .map_err(|reason| Failure::input("--textures", reason))?;
        }
        Ok(())
    }

    /// Prints the job file of an engine. Parts that were converted before a task failed are skipped when it is run again.
    fn print_job(&self, engine: FarmEngine) -> Result<(), Failure> {
        let mut arguments = vec!["convert".to_owned()];
        arguments.extend(self.inputs.iter().map(|path| path.display().to_string()));
        arguments.extend(["-o".to_owned(), self.output.display().to_string()]);
        let options = [
            ("--to", self.to.clone()),
            ("--preset", self.preset.clone()),
            ("--textures", self.textures.map(|textures| textures.placement().name().to_owned())),
            ("--map", self.map.as_ref().map(|path| path.display().to_string())),
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
