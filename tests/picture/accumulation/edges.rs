//! Edges have the coverage of the pixel filter.

use super::{front, quadrilateral, still};
use dragonfly_anim::data::Material;
use dragonfly_document::LoadedModel;
use dragonfly_kit::document::made;
use dragonfly_kit::picture::studio;
use dragonfly_picture::{FILTER_RADIUS, Studio, blackman_harris};
use glam::{DVec2, Vec2, Vec3};
use image::Rgba32FImage;
use std::sync::Arc;

const SIZE: [u32; 2] = [40, 24];
/// Distance of the edge from the middle of the image, pixels.
const DISTANCE: f64 = 0.3;
/// Number of equal parts of the filter along an axis.
const PARTS: usize = 120;

/// Direction across the edge, out of the surface: nearly to the right, so that the edge crosses pixels everywhere.
fn across() -> DVec2 {
    DVec2::from_angle(1.6_f64.to_radians())
}

/// Returns a surface that fills one side of the edge.
fn half_plane() -> Arc<LoadedModel> {
    let (out, along) = (across().as_vec2(), across().perp().as_vec2());
    let (upper, lower) = (DISTANCE as f32 * out + along * 60.0, DISTANCE as f32 * out - along * 60.0);
    let corners: [Vec2; 4] = [upper - out * 60.0, lower - out * 60.0, lower, upper];
    made::loaded(made::standing(vec![quadrilateral(corners)], vec![Material::default()]), Vec::new())
}

/// Returns the part of the filter around a pixel that an edge at this distance from the pixel leaves, by integration.
fn coverage(distance: f64) -> f64 {
    if distance.abs() > 2.0 * FILTER_RADIUS {
        return if distance > 0.0 { 1.0 } else { 0.0 };
    }
    let step = 2.0 / PARTS as f64;
    let weights: Vec<f64> =
        (0..PARTS).map(|part| blackman_harris((part as f64 + 0.5) * step - 1.0)).collect();
    let whole: f64 = weights.iter().sum();
    let out = across();
    let mut sum = 0.0;
    for (part, weight) in weights.iter().enumerate() {
        let y = ((part as f64 + 0.5) * step - 1.0) * FILTER_RADIUS;
        let x = (distance - y * out.y) / out.x;
        let filled = ((x / FILTER_RADIUS + 1.0) / step).max(0.0);
        let covered =
            weights.iter().enumerate().map(|(at, weight)| weight * (filled - at as f64).clamp(0.0, 1.0));
        sum += weight * covered.sum::<f64>();
    }
    sum / (whole * whole)
}

/// Returns the largest and the mean difference of alpha from the exact coverage, where the edge is near.
fn errors(picture: &Rgba32FImage) -> (f64, f64) {
    let (mut worst, mut sum, mut count) = (0.0_f64, 0.0, 0);
    for (x, y, pixel) in picture.enumerate_pixels() {
        let [width, height] = SIZE.map(f64::from);
        let at = DVec2::new(f64::from(x) + 0.5 - width / 2.0, height / 2.0 - f64::from(y) - 0.5);
        let distance = DISTANCE - at.dot(across());
        let error = (f64::from(pixel.0[3]) - coverage(distance)).abs();
        worst = worst.max(error);
        if distance.abs() < FILTER_RADIUS {
            (sum, count) = (sum + error, count + 1);
        }
    }
    (worst, sum / f64::from(count))
}

fn draw(studio: &mut Studio, model: &Arc<LoadedModel>, samples: u32) -> Rgba32FImage {
    studio.render_linear(model, &front(SIZE, Vec3::ZERO, still(samples))).expect("an image")
}

/// Returns the largest difference of alpha between neighboring pixels.
fn steepest(picture: &Rgba32FImage) -> f32 {
    let alpha = |x, y| picture.get_pixel(x, y).0[3];
    let rows = 0..SIZE[1];
    rows.flat_map(|y| (1..SIZE[0]).map(move |x| (alpha(x, y) - alpha(x - 1, y)).abs())).fold(0.0, f32::max)
}

#[test]
fn an_edge_has_the_exact_coverage_of_the_pixel_filter() {
    let Some(mut studio) = studio::studio() else { return };
    let model = half_plane();
    let (worst, mean) = errors(&draw(&mut studio, &model, 512));
    println!("largest error {:.2}, mean error {:.2} of 255", worst * 255.0, mean * 255.0);
    assert!(worst < 2.0 / 255.0, "{}", worst * 255.0);
    let [one, sixteen] = [1, 16].map(|samples| draw(&mut studio, &model, samples));
    let [hard, smooth] = [&one, &sixteen].map(errors);
    println!("one {hard:?}, sixteen {smooth:?}");
    assert!(smooth.0 * 3.0 < hard.0 && smooth.1 * 3.0 < hard.1, "{hard:?}, {smooth:?}");
    assert!(steepest(&sixteen) < 0.9 * steepest(&one));
    assert_eq!(studio.stage().device().errors(), 0);
}

#[test]
fn the_developed_image_has_the_same_alpha_and_no_fringe() {
    let Some(mut studio) = studio::studio() else { return };
    let model = half_plane();
    let light = draw(&mut studio, &model, 16);
    let picture = studio.render(&model, &front(SIZE, Vec3::ZERO, still(16))).expect("an image");
    let mut edge = 0;
    for (light, pixel) in light.pixels().zip(picture.pixels()) {
        let alpha = light.0[3] * 255.0;
        assert!((alpha - f32::from(pixel.0[3])).abs() <= 0.6, "{light:?} {pixel:?}");
        // A white surface is white up to its edge, where only alpha differs.
        let white = pixel.0[3] == 0 || pixel.0[..3] == [255; 3];
        assert!(white, "{pixel:?}");
        edge += usize::from((1..255).contains(&pixel.0[3]));
    }
    assert!(edge > 30, "{edge} pixels of the edge");
}
