//! Pictures drawn by tests, and how two of them differ.

use dragonfly_picture::PictureSettings;
use image::RgbaImage;

/// Small, because the processor draws it.
pub fn settings() -> PictureSettings {
    PictureSettings { size: [160, 120], yaw: 0.0, pitch: 0.1, ..PictureSettings::default() }
}

/// Pixels that differ.
pub fn difference(a: &RgbaImage, b: &RgbaImage) -> usize {
    a.pixels().zip(b.pixels()).filter(|(a, b)| a != b).count()
}
