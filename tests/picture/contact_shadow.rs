//! Parts near the ground darken it, and white surfaces keep their shape.

use dragonfly_anim::data::{Material, Metallic};
use dragonfly_document::{Cancel, LoadedModel, Source, load_model};
use dragonfly_kit::folder::data;
use dragonfly_kit::picture::images::settings;
use dragonfly_kit::picture::studio;
use dragonfly_picture::{Look, PictureSettings};
use glam::Vec4;
use std::sync::Arc;

fn open(name: &str) -> LoadedModel {
    let path = data("collection").join(name);
    load_model(&Source::File(path), &mut |_| {}, &Cancel::default()).expect("a model of the tests")
}

#[test]
fn feet_on_the_ground_darken_it_around_them_and_nothing_else() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = Arc::new(open("RobotExpressive.glb"));
    let mut draw = |contact_shadow| {
        let look = Look { contact_shadow, ..settings().look };
        let settings = PictureSettings { grid: true, look, pitch: 0.4, ..settings() };
        studio.render(&loaded, &settings).expect("an image")
    };
    let (with, without) = (draw(true), draw(false));
    let (width, height) = with.dimensions();
    let mut darker = 0;
    for (x, y, pixel) in with.enumerate_pixels() {
        let plain = without.get_pixel(x, y);
        let sum = |pixel: &image::Rgba<u8>| pixel.0[..3].iter().map(|&value| i32::from(value)).sum::<i32>();
        let change = sum(pixel) - sum(plain);
        assert!(change <= 3, "{x}, {y}: {plain:?} became brighter, {pixel:?}");
        darker += usize::from(change < -12);
        let edge = x < width / 16 || y < height / 3 || x > width - width / 16;
        assert!(!edge || change >= -3, "{x}, {y}: dark far from the feet");
    }
    let share = darker as f32 / (width * height) as f32;
    println!("{:.1} % of the image is darker", share * 100.0);
    assert!((0.005..0.25).contains(&share), "{share}");
}

#[test]
fn white_surfaces_stay_below_the_white_of_the_screen() {
    let Some(mut studio) = studio::studio() else { return };
    let mut loaded = open("quaternius_Character4skins.glb");
    let model = Arc::get_mut(&mut loaded.model).expect("not shared yet");
    let metallic = Metallic { metallic: 0.0, roughness: 0.6 };
    let white = Material { base_color: Vec4::splat(0.9).with_w(1.0), metallic, ..Material::default() };
    model.materials.fill(white);
    let settings = PictureSettings { grid: false, background: Some([0; 4]), ..settings() };
    let image = studio.render(&Arc::new(loaded), &settings).expect("an image");
    let solid: Vec<u8> = image
        .pixels()
        .filter(|pixel| pixel.0[3] == 255)
        .map(|pixel| pixel.0[..3].iter().copied().max().unwrap_or(0))
        .collect();
    let burnt = solid.iter().filter(|&&value| value >= 245).count();
    println!("{burnt} of {} pixels are nearly white", solid.len());
    assert!(solid.len() > 1000 && burnt * 100 < solid.len());
}
