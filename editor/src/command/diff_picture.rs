//! The picture of a comparison: both models at the time of their largest difference, and the difference over time below them.

use super::Failure;
use super::render::{no_graphics, refusal};
use dragonfly_anim::compare::DifferenceProfile;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_document::LoadedModel;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::{PictureSettings, Studio};
use glam::{Vec2, Vec3};
use image::{ImageFormat, Rgba, RgbaImage};
use std::io::Cursor;
use std::sync::Arc;

/// Size of each half, height of the strip below, and distance between the parts, pixels.
const HALF: [u32; 2] = [800, 720];
const STRIP: u32 = 96;
const GAP: u32 = 4;
/// Radius of the dot at a joint that does not differ, and of the one that differs most, pixels.
const DOT: [f32; 2] = [3.0, 9.0];

/// A model with one of its takes.
pub(super) struct PicturedTake {
    pub(super) loaded: Arc<LoadedModel>,
    pub(super) take: usize,
}

impl PicturedTake {
    fn evaluator(&self, time: f32) -> Evaluator {
        let mut evaluator = Evaluator::new(Arc::clone(&self.loaded.model));
        evaluator.pose(Some(self.take), time);
        evaluator
    }
}

/// Returns the bytes of a PNG file: both models at `time` seconds from one camera, the joints with dots that are larger and redder the
/// further they are from those of the other model, and bars for the difference at each time.
pub(super) fn draw(
    sides: &[PicturedTake; 2],
    profile: &DifferenceProfile,
    time: f32,
) -> Result<Vec<u8>, Failure> {
    let [width, height] = HALF;
    let posed = sides.each_ref().map(|side| side.evaluator(time));
    let mut camera = Camera { yaw: 35_f32.to_radians(), pitch: 15_f32.to_radians(), ..Camera::default() };
    let outline: Vec<Vec3> = posed.iter().flat_map(Evaluator::outline).collect();
    camera.frame_points(&outline, width as f32 / height as f32);
    camera.dolly(1.12);
    let joints = posed.each_ref().map(joints);
    let most = profile.distances.iter().copied().fold(0.0, f32::max).max(f32::MIN_POSITIVE);
    let mut studio = Studio::new().map_err(refusal)?;
    let mut picture = RgbaImage::from_pixel(2 * width + GAP, height + GAP + STRIP, Rgba([24, 26, 28, 255]));
    for (at, side) in sides.iter().enumerate() {
        let settings = PictureSettings {
            size: HALF,
            take: Some(side.take),
            time,
            camera: Some(camera),
            skeleton: true,
            ..PictureSettings::default()
        };
        let half = studio.render(&side.loaded, &settings).map_err(refusal)?;
        let left = at as u32 * (width + GAP);
        image::imageops::replace(&mut picture, &half, left.into(), 0);
        for pair in &profile.bones {
            let bones = [pair.first as usize, pair.second as usize];
            let places = [0, 1].map(|side| joints[side].get(bones[side]).copied());
            let [Some(one), Some(other)] = places else { continue };
            let part = (one.distance(other) / most).clamp(0.0, 1.0);
            if let Some(pixel) = pixel(&camera, [one, other][at]) {
                let radius = DOT[0] + (DOT[1] - DOT[0]) * part;
                dot(&mut picture, pixel, radius, heat(part), [left, left + width]);
            }
        }
    }
    bars(&mut picture, profile, time);
    let mut png = Vec::new();
    let written = picture.write_to(&mut Cursor::new(&mut png), ImageFormat::Png);
    written.map_err(|error| no_graphics(&format!("the picture cannot be encoded: {error}")))?;
    Ok(png)
}

fn joints(posed: &Evaluator) -> Vec<Vec3> {
    posed.to_root().iter().map(|matrix| matrix.w_axis.truncate()).collect()
}

/// Returns the pixel at which a point is in a half; `None` for a point that the camera cannot see or whose numbers are too large.
fn pixel(camera: &Camera, point: Vec3) -> Option<Vec2> {
    let [width, height] = HALF.map(|side| side as f32);
    let seen = camera.view_from_world().transform_point3(point);
    let units = camera.units_per_pixel(height) * (-seen.z / camera.distance).max(0.0);
    let pixel = Vec2::new(width / 2.0 + seen.x / units, height / 2.0 - seen.y / units);
    (units > 0.0 && pixel.is_finite() && pixel.abs().max_element() < 1e5).then_some(pixel)
}

/// Draws a filled dot between two columns of the picture.
fn dot(picture: &mut RgbaImage, at: Vec2, radius: f32, color: Rgba<u8>, columns: [u32; 2]) {
    let at = at + Vec2::new(columns[0] as f32, 0.0);
    let reach = radius.ceil() as i64;
    for y in -reach..=reach {
        for x in -reach..=reach {
            let (column, row) = (at.x.round() as i64 + x, at.y.round() as i64 + y);
            let inside = (columns[0].into()..columns[1].into()).contains(&column)
                && (0..i64::from(HALF[1])).contains(&row)
                && ((x * x + y * y) as f32) <= radius * radius;
            if inside {
                picture.put_pixel(column as u32, row as u32, color);
            }
        }
    }
}

/// Draws a bar for each time below the halves, and a white line at the time of the picture.
fn bars(picture: &mut RgbaImage, profile: &DifferenceProfile, time: f32) {
    let (width, top) = (picture.width(), HALF[1] + GAP);
    let parts = profile.parts();
    let count = parts.len().max(1) as u32;
    for column in 0..width {
        let at = (u64::from(column) * u64::from(count) / u64::from(width)) as usize;
        let part = parts.clone().nth(at).unwrap_or(0.0);
        let tall = ((STRIP - 1) as f32 * part).round() as u32 + 1;
        for row in STRIP - tall..STRIP {
            picture.put_pixel(column, top + row, heat(part));
        }
    }
    let [start, end] = [profile.times.first(), profile.times.last()].map(|time| time.copied().unwrap_or(0.0));
    let part = if end > start { (time - start) / (end - start) } else { 0.0 };
    let column = ((width - 1) as f32 * part.clamp(0.0, 1.0)).round() as u32;
    for row in 0..STRIP {
        picture.put_pixel(column, top + row, Rgba([255; 4]));
    }
}

/// Returns the color of a part of the largest difference: from green over yellow to red.
fn heat(part: f32) -> Rgba<u8> {
    let [low, high] = if part < 0.5 {
        [[70.0, 160.0, 110.0], [235.0, 190.0, 70.0]]
    } else {
        [[235.0, 190.0, 70.0], [225.0, 70.0, 60.0]]
    };
    let part = if part < 0.5 { part * 2.0 } else { part * 2.0 - 1.0 };
    let mixed = [0, 1, 2].map(|at: usize| (low[at] + (high[at] - low[at]) * part) as u8);
    Rgba([mixed[0], mixed[1], mixed[2], 255])
}
