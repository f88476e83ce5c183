//! The images of a model take no memory until they are drawn, and then only one of them at a time.

use dragonfly_anim::data::Image;
use dragonfly_document::images::ImageSurvey;
use dragonfly_document::{Cancel, DecodedImage};
use dragonfly_kit::counting::peak;
use image::{GrayImage, ImageFormat, Luma, Rgba, RgbaImage};
use std::io::Cursor;

fn encoded(write: impl FnOnce(&mut Cursor<Vec<u8>>)) -> Image {
    let mut png = Cursor::new(Vec::new());
    write(&mut png);
    Image { bytes: png.into_inner().into(), ..Image::default() }
}

/// An image of `side` by `side` pixels of one shade, without transparency.
fn shade(side: u32, shade: u8) -> Image {
    let pixels = GrayImage::from_pixel(side, side, Luma([shade]));
    encoded(|png| pixels.write_to(png, ImageFormat::Png).unwrap())
}

fn survey(images: &[Image], memory: u64) -> (ImageSurvey, Vec<String>) {
    ImageSurvey::new(images, memory, &Cancel::default())
}

#[test]
fn a_survey_of_many_images_takes_little_memory() {
    let images: Vec<Image> = (0..20).map(|number| shade(2_048, number)).collect();
    let (memory, (survey, warnings)) = peak(|| survey(&images, u64::MAX));
    // A decoder of PNG keeps some rows, and its tables.
    assert!(memory < 1 << 20, "{memory}");
    assert_eq!(warnings, [""; 0]);
    assert!((0..20).all(|index| survey.get(index).is_some_and(|image| image.size() == [2_048; 2])));
}

#[test]
fn images_are_decoded_one_at_a_time_and_none_is_kept() {
    let images: Vec<Image> = (0..20).map(|number| shade(1_024, number)).collect();
    let (survey, _) = survey(&images, u64::MAX);
    let one = survey.get(0).unwrap().peak(0);
    assert_eq!(one, (4 << 20) + (1_024 * 32), "the colors, and some rows");
    let (memory, warnings) = peak(|| survey.damage(&images));
    assert_eq!(warnings, [""; 0]);
    // Not counted: the tables of the decoder.
    assert!(memory <= one + (256 << 10), "{memory} of {one}");
}

#[test]
fn a_halved_image_takes_the_memory_of_its_size() {
    let images = [shade(2_048, 7)];
    let (survey, _) = survey(&images, u64::MAX);
    let most = survey.get(0).unwrap().peak(2);
    let (memory, decoded) = peak(|| survey.decode(&images, 0, 2).unwrap());
    // Not counted: the rows and tables of the decoder.
    assert!(memory <= most + (1 << 20), "{memory} of {most}");
    assert_eq!((decoded.width, decoded.height), (512, 512));
    assert_eq!(decoded.pixels[..4], [7, 7, 7, 255]);
}

#[test]
fn an_image_that_does_not_fit_alone_is_left_out_and_the_others_stay() {
    let large = GrayImage::from_pixel(8_000, 8_000, Luma([1]));
    let large = encoded(|jpeg| large.write_to(jpeg, ImageFormat::Jpeg).unwrap());
    let images = [large, shade(1_024, 2)];
    let (survey, warnings) = survey(&images, 20 << 20);
    assert_eq!(survey.get(0), None);
    assert_eq!(survey.decode(&images, 1, 0).unwrap().width, 1_024);
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].contains("MB of memory"), "{}", warnings[0]);
}

#[test]
fn an_image_that_fits_is_decoded_as_it_is() {
    let pixels = RgbaImage::from_fn(700, 600, |x, y| Rgba([x as u8, y as u8, 3, 200]));
    let images = [encoded(|png| pixels.write_to(png, ImageFormat::Png).unwrap())];
    let (survey, warnings) = survey(&images, 8 << 20);
    assert_eq!(warnings, [""; 0]);
    let DecodedImage { pixels: decoded, .. } = survey.decode(&images, 0, 0).unwrap();
    assert_eq!(decoded, pixels.into_raw());
}

#[test]
fn damaged_pixels_are_found_by_decoding_and_not_by_the_survey() {
    let whole = shade(64, 3);
    let cut = Image {
        bytes: whole.bytes[..whole.bytes.len() - 30].into(),
        name: "cut".to_owned(),
        ..Image::default()
    };
    let images = [whole, cut.clone(), cut];
    let (survey, warnings) = survey(&images, u64::MAX);
    assert_eq!(warnings, [""; 0]);
    let damage = survey.damage(&images);
    assert_eq!(damage.len(), 1, "once for each content: {damage:?}");
    assert!(damage[0].starts_with("image 1 \"cut\" is not shown: "), "{}", damage[0]);
}

#[test]
fn a_halved_png_needs_no_memory_for_the_pixels_of_the_file_and_averages_them() {
    let images = [shade(8_000, 9)];
    let (survey, warnings) = survey(&images, 20 << 20);
    assert_eq!(warnings, [""; 0], "64 million pixels in 20 MiB");
    let (memory, decoded) = peak(|| survey.decode(&images, 0, 2).unwrap());
    assert!(memory < 17 << 20, "{memory}");
    assert_eq!((decoded.width, decoded.height), (2_000, 2_000));
    assert!(decoded.pixels.chunks(4).all(|pixel| pixel == [9, 9, 9, 255]));
}

#[test]
fn every_kind_of_png_gives_the_pixels_that_another_decoder_gives() {
    let pixel = |x: u32, y: u32| [x as u8 * 3, y as u8 * 5, (x * y) as u8, 255 - x as u8];
    let rgba = RgbaImage::from_fn(64, 40, |x, y| Rgba(pixel(x, y)));
    let all = image::DynamicImage::from(rgba);
    let kinds = [
        image::DynamicImage::from(all.to_rgb8()),
        image::DynamicImage::from(all.to_luma8()),
        image::DynamicImage::from(all.to_luma_alpha8()),
        image::DynamicImage::from(all.to_rgb16()),
        image::DynamicImage::from(all.to_rgba16()),
        image::DynamicImage::from(all.to_luma16()),
        all,
    ];
    for (kind, pixels) in kinds.iter().enumerate() {
        let images = [encoded(|png| pixels.write_to(png, ImageFormat::Png).unwrap())];
        let wanted = image::load_from_memory(&images[0].bytes).unwrap();
        let (survey, _) = survey(&images, u64::MAX);
        let decoded = survey.decode(&images, 0, 0).unwrap();
        assert_eq!(decoded.pixels, wanted.to_rgba8().into_raw(), "kind {kind}");
        let half = survey.decode(&images, 0, 1).unwrap();
        let smaller = wanted.thumbnail_exact(32, 20).to_rgba8();
        assert_eq!((half.width, half.height), (32, 20));
        let off = half.pixels.iter().zip(smaller.as_raw()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(off <= Some(1), "kind {kind}: {off:?}");
    }
}
