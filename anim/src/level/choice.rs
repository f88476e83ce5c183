//! Choice of a level of detail by its size on the screen.

use super::Lod;
use crate::bounds::Sphere;
use glam::Vec3;

/// The properties of a perspective camera that determine sizes on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screen {
    /// Position of the camera in scene space.
    pub eye: Vec3,
    /// Vertical field of view in radians, above 0 and below π.
    pub vertical_fov: f32,
    /// Height of the image in pixels.
    pub height: f32,
}

impl Screen {
    /// Returns the size in pixels of a length of 1 at a distance of 1: `height / (2 tan(fov / 2))`.
    fn focal(&self) -> f32 {
        self.height / (2.0 * libm::tanf(self.vertical_fov * 0.5))
    }
}

/// Returns the radius in pixels of the image of `sphere`, as seen in the middle of the screen.
///
/// ```text
/// focal * radius / √(distance² - radius²)
/// ```
///
/// Infinite where the camera is within the sphere or a number is not finite. This is the true outline, which is a
/// little larger than that of the circle through the center.
pub fn radius_in_pixels(screen: &Screen, sphere: &Sphere) -> f32 {
    let distance = f64::from(screen.eye.distance(sphere.center));
    let radius = f64::from(sphere.radius);
    let tangent = (distance * distance - radius * radius).sqrt();
    let pixels = (f64::from(screen.focal()) * radius / tangent) as f32;
    if tangent > 0.0 && pixels.is_finite() { pixels } else { f32::INFINITY }
}

/// Returns the largest size in pixels of a length of `error` anywhere in `sphere`.
///
/// ```text
/// focal * error / (distance - radius)
/// ```
///
/// Zero for no error; infinite where the camera is within the sphere or a number is not finite.
pub fn error_in_pixels(screen: &Screen, sphere: &Sphere, error: f32) -> f32 {
    if error == 0.0 {
        return 0.0;
    }
    let nearest = screen.eye.distance(sphere.center) - sphere.radius;
    let pixels = screen.focal() * error / nearest;
    if nearest > 0.0 && pixels.is_finite() { pixels } else { f32::INFINITY }
}

/// Returns the coarsest of `levels` whose error is at most `pixels` on the screen; the first, the finest, where none
/// is.
///
/// `sphere` is around the model in its pose ([`crate::bounds::BoneBoxes`] computes it quickly). `current` is the most
/// recent level. To prevent a model at a constant distance from switching between two levels, a coarser level than that
/// is only chosen when its error is below `pixels * (1 - hysteresis)`; `hysteresis` is 0..1, 0 for none. A sphere
/// smaller than a pixel gets the coarsest of all.
pub fn choose_level(
    levels: &[Lod],
    screen: &Screen,
    sphere: &Sphere,
    pixels: f32,
    hysteresis: f32,
    current: Option<usize>,
) -> usize {
    if radius_in_pixels(screen, sphere) < 0.5 {
        return levels.len().saturating_sub(1);
    }
    let coarsest = |limit: f32| {
        let fits = |level: &Lod| error_in_pixels(screen, sphere, level.error) <= limit;
        levels.iter().rposition(fits).unwrap_or(0)
    };
    let (now, strict) = (coarsest(pixels), coarsest(pixels * (1.0 - hysteresis.clamp(0.0, 1.0))));
    match current.filter(|&current| current < levels.len()) {
        None => now,
        Some(current) if strict > current => strict,
        Some(current) => now.min(current),
    }
}
