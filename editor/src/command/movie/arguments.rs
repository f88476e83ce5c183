//! The arguments of `dragonfly movie`.

use super::super::Failure;
use super::super::choice::{File, TakeChoice};
use super::super::farm::FarmEngine;
use super::super::import_options::ImportArguments;
use super::super::render::RenderView;
use super::super::scene::{ScriptChoice, ShotChoice};
use super::frames_argument::FramesArgument;
use super::printer::ProgressChoice;
use super::rate;
use dragonfly_anim::stage::time::StageRate;
use dragonfly_movie::{GROUP, MOVIE_FORMATS};
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
pub(in crate::command) struct MovieArguments {
    /// A scene (.xml), a project (.meproj), a model, or `demo:` for the built-in dragonfly
    #[arg(value_name = "FILE", required_unless_present = "join")]
    pub(super) file: Option<PathBuf>,
    #[command(flatten)]
    pub(super) take: TakeChoice,
    #[command(flatten)]
    pub(super) script: ScriptChoice,
    /// Only a shot of a scene: its id, or its number from 0 in the order of time
    #[arg(long, value_name = "ID")]
    pub(super) shot: Option<String>,
    /// Camera of a scene: its id, or `shot` for the one that is shot, or `free` for --yaw and --pitch [default: shot]
    #[arg(long, value_name = "ID", conflicts_with = "shot")]
    pub(super) camera: Option<ShotChoice>,
    /// Frames: 0-239 with both ends, 0-239x2 for every second one; 48+48 for 48 frames from frame 48 on, as a part for --join, which may be given in addition to
    /// a range [default: all]
    #[arg(long, value_name = "A-B|A+N")]
    pub(super) frames: Vec<FramesArgument>,
    /// Frames per second, such as 24, 29.97 or 30000/1001 [default: those of the scene or file, or 24]
    #[arg(long, value_name = "FPS", value_parser = rate::parse)]
    pub(super) fps: Option<StageRate>,
    /// Format [default: by the extension of the output; y4m for standard output]
    #[arg(long, value_name = "FORMAT", value_parser = clap::builder::PossibleValuesParser::new(MOVIE_FORMATS.iter().map(|format| format.name)))]
    pub(super) format: Option<String>,
    /// Coarseness of an MP4: 10 is best, 24 good, 27 small, 45 worst
    #[arg(long, value_name = "QP", default_value = "24", value_parser = clap::value_parser!(u8).range(10..=45))]
    pub(super) quality: u8,
    /// Encode with the command ffmpeg: `ffmpeg -f yuv4mpegpipe -i - [SOUND] ARGS OUT`
    #[arg(long, value_name = "ARGS", allow_hyphen_values = true, conflicts_with_all = ["format", "resume", "job", "join"])]
    pub(super) external_ffmpeg: Option<String>,
    /// Keep parts and frames that are complete and show the same, and render the others
    #[arg(long)]
    pub(super) resume: bool,
    /// Progress on standard error: text, or a JSON line for each frame
    #[arg(long, value_name = "KIND", value_enum, default_value = "text")]
    pub(super) progress: ProgressChoice,
    /// Join parts of an MP4, or all of a folder, instead of rendering; with FILE the sound is added
    #[arg(long, value_name = "PART", num_args = 1.., conflicts_with_all = ["job", "format"])]
    pub(super) join: Vec<PathBuf>,
    /// Write a job file for a farm that renders the movie in parts, instead of rendering it here
    #[arg(long, value_name = "ENGINE", value_enum)]
    pub(super) job: Option<FarmEngine>,
    /// Number of frames of each part of the job; of an MP4 a multiple of 48
    #[arg(long, value_name = "COUNT", default_value_t = default_chunk(), requires = "job")]
    pub(super) chunk: NonZeroU64,
    /// Movie that the job renders [default: the name of FILE with .mp4]
    #[arg(long, value_name = "out.mp4", requires = "job")]
    pub(super) movie: Option<PathBuf>,
    /// File to write; with #### in its name, a file for each frame of PNG and EXR (linear light before the tone map); `-` is standard output
    #[arg(short, long, value_name = "out.mp4")]
    pub(super) output: PathBuf,
    #[command(flatten)]
    pub(super) view: RenderView,
    #[command(flatten)]
    pub(super) import: ImportArguments,
}

impl MovieArguments {
    /// Returns the file.
    ///
    /// # Errors
    ///
    /// There is none.
    pub(super) fn file(&self) -> Result<File, Failure> {
        let path = self.file.clone().ok_or_else(|| Failure::input("FILE", "is missing"))?;
        Ok(File::new(path, self.import.clone()))
    }
}

fn default_chunk() -> NonZeroU64 {
    NonZeroU64::MIN.saturating_add(GROUP - 1)
}
