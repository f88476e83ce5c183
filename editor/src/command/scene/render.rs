//! Images of a scene: `dragonfly render SCENE.xml --time S --camera ID`.

use super::ScriptChoice;
use crate::command::render::{RenderView, png, refusal, studio, tell_warnings};
use crate::command::time_argument::TimeArgument;
use crate::command::{Failure, output, tell};
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_picture::{FrameSampling, Look, PictureSettings, ThroughCamera};
use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;

/// Largest number of frames of one command.
const MOST_FRAMES: u32 = 100_000;

/// The first and the last frame of a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::command) struct FrameRange {
    first: u32,
    last: u32,
}

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let usage = || "is no range of frames; write for example 0..47".to_owned();
        let (first, last) = text.split_once("..").ok_or_else(usage)?;
        let number = |text: &str| text.trim().parse::<u32>().map_err(|_| usage());
        let (first, last) = (number(first)?, number(last)?);
        if last < first {
            return Err("ends before it begins".to_owned());
        }
        if last - first >= MOST_FRAMES {
            return Err(format!("has more than {MOST_FRAMES} frames"));
        }
        Ok(Self { first, last })
    }
}

/// The camera of an image.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::command) struct ShotChoice(Option<Box<str>>);

impl FromStr for ShotChoice {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(Self(Some(text.into())))
    }
}

impl ShotChoice {
    /// Returns what was written; `None` where nothing was.
    pub(in crate::command) fn written(&self) -> Option<&str> {
        self.0.as_deref()
    }

    /// Returns the camera of `plan` that is meant.
    pub(in crate::command) fn camera(&self, plan: &StagePlan) -> Result<ThroughCamera, Failure> {
        match self.0.as_deref() {
            None | Some("shot") => Ok(ThroughCamera::Shot),
            Some("free") => Ok(ThroughCamera::Free),
            Some(id) => {
                let cameras = || plan.things().iter().filter(|thing| thing.kind == "camera");
                if cameras().any(|camera| &*camera.id == id) {
                    return Ok(ThroughCamera::Of(id.into()));
                }
                let names: Vec<&str> = cameras().map(|camera| &*camera.id).collect();
                let reason =
                    format!("no camera is called \"{id}\"; there is shot, free, {}", names.join(", "));
                Err(Failure::input("--camera", reason.trim_end_matches(", ")))
            }
        }
    }
}

/// An order to render images of a scene.
pub(in crate::command) struct RenderOrder<'a> {
    /// The time; the start of the scene without one.
    pub(in crate::command) time: Option<&'a TimeArgument>,
    /// Frames in place of the time.
    pub(in crate::command) frames: Option<FrameRange>,
    pub(in crate::command) camera: ShotChoice,
    pub(in crate::command) script: &'a ScriptChoice,
    pub(in crate::command) output: &'a Path,
    pub(in crate::command) view: &'a RenderView,
}

/// Renders images of the scene of a script.
pub(in crate::command) fn render(script: &Path, order: &RenderOrder<'_>) -> Result<(), Failure> {
    let scene = super::load(script, order.script)?;
    let through = order.camera.camera(&scene.plan)?;
    let view = Arc::new(scene.view());
    let settings = order.view.settings(scene.script.size());
    let look = Look { through, ..settings.look.clone() };
    let sampling = FrameSampling { rate: scene.plan.rate(), ..settings.sampling };
    let settings = PictureSettings { look, sampling, ..settings };
    if order.frames.is_some() && order.output == Path::new("-") {
        return Err(Failure::input("--frames", "several images cannot be written to standard output"));
    }
    let rate = scene.plan.rate();
    let time = order.time.map_or(StageTime::ZERO, |time| time.of_scene(rate));
    let shots: Vec<(StageTime, PathBuf)> = match order.frames {
        None => vec![(time, order.output.to_path_buf())],
        Some(FrameRange { first, last }) => (first..=last)
            .map(|frame| (rate.frame(i64::from(frame)), numbered(order.output, frame)))
            .collect(),
    };
    let mut studio = studio()?;
    for (time, path) in &shots {
        let picture = studio
            .render_scene(&view, &PictureSettings { moment: Some(*time), ..settings.clone() })
            .map_err(refusal)?;
        tell_warnings(&scene.title, &studio.take_warnings());
        output::write_file(path, &png(&picture)?)?;
        if *path != *"-" {
            tell(format_args!("wrote {}", path.display()));
        }
    }
    Ok(())
}

/// Returns the path of an image of a frame: `out.png` becomes `out-0012.png`.
fn numbered(path: &Path, frame: u32) -> PathBuf {
    let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, extension) = (part(path.file_stem()), part(path.extension()));
    let dot = if extension.is_empty() { "" } else { "." };
    path.with_file_name(format!("{stem}-{frame:04}{dot}{extension}"))
}
