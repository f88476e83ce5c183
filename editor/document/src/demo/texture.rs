//! The textures: how painted points become images.

use super::chart::{
    ABDOMEN, COXA, Chart, DARK, EYE, EYES, FEMUR, HEAD, SKIN, SOCKET, TARSUS, THORAX, TIBIA, WINGS,
};
use super::paint::Paint;
use super::{paint, veins};
use glam::Vec3;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

/// An encoded image and its media type.
pub(super) struct Picture {
    pub(super) name: &'static str,
    pub(super) mime: &'static str,
    pub(super) bytes: Vec<u8>,
}

/// Every picture of the model: skin color, normals and surface, eye color and normals, wings.
pub(super) fn pictures() -> [Picture; 7] {
    let skin = skin();
    let eyes = eyes();
    let (w, h) = (WINGS.0 as u32, WINGS.1 as u32);
    let wings = veins::paint(w as usize, h as usize);
    [
        jpeg("body_colour", &colors(&skin), SKIN, 84),
        jpeg("body_normal", &normals(&skin, SKIN), SKIN, 74),
        jpeg("body_surface", &halved(&skin, SKIN, gloss), half(SKIN), 82),
        jpeg("eye_colour", &halved(&eyes, EYES, |p| p.color), half(EYES), 90),
        png("eye_normal", &normals(&eyes, EYES), EYES, ExtendedColorType::Rgb8),
        png("eye_surface", &glosses(&eyes), EYES, ExtendedColorType::Rgb8),
        png("wing_colour", &wings, WINGS, ExtendedColorType::Rgba8),
    ]
}

/// A painter: the paint at a place of its chart, 0..1 each way.
type Painter = fn(f32, f32) -> Paint;

fn skin() -> Vec<Paint> {
    let parts: [(Chart, Painter); 9] = [
        (ABDOMEN, paint::abdomen),
        (THORAX, paint::thorax),
        (HEAD, paint::head),
        (FEMUR, paint::femur),
        (TIBIA, paint::tibia),
        (TARSUS, paint::tarsus),
        (COXA, paint::coxa),
        (SOCKET, paint::socket),
        (DARK, paint::dark),
    ];
    let mut image = vec![paint::dark(0.5, 0.5); (SKIN.0 * SKIN.1) as usize];
    for (chart, painter) in parts {
        fill(&mut image, chart, painter);
    }
    image
}

fn eyes() -> Vec<Paint> {
    let mut image = vec![paint::dark(0.5, 0.5); (EYES.0 * EYES.1) as usize];
    fill(&mut image, EYE, paint::eye);
    image
}

fn fill(image: &mut [Paint], chart: Chart, painter: Painter) {
    let width = chart.size.0 as usize;
    for y in 0..chart.h as usize {
        for x in 0..chart.w as usize {
            let at = |i: usize, n: f32| ((i as f32 + 0.5 - 2.0) / (n - 4.0)).clamp(0.0, 1.0);
            let row = chart.y as usize + y;
            image[row * width + chart.x as usize + x] = painter(at(x, chart.w), at(y, chart.h));
        }
    }
}

fn byte(x: f32) -> u8 {
    (x.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

fn colors(image: &[Paint]) -> Vec<u8> {
    image.iter().flat_map(|p| p.color.to_array().map(byte)).collect()
}

/// Tangent-space normals of the painted heights: red along U, green up the image.
fn normals(image: &[Paint], size: (f32, f32)) -> Vec<u8> {
    let (w, h) = (size.0 as usize, size.1 as usize);
    let height = |x: usize, y: usize| image[y * w + x].height;
    let mut bytes = Vec::with_capacity(w * h * 3);
    for y in 0..h {
        for x in 0..w {
            let du = height((x + 1).min(w - 1), y) - height(x.saturating_sub(1), y);
            let dv = height(x, (y + 1).min(h - 1)) - height(x, y.saturating_sub(1));
            let n = Vec3::new(-du * 0.5, dv * 0.5, 1.0).normalize();
            bytes.extend(n.to_array().map(|c| byte(c * 0.5 + 0.5)));
        }
    }
    bytes
}

/// Openness in red, roughness in green, metal in blue.
fn gloss(p: &Paint) -> Vec3 {
    Vec3::new(p.openness, p.roughness, p.metallic)
}

fn glosses(image: &[Paint]) -> Vec<u8> {
    image.iter().flat_map(|p| gloss(p).to_array().map(byte)).collect()
}

fn half(size: (f32, f32)) -> (f32, f32) {
    (size.0 / 2.0, size.1 / 2.0)
}

/// Returns the values that `pick` selects from each texel, at half the size.
fn halved(image: &[Paint], size: (f32, f32), pick: fn(&Paint) -> Vec3) -> Vec<u8> {
    let (w, h) = (size.0 as usize, size.1 as usize);
    let mut bytes = Vec::with_capacity(w * h * 3 / 4);
    for y in (0..h).step_by(2) {
        for x in (0..w).step_by(2) {
            let corner = y * w + x;
            let sum: Vec3 =
                [corner, corner + 1, corner + w, corner + w + 1].into_iter().map(|i| pick(&image[i])).sum();
            bytes.extend((sum * 0.25).to_array().map(byte));
        }
    }
    bytes
}

fn jpeg(name: &'static str, rgb: &[u8], size: (f32, f32), quality: u8) -> Picture {
    let mut bytes = Vec::new();
    JpegEncoder::new_with_quality(&mut bytes, quality)
        .write_image(rgb, size.0 as u32, size.1 as u32, ExtendedColorType::Rgb8)
        .expect("the buffer is as long as its size says and memory takes every byte");
    Picture { name, mime: "image/jpeg", bytes }
}

fn png(name: &'static str, data: &[u8], size: (f32, f32), kind: ExtendedColorType) -> Picture {
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(
        &mut bytes,
        CompressionType::Best,
        if kind == ExtendedColorType::Rgba8 { FilterType::NoFilter } else { FilterType::Adaptive },
    )
    .write_image(data, size.0 as u32, size.1 as u32, kind)
    .expect("the buffer is as long as its size says and memory takes every byte");
    Picture { name, mime: "image/png", bytes }
}
