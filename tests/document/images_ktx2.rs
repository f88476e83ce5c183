//! Pictures in KTX 2 have the pixels that the transcoder of Basis Universal gives in three.js, whatever their compression.

use dragonfly_anim::data::Image;
use dragonfly_document::Cancel;
use dragonfly_document::images::{ImageSurvey, decode};
use dragonfly_kit::counting::peak;
use dragonfly_kit::folder::data;

/// Number of pixels of the pictures.
const PIXELS: u64 = 40 * 24;

fn file(name: &str) -> Vec<u8> {
    std::fs::read(data("ktx2").join(name)).unwrap()
}

fn image(bytes: Vec<u8>) -> Image {
    Image { bytes: bytes.into(), ..Image::default() }
}

#[test]
fn the_pixels_are_those_of_three_js() {
    for name in ["etc1s", "uastc", "uastc_zstd"] {
        let decoded = decode(&image(file(&format!("{name}.ktx2"))), PIXELS).unwrap();
        assert_eq!((decoded.width, decoded.height), (40, 24), "{name}");
        assert!(decoded.pixels == file(&format!("{name}.rgba")), "{name}");
    }
}

#[test]
fn the_pixels_are_near_those_that_were_compressed() {
    let source = image::load_from_memory(&file("source.png")).unwrap().into_rgba8();
    // ETC1S has two colors for a block of 4 x 4 pixels.
    for (name, most) in [("etc1s", 40), ("uastc", 12), ("uastc_zstd", 12)] {
        let decoded = decode(&image(file(&format!("{name}.ktx2"))), PIXELS).unwrap();
        let pairs = decoded.pixels.iter().zip(source.as_raw());
        let worst = pairs.map(|(have, want)| have.abs_diff(*want)).max();
        assert!(worst.is_some_and(|worst| worst <= most), "{name}: {worst:?} of {most}");
    }
}

#[test]
fn a_halved_picture_is_smaller_and_a_picture_beyond_the_limits_is_refused() {
    let images = [image(file("etc1s.ktx2"))];
    let (survey, warnings) = ImageSurvey::new(&images, u64::MAX, &Cancel::default());
    assert_eq!(warnings, [""; 0]);
    let half = survey.decode(&images, 0, 1).unwrap();
    assert_eq!((half.width, half.height, half.pixels.len()), (20, 12, 20 * 12 * 4));
    assert!(decode(&images[0], PIXELS - 1).unwrap_err().contains("pixels"));
}

#[test]
fn what_a_file_says_of_its_length_is_not_allocated() {
    // The length of the first level before its compression, section 3.9 of the specification.
    const LENGTH: usize = 80 + 16;
    for length in [u64::MAX, 1 << 40, 0, 961] {
        let mut bytes = file("uastc_zstd.ktx2");
        bytes[LENGTH..LENGTH + 8].copy_from_slice(&length.to_le_bytes());
        let (memory, decoded) = peak(|| decode(&image(bytes), PIXELS));
        assert!(decoded.unwrap_err().contains("damaged"), "{length}");
        assert!(memory < 1 << 20, "{memory} bytes for {length}");
    }
}

#[test]
fn other_kinds_of_ktx_2_are_refused_by_name() {
    // The format of Vulkan for blocks of BC7.
    let mut bytes = file("uastc.ktx2");
    bytes[12..16].copy_from_slice(&145_u32.to_le_bytes());
    let error = decode(&image(bytes), PIXELS).unwrap_err();
    assert!(error.contains("without Basis Universal"), "{error}");
    // Six faces of a cube.
    let mut bytes = file("uastc.ktx2");
    bytes[36..40].copy_from_slice(&6_u32.to_le_bytes());
    assert!(decode(&image(bytes), PIXELS).is_err());
}
