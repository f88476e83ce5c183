//! The reference picture: locked to the camera or on a plane, covered by the model.

use dragonfly_document::{Cancel, DecodedImage, LoadedModel, Source, load_model};
use dragonfly_kit::folder::data;
use dragonfly_kit::picture::images::difference;
use dragonfly_kit::picture::studio;
use dragonfly_picture::{PictureSettings, ReferenceAppearance, ReferencePicture, ReferencePlace};
use image::RgbaImage;
use std::sync::Arc;

/// A picture of two halves: red at the left, green at the right.
fn halves(width: u32, height: u32) -> ReferencePicture {
    let pixel = |x: u32| if x < width / 2 { [255u8, 0, 0, 255] } else { [0, 255, 0, 255] };
    let pixels = (0..height).flat_map(|_| (0..width).flat_map(pixel)).collect();
    ReferencePicture(Arc::new(DecodedImage { width, height, pixels }))
}

fn is_red(picture: &RgbaImage, x: u32, y: u32) -> bool {
    let [red, green, blue, _] = picture.get_pixel(x, y).0;
    red > 240 && green < 15 && blue < 15
}

fn is_green(picture: &RgbaImage, x: u32, y: u32) -> bool {
    let [red, green, blue, _] = picture.get_pixel(x, y).0;
    green > 240 && red < 15 && blue < 15
}

#[test]
fn a_reference_is_behind_the_model_and_keeps_its_colors() {
    let Some(mut studio) = studio::studio() else { return };
    let source = Source::File(data("gltf/Fox.glb"));
    let loaded: Arc<LoadedModel> = Arc::new(load_model(&source, &mut |_| {}, &Cancel::default()).unwrap());
    let settings = PictureSettings { size: [240, 160], grid: false, yaw: 1.1, ..PictureSettings::default() };
    let mut shown = |appearance: ReferenceAppearance| {
        studio.stage().scene.appearances.set(appearance);
        studio.render(&loaded, &settings).unwrap()
    };
    let none = shown(ReferenceAppearance::default());
    let camera = |scale: f32, offset: [f32; 2]| ReferencePlace::Camera { scale, offset };
    // As wide as the picture: it fits exactly.
    let full =
        ReferenceAppearance { picture: Some(halves(48, 32)), place: camera(1.0, [0.0; 2]), opacity: 1.0 };
    let whole = shown(full.clone());
    assert!(
        is_red(&whole, 4, 4)
            && is_red(&whole, 110, 4)
            && is_green(&whole, 130, 4)
            && is_green(&whole, 235, 155)
    );
    // The model is in front of it.
    let plain =
        whole.pixels().filter(|pixel| pixel.0[2] < 15 && (pixel.0[0] > 240) != (pixel.0[1] > 240)).count();
    assert!((20_000..38_000).contains(&plain), "{plain} of {} pixels are of the reference", 240 * 160);
    // Half its size, moved to the upper right: a quarter of the viewport.
    let quarter = shown(ReferenceAppearance { place: camera(0.5, [0.25, 0.25]), ..full.clone() });
    assert!(is_red(&quarter, 125, 4) && is_green(&quarter, 235, 4));
    assert_eq!(quarter.get_pixel(60, 40), none.get_pixel(60, 40));
    assert_eq!(quarter.get_pixel(235, 120), none.get_pixel(235, 120));
    // With half the opacity, the background is visible through it.
    let faint = shown(ReferenceAppearance { opacity: 0.5, ..full.clone() });
    let [red, ..] = faint.get_pixel(4, 4).0;
    assert!((160..225).contains(&red), "half of the light is {red}, sRGB-encoded");
    assert_eq!(difference(&shown(ReferenceAppearance { opacity: 0.0, ..full }), &none), 0);
    // A high picture fits with its height.
    let high =
        ReferenceAppearance { picture: Some(halves(20, 40)), place: camera(1.0, [0.0; 2]), opacity: 1.0 };
    let high = shown(high);
    assert!(is_red(&high, 85, 4) && is_green(&high, 155, 4));
    assert_eq!(high.get_pixel(70, 4), none.get_pixel(70, 4));
}

#[test]
fn a_reference_on_a_plane_is_seen_from_both_sides_and_moves_with_the_scene() {
    let Some(mut studio) = studio::studio() else { return };
    let source = Source::File(data("gltf/Fox.glb"));
    let loaded = Arc::new(load_model(&source, &mut |_| {}, &Cancel::default()).unwrap());
    let mut shown = |yaw: f32| {
        let place =
            ReferencePlace::Plane { center: [0.0, 60.0, -100.0], right: [1.0, 0.0, 0.0], height: 2000.0 };
        let appearance = ReferenceAppearance { picture: Some(halves(64, 64)), place, opacity: 1.0 };
        studio.stage().scene.appearances.set(appearance);
        let settings =
            PictureSettings { size: [240, 160], yaw, pitch: 0.0, grid: false, ..PictureSettings::default() };
        studio.render(&loaded, &settings).unwrap()
    };
    let front = shown(0.0);
    assert!(is_red(&front, 10, 20) && is_green(&front, 230, 20), "from the front");
    let back = shown(std::f32::consts::PI);
    assert!(is_green(&back, 10, 20) && is_red(&back, 230, 20), "mirrored from the back");
}
