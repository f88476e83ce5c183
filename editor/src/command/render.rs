//! `dragonfly render FILE -o out.png`: renders images without a window.

use super::choice::{Color, File, Size, TakeChoice, clamp_time, finite};
use super::run_command::RunCommand;
use super::scene::{self, FrameRange, ScriptChoice, ShotChoice};
use super::time_argument::TimeArgument;
use super::{Failure, output, quiet, tell};
use dragonfly_document::LoadedModel;
use dragonfly_picture::{FrameSampling, GraphicsError, MOST_SAMPLES, PictureSettings, Studio};
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::Arc;

/// Render an image of a model or a scene, without a window or a display
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = "\
Examples:\n  dragonfly render demo: -o dragonfly.png\n  \
dragonfly render Fox.glb --take Run --time 0.35 --yaw 60 --pitch 10 --size 1920x1080 -o run.png\n  \
dragonfly render Fox.glb --skeleton --background 00000000 -o - | display\n  \
dragonfly render duel.xml --time 2.5 --camera close -o duel.png\n  \
dragonfly render duel.xml --frames 0..47 -o frames/duel.png\n  \
dragonfly render duel.xml --frames 0..47 --samples 16 --shutter 180 -o frames/duel.png")]
pub(super) struct RenderArguments {
    #[command(flatten)]
    file: File,
    #[command(flatten)]
    take: TakeChoice,
    /// Time in seconds, clamped to the take; of a scene exactly as its script writes times, such as 36f [default: the start]
    #[arg(long, value_name = "S", allow_hyphen_values = true)]
    time: Option<TimeArgument>,
    /// Frames of a scene, the first and the last, in place of a time; `-o out.png` writes out-0000.png and so on
    #[arg(long, value_name = "A..B", conflicts_with = "time")]
    frames: Option<FrameRange>,
    /// Camera of a scene: its id, or `shot` for the one that is shot, or `free` for --yaw and --pitch [default: shot]
    #[arg(long, value_name = "ID")]
    camera: Option<ShotChoice>,
    #[command(flatten)]
    script: ScriptChoice,
    /// PNG file to write; `-` is standard output
    #[arg(short, long, value_name = "out.png")]
    output: PathBuf,
    #[command(flatten)]
    view: RenderView,
}

/// Camera, size and background of the image.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct RenderView {
    /// Width and height in pixels [default: 1280x720, or the size in the script of a scene]
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// Camera angle around the model, degrees; 0 is its front, 90 its left side
    #[arg(long, value_name = "DEG", value_parser = finite, default_value = "35", allow_negative_numbers = true)]
    pub yaw: f32,
    /// Camera angle above the horizon, degrees; 90 looks straight down
    #[arg(long, value_name = "DEG", value_parser = finite, default_value = "15", allow_negative_numbers = true)]
    pub pitch: f32,
    /// Draw the bones in front of the model
    #[arg(long)]
    pub skeleton: bool,
    /// Background color with opacity; 00000000 is transparent [default: the editor's]
    #[arg(long, value_name = "RRGGBBAA")]
    pub background: Option<Color>,
    /// Number of images of which each frame is the mean, for smooth edges, motion blur and depth of field; 16 is good, 64 is final
    #[arg(long, value_name = "N", value_parser = samples(), default_value = "1")]
    pub samples: u32,
    /// Shutter angle of the motion blur of several samples, degrees from 0 to 360; 0 is none
    #[arg(long, value_name = "DEG", value_parser = shutter, default_value = "180")]
    pub shutter: f32,
}

/// Returns the parser of `--samples`.
fn samples() -> clap::builder::RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(1..=i64::from(MOST_SAMPLES))
}

/// Reads the angle of a shutter.
fn shutter(text: &str) -> Result<f32, String> {
    let angle = finite(text)?;
    if (0.0..=360.0).contains(&angle) { Ok(angle) } else { Err("must be from 0 to 360".to_owned()) }
}

impl Default for RenderView {
    fn default() -> Self {
        let FrameSampling { samples, shutter, .. } = FrameSampling::default();
        Self { size: None, yaw: 35.0, pitch: 15.0, skeleton: false, background: None, samples, shutter }
    }
}

impl RenderView {
    /// Returns width and height in pixels, `otherwise` where the user chose none.
    pub(super) fn size_or(&self, otherwise: [u32; 2]) -> [u32; 2] {
        self.size.map_or(otherwise, |size| [size.width, size.height])
    }

    /// Returns the options that differ from the defaults, as they are written on a command line.
    pub(super) fn to_arguments(&self) -> Vec<String> {
        let usual = Self::default();
        let angle = |angle: f32, usual: f32| (angle != usual).then(|| angle.to_string());
        let hex = |color: Color| color.0.iter().map(|value| format!("{value:02x}")).collect::<String>();
        let options = [
            ("--size", self.size.map(|size| format!("{}x{}", size.width, size.height))),
            ("--yaw", angle(self.yaw, usual.yaw)),
            ("--pitch", angle(self.pitch, usual.pitch)),
            ("--background", self.background.map(hex)),
            ("--samples", (self.samples != usual.samples).then(|| self.samples.to_string())),
            ("--shutter", angle(self.shutter, usual.shutter)),
        ];
        let chosen = options.into_iter().filter_map(|(name, value)| Some([name.to_owned(), value?]));
        let skeleton = self.skeleton.then(|| "--skeleton".to_owned());
        chosen.flatten().chain(skeleton).collect()
    }

    /// Returns the settings of an image.
    pub(super) fn settings(&self, otherwise: [u32; 2]) -> PictureSettings {
        PictureSettings {
            size: self.size_or(otherwise),
            yaw: self.yaw.to_radians(),
            pitch: self.pitch.to_radians(),
            background: self.background.map(|color| color.0),
            skeleton: self.skeleton,
            // The ground grid would cover half of a model on a transparent background.
            grid: self.background.is_none(),
            sampling: FrameSampling {
                samples: self.samples,
                shutter: self.shutter,
                ..FrameSampling::default()
            },
            ..PictureSettings::default()
        }
    }
}

/// Size of an image where the user chose none, pixels.
pub(super) const USUAL_SIZE: [u32; 2] = [1280, 720];

impl RunCommand for RenderArguments {
    fn run(self) -> Result<(), Failure> {
        quiet::about_wayland();
        if let Some(script) = self.file.scene(&self.take)? {
            let order = scene::RenderOrder {
                time: self.time.as_ref(),
                frames: self.frames,
                camera: self.camera.unwrap_or_default(),
                script: &self.script,
                output: &self.output,
                view: &self.view,
            };
            return scene::render(script, &order);
        }
        if self.frames.is_some() || self.camera.is_some() || self.script.name().is_some() {
            return Err(Failure::input(
                "--frames, --camera, --script",
                "FILE has to be a scene (.xml) or a project (.meproj)",
            ));
        }
        let loaded = self.file.load()?;
        tell_warnings(&loaded.title, &loaded.warnings);
        let take = self.take.index(&loaded.title, &loaded.model)?;
        let time = self.time.as_ref().map_or(Ok(f32::MIN), TimeArgument::of_take)?;
        let time = clamp_time(&loaded.model, take, time);
        let picture = draw(loaded, take, time, &self.view)?;
        output::write_file(&self.output, &picture)?;
        if self.output != *"-" {
            tell(format_args!("wrote {}", self.output.display()));
        }
        Ok(())
    }
}

/// Renders `loaded` at `time` seconds of take number `take`. Returns the bytes of a PNG file.
pub(super) fn draw(
    loaded: LoadedModel,
    take: Option<usize>,
    time: f32,
    view: &RenderView,
) -> Result<Vec<u8>, Failure> {
    let settings = PictureSettings { take, time, ..view.settings(USUAL_SIZE) };
    let mut studio = studio()?;
    let loaded = Arc::new(loaded);
    let picture = studio.render(&loaded, &settings).map_err(refusal)?;
    tell_warnings(&loaded.title, &studio.take_warnings());
    png(&picture)
}

/// Creates a studio. Tells the user if it cannot draw smooth edges.
pub(super) fn studio() -> Result<Studio, Failure> {
    let mut studio = Studio::new().map_err(refusal)?;
    if !studio.is_smooth() {
        let adapter = studio.stage().device().adapter_name();
        tell(format_args!("{adapter} has no multisampling: edges are not smooth"));
    }
    Ok(studio)
}

/// Returns the bytes of a PNG file.
pub(super) fn png(picture: &image::RgbaImage) -> Result<Vec<u8>, Failure> {
    let mut png = Vec::new();
    picture
        .write_to(&mut Cursor::new(&mut png), image::ImageFormat::Png)
        .map_err(|error| Failure::Machine(format!("the image cannot be encoded: {error}")))?;
    Ok(png)
}

pub(super) fn tell_warnings(title: &str, warnings: &[String]) {
    for warning in warnings {
        tell(format_args!("{title}: warning: {}", super::choice::plain(warning)));
    }
}

/// Returns the failure for an error of the graphics.
pub(super) fn refusal(error: GraphicsError) -> Failure {
    match error {
        GraphicsError::PictureSize { .. } => Failure::input("--size", error),
        other => no_graphics(&other.to_string()),
    }
}

/// Returns the failure of a system without graphics, with advice for the user.
pub(super) fn no_graphics(reason: &str) -> Failure {
    let driver = "a Vulkan driver (Debian: mesa-vulkan-drivers)";
    let install = if reason.contains("driver") { String::new() } else { format!("; is there {driver}?") };
    Failure::Machine(format!("{reason}{install}; `dragonfly info` and `dragonfly pose` need no graphics"))
}
