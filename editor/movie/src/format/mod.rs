//! Formats of movies. A format is one file here and one row of [`MOVIE_FORMATS`].

mod apng;
mod exr;
mod gif;
#[cfg(feature = "h264")]
mod mp4;
mod png;
mod sequence;
mod webp;
mod y4m;

use crate::writer::MovieFormat;

/// All formats.
pub const MOVIE_FORMATS: &[MovieFormat] = &[
    #[cfg(feature = "h264")]
    mp4::MP4,
    gif::GIF,
    apng::APNG,
    webp::WEBP,
    png::PNG,
    exr::EXR,
    y4m::Y4M,
];

/// Returns the format with a name.
pub fn movie_format(name: &str) -> Option<&'static MovieFormat> {
    MOVIE_FORMATS.iter().find(|format| format.name == name)
}
