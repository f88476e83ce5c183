//! An adapter without multisampling draws the same image with hard edges.

use crate::surfaces::texture;
use dragonfly_anim::data::{AlphaMode, Material, TextureTransform};
use dragonfly_document::DecodedImage;
use dragonfly_kit::document::{arm, made};
use dragonfly_kit::picture::images::settings;
use dragonfly_kit::picture::studio;
use dragonfly_picture::gpu::{SAMPLES, samples};
use dragonfly_picture::{DeviceParameters, PictureSettings};
use glam::Vec4;
use image::RgbaImage;
use wgpu::TextureFormatFeatureFlags as Flags;

/// Parameters under which every adapter draws one sample per pixel.
fn hard() -> DeviceParameters {
    DeviceParameters { most_samples: 1, ..DeviceParameters::default() }
}

#[test]
fn the_scene_has_fewer_samples_where_a_format_does_not_support_four() {
    let four = Flags::MULTISAMPLE_X4 | Flags::MULTISAMPLE_RESOLVE;
    assert_eq!(samples([four, four], SAMPLES), SAMPLES);
    for lacking in [[Flags::empty(), four], [four, Flags::empty()], [Flags::MULTISAMPLE_X8, four]] {
        assert_eq!(samples(lacking, SAMPLES), 1, "{lacking:?}");
    }
    assert_eq!(samples([four, four], 1), 1);
}

/// Returns how many pixels differ by more than a blended edge, and how many differ at all.
fn differences(a: &RgbaImage, b: &RgbaImage) -> (usize, usize) {
    let off =
        a.pixels().zip(b.pixels()).map(|(a, b)| (0..4).map(|at| a[at].abs_diff(b[at])).max().unwrap_or(0));
    off.fold((0, 0), |(far, any), off| (far + usize::from(off > 140), any + usize::from(off > 0)))
}

#[test]
fn one_sample_per_pixel_draws_the_same_image_with_hard_edges() {
    let Some(mut smooth) = studio::studio() else { return };
    let Some(mut hard) = studio::studio_with(hard()) else { return };
    assert!(smooth.is_smooth() && !hard.is_smooth());
    let settings = PictureSettings { skeleton: true, ..settings() };
    let loaded = arm::loaded();
    let draw = |studio: &mut dragonfly_picture::Studio| studio.render(&loaded, &settings).unwrap();
    let (a, b) = (draw(&mut smooth), draw(&mut hard));
    let (far, any) = differences(&a, &b);
    assert!(any > 0, "edges must differ");
    let pixels = (a.width() * a.height()) as usize;
    assert!(far * 200 < pixels, "{far} of {pixels} pixels differ widely");
    // The device is lost and created again with the same number of samples.
    hard.stage().device().lose();
    assert!(draw(&mut hard) == b);
    assert_eq!(hard.stage().device().errors(), 0);
}

#[test]
fn a_mask_discards_pixels_also_with_one_sample() {
    let Some(mut studio) = studio::studio_with(hard()) else { return };
    let texels = [[255, 0, 0, 255], [0, 255, 0, 0], [0, 0, 255, 100], [255, 255, 255, 160_u8]];
    let image = DecodedImage { width: 2, height: 2, pixels: texels.concat() };
    let texture = texture(TextureTransform::IDENTITY);
    let alpha_mode = AlphaMode::Mask(0.5);
    let material =
        Material { base_color_texture: Some(texture), unlit: true, alpha_mode, ..Material::default() };
    let yellow = Material { base_color: Vec4::new(1.0, 1.0, 0.0, 1.0), unlit: true, ..Material::default() };
    let mut behind = made::sheet();
    behind.material = Some(1);
    behind.vertices.positions.iter_mut().for_each(|position| position.z = -0.01);
    let model = made::standing(vec![made::sheet(), behind], vec![material, yellow]);
    let loaded = made::loaded(model, vec![image]);
    let settings = PictureSettings { pitch: 0.0, grid: false, background: Some([0; 4]), ..settings() };
    let picture = studio.render(&loaded, &settings).unwrap();
    let count = |color: [u8; 4]| picture.pixels().filter(|pixel| pixel.0 == color).count();
    let colors = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255; 4], [255, 255, 0, 255]];
    let [red, green, blue, white, yellow] = colors.map(count);
    assert!(red > 200 && white > 200, "{red} red, {white} white");
    assert_eq!((green, blue), (0, 0), "what is below the threshold");
    assert!(yellow > 400, "{yellow} of the surface behind the holes");
    let drawn = red + white + yellow;
    assert_eq!(drawn + count([0; 4]), picture.pixels().len(), "a pixel is covered or not");
}
