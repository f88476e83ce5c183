//! Images are decoded on the way to the device: those that a material uses, one at a time, as large as there is memory for
//! them.

use crate::surfaces::texture;
use dragonfly_anim::data::{Image, Material, ModelData, TextureTransform};
use dragonfly_document::images::ImageSurvey;
use dragonfly_document::{Cancel, DecodedImage, LoadedModel};
use dragonfly_kit::counting::peak;
use dragonfly_kit::document::made;
use dragonfly_kit::picture::images::{difference, settings};
use dragonfly_kit::picture::studio;
use std::sync::Arc;
use std::time::Instant;

/// Returns an image of `side` by `side` pixels of one color.
pub(crate) fn plain(side: u32, color: [u8; 4]) -> DecodedImage {
    DecodedImage { width: side, height: side, pixels: color.repeat((side * side) as usize) }
}

/// Returns a sheet for each image, next to each other, with that image; the others have no use.
pub(crate) fn sheets(used: usize, images: Vec<DecodedImage>) -> Arc<LoadedModel> {
    let material = |image: usize| {
        let texture =
            dragonfly_anim::data::TextureRef { image: image as u32, ..texture(TextureTransform::IDENTITY) };
        Material { base_color_texture: Some(texture), unlit: true, ..Material::default() }
    };
    let sheet = |number: usize| {
        let mut sheet = made::sheet();
        sheet.vertices.positions.iter_mut().for_each(|position| position.x += 2.0 * number as f32);
        sheet.material = Some(number as u32);
        sheet
    };
    made::loaded(made::standing((0..used).map(sheet).collect(), (0..used).map(material).collect()), images)
}

/// Returns `loaded` with changed images and `memory` bytes for them.
fn changed(loaded: &Arc<LoadedModel>, memory: u64, change: impl FnOnce(&mut [Image])) -> Arc<LoadedModel> {
    let mut model = ModelData::clone(&loaded.model);
    change(&mut model.images);
    let (images, warnings) = ImageSurvey::new(&model.images, memory, &Cancel::default());
    assert_eq!(warnings, [""; 0]);
    let (title, bounds) = (loaded.title.clone(), loaded.bounds);
    Arc::new(LoadedModel {
        conversion: Default::default(),
        title,
        path: None,
        format: None,
        model: Arc::new(model),
        bounds,
        images,
        warnings,
        notes: Vec::new(),
    })
}

/// Returns `loaded` with the last bytes of image number `index` cut off.
pub(crate) fn damaged(loaded: &Arc<LoadedModel>, index: usize) -> Arc<LoadedModel> {
    changed(loaded, u64::MAX, |images| {
        let bytes = &images[index].bytes;
        images[index].bytes = bytes[..bytes.len() - 30].into();
    })
}

const RED: [u8; 4] = [255, 0, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];

#[test]
fn an_image_that_no_material_uses_is_not_decoded() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = sheets(1, vec![plain(64, RED), plain(64, BLUE)]);
    studio.render(&damaged(&loaded, 1), &settings()).unwrap();
    assert_eq!(studio.take_warnings(), [""; 0]);
}

#[test]
fn a_damaged_image_causes_one_warning_also_if_the_device_is_lost_and_the_others_are_shown() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = damaged(&sheets(2, vec![plain(64, RED), plain(64, BLUE)]), 0);
    let picture = studio.render(&loaded, &settings()).unwrap();
    let warnings = studio.take_warnings();
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].starts_with("image 0 is not shown: "), "{}", warnings[0]);
    assert!(picture.pixels().any(|pixel| pixel.0 == BLUE) && !picture.pixels().any(|pixel| pixel.0 == RED));
    studio.stage().device().lose();
    let again = studio.render(&loaded, &settings()).unwrap();
    assert_eq!((difference(&picture, &again), studio.take_warnings().len()), (0, 0));
}

#[test]
fn the_images_of_a_model_are_decoded_one_at_a_time() {
    let Some(mut studio) = studio::studio() else { return };
    let image = |shade: u8| plain(1_024, [shade, 0, 0, 255]);
    let loaded = sheets(12, (0..12).map(image).collect());
    let (memory, picture) = peak(|| studio.render(&loaded, &settings()));
    picture.unwrap();
    // One decoded image, one with the device, and what the picture itself needs.
    println!("{memory}");
    assert!(memory < 20 << 20, "{memory}");
    assert_eq!(studio.take_warnings(), [""; 0]);
}

#[test]
fn large_images_appear_in_the_frames_after_the_first() {
    let Some(mut studio) = studio::studio() else { return };
    let loaded = sheets(3, vec![plain(1_500, RED), plain(1_500, BLUE), plain(1_500, [0, 255, 0, 255])]);
    let whole = studio.render(&loaded, &settings()).unwrap();
    // Another device, and the model as a window shows it.
    studio.stage().device().lose();
    studio.stage().load_at_once(false);
    let mut frames = 0;
    let now = Instant::now();
    let mut first = None;
    while studio.stage().wants_frame(now) || frames == 0 {
        studio.stage().touch_window();
        studio.stage().whole_frame(now);
        frames += 1;
        assert!(frames < 10, "it wants frames for ever");
        first.get_or_insert(studio.stage().read_scene().unwrap());
    }
    assert_eq!(frames, 3, "an image of more than two million pixels in each");
    assert!(difference(&first.unwrap(), &whole) > 0, "the first frame has one of the images");
    assert_eq!(difference(&studio.stage().read_scene().unwrap(), &whole), 0);
}

#[test]
fn images_without_enough_memory_are_shown_smaller_with_a_warning() {
    let Some(mut studio) = studio::studio() else { return };
    let images = [[255, 0, 0, 255], [0, 0, 255, 255], [0, 255, 0, 255]].map(|color| plain(512, color));
    let loaded = sheets(3, images.to_vec());
    let whole = studio.render(&loaded, &settings()).unwrap();
    // Textures of 4 MB have 2 MB on a software adapter.
    let small = changed(&loaded, 16 << 20, |_| ());
    let picture = studio.render(&small, &settings()).unwrap();
    let warnings = studio.take_warnings();
    if studio.stage().device().is_software() {
        let expected =
            "Images are shown at half size: 0, 1; together they need 4 MB of memory, 2 are left for them";
        assert_eq!(warnings, [expected]);
    } else {
        assert_eq!(warnings, [""; 0], "the textures are not in the memory of the file");
    }
    assert_eq!(difference(&picture, &whole), 0, "one color is the same at each size");
}
