//! The images of a model fit into the memory that its file may use: equal ones are decoded once, and where large ones
//! are too many, they are shown smaller.

use dragonfly_anim::data::Image;
use dragonfly_document::Cancel;
use dragonfly_document::images::{Decoded, decode_all};
use dragonfly_kit::counting::peak;
use image::{GrayImage, ImageFormat, Luma, Rgba, RgbaImage};
use std::io::Cursor;
use std::sync::Arc;

/// An image of `side` by `side` pixels of one shade, without transparency.
fn shade(side: u32, shade: u8) -> Image {
    let mut png = Cursor::new(Vec::new());
    GrayImage::from_pixel(side, side, Luma([shade])).write_to(&mut png, ImageFormat::Png).unwrap();
    Image { bytes: png.into_inner().into(), ..Image::default() }
}

fn decoded(images: &[Image], memory: u64) -> (u64, Decoded) {
    peak(|| decode_all(images, memory, &Cancel::default(), |_| {}))
}

#[test]
fn equal_images_in_different_places_are_decoded_once() {
    let images: Vec<Image> = (0..40).map(|_| shade(1_024, 7)).collect();
    let (memory, decoded) = decoded(&images, u64::MAX);
    assert!(memory < 3 * (4 << 20), "{memory}");
    let [Some(first), .., Some(last)] = &decoded.images[..] else { panic!("{:?}", decoded.warnings) };
    assert!(Arc::ptr_eq(first, last));
}

#[test]
fn large_images_are_kept_smaller_where_all_of_them_do_not_fit() {
    let images: Vec<Image> = (0..20).map(|number| shade(2_048, number)).chain([shade(64, 99)]).collect();
    let budget = 64 << 20;
    let (memory, decoded) = decoded(&images, budget);
    // Not counted: the rows and tables of the decoder.
    assert!(memory <= budget + (1 << 20), "{memory} of {budget}");
    for (number, image) in decoded.images[..20].iter().enumerate() {
        let image = image.as_ref().unwrap_or_else(|| panic!("{number}: {:?}", decoded.warnings));
        assert_eq!((image.width, image.height), (512, 512));
        assert_eq!(image.pixels[..4], [number as u8, number as u8, number as u8, 255]);
    }
    assert_eq!(decoded.images[20].as_ref().unwrap().width, 64, "a small image stays as it is");
    assert_eq!(decoded.warnings.len(), 20);
    assert!(decoded.warnings[0].contains("512 × 512 instead of 2048 × 2048"), "{}", decoded.warnings[0]);
}

#[test]
fn an_image_that_does_not_fit_alone_is_left_out_and_the_others_stay() {
    let images = [shade(8_000, 1), shade(1_024, 2)];
    let (memory, decoded) = decoded(&images, 20 << 20);
    assert!(memory <= 21 << 20, "{memory}");
    assert!(decoded.images[0].is_none());
    assert_eq!(decoded.images[1].as_ref().unwrap().width, 1_024);
    assert_eq!(decoded.warnings.len(), 1);
    assert!(decoded.warnings[0].contains("MB of memory"), "{}", decoded.warnings[0]);
}

#[test]
fn images_that_fit_are_decoded_as_they_are() {
    let pixels = RgbaImage::from_fn(700, 600, |x, y| Rgba([x as u8, y as u8, 3, 200]));
    let mut png = Cursor::new(Vec::new());
    pixels.write_to(&mut png, ImageFormat::Png).unwrap();
    let image = Image { bytes: png.into_inner().into(), ..Image::default() };
    let (_, decoded) = decoded(&[image], 8 << 20);
    assert_eq!(decoded.warnings, Vec::<String>::new());
    assert_eq!(decoded.images[0].as_ref().unwrap().pixels, pixels.into_raw());
}
