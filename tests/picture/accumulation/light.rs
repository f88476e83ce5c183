//! Sub-frames are added as light, and tone-mapped once.

use super::{carried, front, rectangle, still};
use dragonfly_anim::data::Material;
use dragonfly_kit::document::{arm, made};
use dragonfly_kit::picture::images::settings;
use dragonfly_kit::picture::studio;
use dragonfly_picture::{FrameSampling, Look, PictureSettings, Studio};
use glam::{Vec3, Vec4};

/// Part of the light of a surface that reaches the image.
const EXPOSURE: f32 = 0.76;

/// Returns a material that shines and reflects almost nothing.
fn shining(strength: f32) -> Material {
    let black = Vec4::new(0.0, 0.0, 0.0, 1.0);
    Material { base_color: black, emissive: Vec3::splat(strength), ..Material::default() }
}

#[test]
fn light_above_white_is_kept_until_the_image_is_developed() {
    let Some(mut studio) = studio::studio() else { return };
    let model = made::loaded(made::standing(vec![rectangle(100.0, 100.0)], vec![shining(4.0)]), Vec::new());
    let settings = PictureSettings { look: Look::default(), ..front([16, 16], Vec3::ZERO, still(2)) };
    let light = studio.render_linear(&model, &settings).expect("an image").get_pixel(8, 8).0;
    // A sub-frame has eleven bits of each number.
    assert!(light[0] > 3.99 * EXPOSURE && light[0] < 5.0 * EXPOSURE, "{light:?}");
    assert_eq!(light[3], 1.0);
    let [red, _, _, alpha] = studio.render(&model, &settings).expect("an image").get_pixel(8, 8).0;
    assert!((250..255).contains(&red) && alpha == 255, "{red}: bright, and not clipped");
}

#[test]
fn the_trace_of_a_moving_highlight_is_bright() {
    let Some(mut studio) = studio::studio() else { return };
    let (way, rate) = (24.0, 24.0);
    let model = carried(rectangle(2.0, 30.0), shining(10.0), way * rate);
    let sampling = FrameSampling { samples: 32, shutter: 360.0, ..FrameSampling::default() };
    let settings = PictureSettings {
        time: 0.5,
        background: Some([0, 0, 0, 255]),
        look: Look::default(),
        ..front([40, 8], Vec3::X * way * rate / 2.0, sampling)
    };
    let picture = studio.render(&model, &settings).expect("an image");
    // A twelfth of a light of 7.6 is a light of 0.6. A twelfth of white would be 79 of 255.
    for x in 12..28 {
        let value = picture.get_pixel(x, 4).0[0];
        assert!((160..230).contains(&value), "{value} at {x}");
    }
}

/// Returns an image of the arm with its pane of glass over the gradient and the grid.
fn arm_of(studio: &mut Studio, samples: u32) -> image::RgbaImage {
    let settings = PictureSettings { sampling: still(samples), ..settings() };
    studio.render(&arm::loaded(), &settings).expect("an image")
}

#[test]
fn a_frame_of_many_sub_frames_looks_like_one_of_one() {
    let Some(mut studio) = studio::studio() else { return };
    let [one, eight] = [1, 8].map(|samples| arm_of(&mut studio, samples));
    let off = |a: &image::Rgba<u8>, b: &image::Rgba<u8>| (0..4).map(|at| a[at].abs_diff(b[at])).max();
    let off: Vec<u8> = one.pixels().zip(eight.pixels()).filter_map(|(a, b)| off(a, b)).collect();
    let near = off.iter().filter(|off| **off <= 8).count();
    let mean = off.iter().map(|&off| f64::from(off)).sum::<f64>() / off.len() as f64;
    println!("{near} of {} pixels are alike, mean difference {mean:.2}", off.len());
    assert!(near * 100 > off.len() * 90 && mean < 4.0, "{near} of {}, {mean:.2}", off.len());
    assert_eq!(studio.stage().device().errors(), 0);
}
