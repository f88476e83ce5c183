//! Motion blur has the profile of a surface that moves evenly while the shutter is open.

use super::{carried, front, rectangle};
use dragonfly_anim::data::Material;
use dragonfly_kit::picture::studio;
use dragonfly_picture::{FrameSampling, PictureSettings};
use glam::Vec3;

const SIZE: [u32; 2] = [64, 12];
/// Width of the box, pixels.
const WIDTH: f32 = 10.0;
/// Way of the box while the shutter is open, pixels.
const WAY: f32 = 24.0;
/// Frames per second.
const RATE: f32 = 24.0;

/// Returns the part of the open time in which the box is at `x`, counted from its middle: a trapezoid.
fn trapezoid(x: f32) -> f32 {
    let leaves = ((x + WIDTH / 2.0) / WAY).min(0.5);
    let arrives = ((x - WIDTH / 2.0) / WAY).max(-0.5);
    (leaves - arrives).max(0.0)
}

#[test]
fn a_moving_box_is_blurred_to_a_trapezoid() {
    let Some(mut studio) = studio::studio() else { return };
    let model = carried(rectangle(WIDTH, 30.0), Material::default(), WAY * RATE);
    let middle = Vec3::X * WAY * RATE / 2.0;
    let mut row = |shutter: f32| {
        let sampling = FrameSampling { samples: 64, shutter, ..FrameSampling::default() };
        let settings = PictureSettings { time: 0.5, ..front(SIZE, middle, sampling) };
        let picture = studio.render_linear(&model, &settings).expect("an image");
        (0..SIZE[0]).map(|x| picture.get_pixel(x, 6).0[3]).collect::<Vec<f32>>()
    };
    let blurred = row(360.0);
    let mut worst = 0.0_f32;
    for (x, alpha) in (0_u8..).zip(&blurred) {
        let at = f32::from(x) + 0.5 - SIZE[0] as f32 / 2.0;
        let error = (alpha - trapezoid(at)).abs();
        worst = worst.max(error);
        assert!(error < 0.03, "{alpha} at {at}, not {}", trapezoid(at));
    }
    println!("largest error {worst:.4}");
    let sharp = row(0.0).iter().filter(|alpha| **alpha > 0.0).count();
    assert!((10..=13).contains(&sharp), "{sharp} pixels show a box of 10 that is not blurred");
}
