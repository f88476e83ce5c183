//! Frames that the studio of the picture crate renders.

use super::error::MovieRenderError;
use super::frame_subject::FrameSubject;
use super::source::{FrameSource, RenderedFrame};
use dragonfly_anim::stage::time::StageRate;
use dragonfly_picture::{FrameSampling, PictureSettings, Studio, between};

/// Renders the frames of a scene or a take, with a device of its own.
pub struct StudioFrames {
    studio: Studio,
    subject: FrameSubject,
    /// The settings of every frame; only the time changes.
    settings: PictureSettings,
    rate: StageRate,
    is_linear: bool,
}

impl StudioFrames {
    /// Creates a source of frames at `rate`; the times of `settings` are ignored. For a take, `settings` has the camera.
    pub fn new(studio: Studio, subject: FrameSubject, settings: PictureSettings, rate: StageRate) -> Self {
        let sampling = FrameSampling { rate, ..settings.sampling };
        Self { studio, subject, settings: PictureSettings { sampling, ..settings }, rate, is_linear: false }
    }

    /// Returns the source with frames in linear light before the tone map, or not.
    pub fn in_linear_light(self, is_linear: bool) -> Self {
        Self { is_linear, ..self }
    }

    /// Sets the time of frame `number`.
    fn seek(&mut self, number: u64) {
        let time = self.rate.frame(i64::try_from(number).unwrap_or(i64::MAX));
        match &self.subject {
            FrameSubject::Scene(_) => self.settings.moment = Some(time),
            FrameSubject::Take { loaded, take } => {
                self.settings.take = Some(*take);
                if let Some(take) = loaded.model.animation.takes.get(*take) {
                    let seconds = (f64::from(take.start) + time.seconds()) as f32;
                    self.settings.time = between(seconds, take.start, take.end());
                }
            }
        }
    }
}

impl FrameSource for StudioFrames {
    fn frame(&mut self, number: u64) -> Result<RenderedFrame, MovieRenderError> {
        self.seek(number);
        let Self { studio, subject, settings, rate: _, is_linear } = self;
        if *is_linear {
            let light = match subject {
                FrameSubject::Scene(view) => studio.render_scene_linear(view, settings)?,
                FrameSubject::Take { loaded, .. } => studio.render_linear(loaded, settings)?,
            };
            return Ok(RenderedFrame::Linear { size: light.dimensions().into(), rgba: light.into_raw() });
        }
        let picture = match subject {
            FrameSubject::Scene(view) => studio.render_scene(view, settings)?,
            FrameSubject::Take { loaded, .. } => studio.render(loaded, settings)?,
        };
        Ok(RenderedFrame::Srgb(picture))
    }

    fn take_warnings(&mut self) -> Vec<String> {
        self.studio.take_warnings()
    }
}
