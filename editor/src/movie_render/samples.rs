//! Frames of several samples: pictures at times and places within a frame, of which it is the mean.

use super::error::MovieRenderError;
use super::frame_subject::FrameSubject;
use super::source::RenderedFrame;
use dragonfly_anim::stage::time::StageRate;
use dragonfly_picture::{PictureSettings, Studio};

/// The samples of each frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleSettings {
    /// Number of samples; 1 renders a frame at one time, without blur.
    pub samples: u32,
    /// Part of a frame during which the shutter is open, degrees: 360 is the whole frame.
    pub shutter: f32,
}

impl Default for SampleSettings {
    fn default() -> Self {
        Self { samples: 1, shutter: 180.0 }
    }
}

/// Renders a frame of several samples, which begins at the time of `settings`, of a movie with a rate.
pub(super) fn render_sample_frame(
    _studio: &mut Studio,
    _subject: &FrameSubject,
    _settings: &PictureSettings,
    (_sampling, _rate): (SampleSettings, StageRate),
) -> Result<RenderedFrame, MovieRenderError> {
    Err(MovieRenderError::Samples)
}
