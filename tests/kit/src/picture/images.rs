//! Settings for images drawn by tests, and the comparison of two images.

use dragonfly_picture::PictureSettings;
use image::RgbaImage;

/// Returns settings for a small image, because a software adapter may draw it.
pub fn settings() -> PictureSettings {
    PictureSettings { size: [160, 120], yaw: 0.0, pitch: 0.1, ..PictureSettings::default() }
}

/// Returns the number of pixels that differ.
pub fn difference(a: &RgbaImage, b: &RgbaImage) -> usize {
    a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count()
}
