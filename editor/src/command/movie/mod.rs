//! `dragonfly movie FILE -o out.mp4`: renders a scene or a take to a movie, without a window; in parts, on farms, and joined.

mod content;
mod failure;
mod ffmpeg;
mod frames_argument;
mod interrupt;
mod job;
mod join;
mod output_choice;
mod printer;
mod rate;
mod run;
mod shot;
mod words;

use super::choice::{File, TakeChoice, finite};
use super::farm::FarmEngine;
use super::import_options::ImportArguments;
use super::render::RenderView;
use super::run_command::RunCommand;
use super::scene::{ScriptChoice, ShotChoice};
use super::{Failure, quiet};
use crate::movie_render::SampleSettings;
use dragonfly_anim::stage::time::StageRate;
use dragonfly_movie::{GROUP, MOVIE_FORMATS};
use frames_argument::FramesArgument;
use printer::ProgressChoice;
use std::num::NonZeroU64;
use std::path::PathBuf;

/// Render a movie of a scene or of a take, without a window or a display; resumed after an interruption, and in parts on several machines
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = "\
Frame k is at exactly k divided by the frames per second; the first one is frame 0. The sounds of a scene are part of an MP4.\n\n\
Examples:\n  dragonfly movie duel.meproj -o duel.mp4\n  \
dragonfly movie Fox.glb --take Run --fps 30 --size 1280x720 -o run.gif\n  \
dragonfly movie duel.xml --shot 1 --samples 16 -o frames/close.####.exr\n  \
dragonfly movie duel.meproj -o duel.mp4 --resume --progress json\n  \
dragonfly movie duel.meproj --external-ffmpeg \"-c:v libsvtav1 -crf 30\" -o duel.mkv\n  \
dragonfly movie duel.meproj -o - | ffplay -\n  \
dragonfly movie duel.meproj --frames 48+48 -o parts/48.mp4\n  \
dragonfly movie duel.meproj --join parts/*.mp4 -o duel.mp4\n  \
dragonfly movie duel.meproj --job openjd --chunk 96 -o job.yaml")]
pub(super) struct MovieArguments {
    /// A scene (.xml), a project (.meproj), a model, or `demo:` for the built-in dragonfly
    #[arg(value_name = "FILE", required_unless_present = "join")]
    file: Option<PathBuf>,
    #[command(flatten)]
    take: TakeChoice,
    #[command(flatten)]
    script: ScriptChoice,
    /// Only a shot of a scene: its id, or its number from 0 in the order of time
    #[arg(long, value_name = "ID")]
    shot: Option<String>,
    /// Camera of a scene: its id, or `shot` for the one that is shot, or `free` for --yaw and --pitch [default: shot]
    #[arg(long, value_name = "ID", conflicts_with = "shot")]
    camera: Option<ShotChoice>,
    /// Frames: 0-239 with both ends, 0-239x2 for every second one; 48+48 for 48 frames from frame 48 on, as a part for --join, which may be given in addition to
    /// a range [default: all]
    #[arg(long, value_name = "A-B|A+N")]
    frames: Vec<FramesArgument>,
    /// Frames per second, such as 24, 29.97 or 30000/1001 [default: those of the scene or file, or 24]
    #[arg(long, value_name = "FPS", value_parser = rate::parse)]
    fps: Option<StageRate>,
    /// Number of samples of each frame, which smooth edges and blur what moves
    #[arg(long, value_name = "COUNT", default_value = "1", value_parser = clap::value_parser!(u32).range(1..=4096))]
    samples: u32,
    /// Part of a frame during which several samples are spread, degrees: 360 is the whole frame
    #[arg(long, value_name = "DEG", default_value = "180", value_parser = shutter)]
    shutter: f32,
    /// Format [default: by the extension of the output; y4m for standard output]
    #[arg(long, value_name = "FORMAT", value_parser = clap::builder::PossibleValuesParser::new(MOVIE_FORMATS.iter().map(|format| format.name)))]
    format: Option<String>,
    /// Coarseness of an MP4: 10 is best, 24 good, 27 small, 45 worst
    #[arg(long, value_name = "QP", default_value = "24", value_parser = clap::value_parser!(u8).range(10..=45))]
    quality: u8,
    /// Encode with the command ffmpeg: `ffmpeg -f yuv4mpegpipe -i - ARGS OUT`
    #[arg(long, value_name = "ARGS", allow_hyphen_values = true, conflicts_with_all = ["format", "resume", "job", "join"])]
    external_ffmpeg: Option<String>,
    /// Keep parts and frames that are complete and show the same, and render the others
    #[arg(long)]
    resume: bool,
    /// Progress on standard error: text, or a JSON line for each frame
    #[arg(long, value_name = "KIND", value_enum, default_value = "text")]
    progress: ProgressChoice,
    /// Join parts of an MP4, or all of a folder, instead of rendering; with FILE the sound is added
    #[arg(long, value_name = "PART", num_args = 1.., conflicts_with_all = ["job", "format"])]
    join: Vec<PathBuf>,
    /// Write a job file for a farm that renders the movie in parts, instead of rendering it here
    #[arg(long, value_name = "ENGINE", value_enum)]
    job: Option<FarmEngine>,
    /// Number of frames of each part of the job; of an MP4 a multiple of 48
    #[arg(long, value_name = "COUNT", default_value_t = default_chunk(), requires = "job")]
    chunk: NonZeroU64,
    /// Movie that the job renders [default: the name of FILE with .mp4]
    #[arg(long, value_name = "out.mp4", requires = "job")]
    movie: Option<PathBuf>,
    /// File to write; with #### in its name, a file for each frame of PNG and EXR; `-` is standard output
    #[arg(short, long, value_name = "out.mp4")]
    output: PathBuf,
    #[command(flatten)]
    view: RenderView,
    #[command(flatten)]
    import: ImportArguments,
}

impl RunCommand for MovieArguments {
    fn run(self) -> Result<(), Failure> {
        quiet::about_wayland();
        if !self.join.is_empty() {
            return join::join(&self);
        }
        match self.job {
            Some(engine) => job::write(&self, engine),
            None => run::run(&self),
        }
    }
}

impl MovieArguments {
    /// Returns the file.
    fn file(&self) -> Result<File, Failure> {
        let path = self.file.clone().ok_or_else(|| Failure::input("FILE", "is missing"))?;
        Ok(File::new(path, self.import.clone()))
    }

    fn sampling(&self) -> SampleSettings {
        SampleSettings { samples: self.samples, shutter: self.shutter }
    }
}

fn default_chunk() -> NonZeroU64 {
    NonZeroU64::MIN.saturating_add(GROUP - 1)
}

/// Parses the angle of a shutter.
fn shutter(text: &str) -> Result<f32, String> {
    match finite(text)? {
        angle if (0.0..=360.0).contains(&angle) => Ok(angle),
        _ => Err("must be from 0 to 360 degrees".to_owned()),
    }
}
