//! The content of a movie: a scene or a take, its frames, and how they look.

use super::super::Failure;
use super::super::choice::File;
use super::super::render::{USUAL_SIZE, studio, tell_warnings};
use super::super::scene;
use super::arguments::MovieArguments;
use super::rate;
use super::shot::shot_frames;
use crate::movie_render::{
    FrameSubject, MovieFrames, StudioFrames, movie_tag, scene_samples, scene_sound, take_camera,
};
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::time::StageRate;
use dragonfly_document::{Cancel, Source, content_hash};
use dragonfly_movie::{MovieFormat, MovieSound, ReadSamples};
use dragonfly_picture::{Look, PictureSettings};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The content of a movie.
pub(super) struct MovieContent {
    /// Name of the file.
    pub(super) title: String,
    pub(super) rate: StageRate,
    /// All frames.
    pub(super) frames: MovieFrames,
    source: Source,
    subject: FrameSubject,
    settings: PictureSettings,
    /// The plan with the sounds of a scene, and its folder.
    sounds: Option<(Arc<StagePlan>, PathBuf)>,
    /// The settings that are not in those of an image, as a text.
    about: String,
}

impl MovieContent {
    /// Loads the scene or model.
    pub(super) fn of(arguments: &MovieArguments) -> Result<Self, Failure> {
        let file = arguments.file()?;
        match file.scene(&arguments.take)? {
            Some(script) => Self::of_scene(arguments, script, file.source()),
            None => Self::of_take(arguments, &file),
        }
    }

    fn of_scene(arguments: &MovieArguments, path: &Path, source: Source) -> Result<Self, Failure> {
        let scene = scene::load(path, &arguments.script)?;
        tell_warnings(&scene.title, &scene.warnings);
        let rate = arguments.fps.unwrap_or(scene.plan.rate());
        let frames = match &arguments.shot {
            Some(shot) => shot_frames(&scene, shot, rate)?,
            None => MovieFrames::of_scene(scene.plan.length(), rate),
        };
        let through = arguments.camera.clone().unwrap_or_default().camera(&scene.plan)?;
        let settings = arguments.view.settings(scene.script.size());
        let settings = PictureSettings { look: Look { through, ..settings.look.clone() }, ..settings };
        let view = Arc::new(scene.view());
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        let sounds = view.plan.clone().filter(|plan| !plan.sounds().is_empty()).map(|plan| (plan, folder));
        Ok(Self {
            about: format!("{:?} {rate}", arguments.script.name()),
            title: scene.title,
            rate,
            frames,
            source,
            subject: FrameSubject::Scene(view),
            settings,
            sounds,
        })
    }

    fn of_take(arguments: &MovieArguments, file: &File) -> Result<Self, Failure> {
        if arguments.shot.is_some() || arguments.camera.is_some() || arguments.script.name().is_some() {
            let reason = "FILE has to be a scene (.xml) or a project (.meproj)";
            return Err(Failure::input("--shot, --camera, --script", reason));
        }
        let loaded = file.load()?;
        tell_warnings(&loaded.title, &loaded.warnings);
        let take = arguments.take.index(&loaded.title, &loaded.model)?.ok_or_else(|| {
            let reason = "it has no takes, so that nothing moves; `dragonfly render` renders an image of it";
            Failure::input(&loaded.title, reason)
        })?;
        let rate = arguments.fps.unwrap_or_else(|| rate::of_model(&loaded));
        let length = loaded.model.animation.takes.get(take).map_or(0.0, |take| take.length);
        let frames = MovieFrames::of_take(f64::from(length), rate);
        let settings = arguments.view.settings(USUAL_SIZE);
        let camera = take_camera(&loaded, take, frames.count(), &settings);
        let source = file.source();
        Ok(Self {
            about: format!("take {take} {rate} {:?}", source.conventions()),
            title: loaded.title.clone(),
            rate,
            frames,
            source,
            subject: FrameSubject::Take { loaded: Arc::new(loaded), take },
            settings: PictureSettings { camera: Some(camera), ..settings },
            sounds: None,
        })
    }

    /// Returns width and height in pixels.
    pub(super) fn size(&self) -> [u32; 2] {
        self.settings.size
    }

    /// Returns whether the scene plays sounds.
    pub(super) fn has_sound(&self) -> bool {
        self.sounds.is_some()
    }

    /// Returns the identity of what the movie shows in a format.
    pub(super) fn tag(&self, format: &MovieFormat, cancel: &Cancel) -> Result<String, Failure> {
        let content = content_hash(&self.source, cancel)?;
        let light = if format.is_linear { " linear" } else { "" };
        let settings = format!("{} {:?}{light}", self.about, self.settings);
        Ok(movie_tag(content, &settings))
    }

    /// Mixes the sounds of `frames`; `None` where there are none.
    pub(super) fn sound(
        &self,
        frames: &MovieFrames,
        cancel: &Cancel,
        warn: &mut dyn FnMut(&str),
    ) -> Result<Option<MovieSound>, Failure> {
        let Some((plan, folder)) = &self.sounds else { return Ok(None) };
        Ok(scene_sound(plan, folder, (frames, self.rate), cancel, warn)?)
    }

    /// Mixes the sounds of `frames` for another program; `None` where there are none.
    pub(super) fn samples(
        &self,
        frames: &MovieFrames,
        cancel: &Cancel,
        warn: &mut dyn FnMut(&str),
    ) -> Result<Option<ReadSamples>, Failure> {
        let Some((plan, folder)) = &self.sounds else { return Ok(None) };
        Ok(scene_samples(plan, folder, (frames, self.rate), cancel, warn)?)
    }

    /// Creates a studio that renders the frames for a format.
    pub(super) fn into_frames(self, format: &MovieFormat) -> Result<StudioFrames, Failure> {
        let Self { subject, settings, rate, .. } = self;
        Ok(StudioFrames::new(studio()?, subject, settings, rate).in_linear_light(format.is_linear))
    }
}
