//! The origin of the frames of a movie.

use super::error::MovieRenderError;
use dragonfly_movie::MovieFrame;
use image::RgbaImage;

/// Renders the frames of a movie.
pub trait FrameSource {
    /// Renders a frame by its number. The same number always gives the same frame.
    ///
    /// # Errors
    ///
    /// The frame cannot be drawn.
    fn frame(&mut self, number: u64) -> Result<RenderedFrame, MovieRenderError>;

    /// Returns sentences about what could not be shown since the last call.
    fn take_warnings(&mut self) -> Vec<String> {
        Vec::new()
    }
}

/// A frame that was rendered.
#[derive(Clone, Debug)]
pub enum RenderedFrame {
    /// Encoded as sRGB, 8 bits, not multiplied by alpha.
    Srgb(RgbaImage),
    /// Linear light, four numbers for each pixel, multiplied by alpha.
    Linear {
        /// Width and height in pixels.
        size: [u32; 2],
        /// The pixels.
        rgba: Vec<f32>,
    },
}

impl RenderedFrame {
    /// Returns the frame for an encoder.
    pub fn movie_frame(&self) -> MovieFrame<'_> {
        match self {
            Self::Srgb(picture) => MovieFrame::srgb([picture.width(), picture.height()], picture.as_raw()),
            Self::Linear { size, rgba } => MovieFrame::linear(*size, rgba),
        }
    }
}
