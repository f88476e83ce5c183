//! Reference pictures: the frames of a picture, of a numbered sequence and of an animated GIF, and files that are refused.

use dragonfly_document::{Cancel, REFERENCE_SIDE, ReferenceSource};
use dragonfly_kit::folder::Folder;
use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, Frame, Rgba, RgbaImage};
use std::path::Path;

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];

fn plain(color: [u8; 4]) -> RgbaImage {
    RgbaImage::from_pixel(6, 4, Rgba(color))
}

fn survey(path: &Path) -> Result<ReferenceSource, String> {
    ReferenceSource::survey(path, true, &Cancel::default())
}

/// Returns the index and the color of the frames that are decoded from `first` on.
fn colors(source: &ReferenceSource, first: usize, count: usize) -> Vec<(usize, [u8; 4])> {
    let mut found = Vec::new();
    source.decode(first, count, |frame, image| {
        let image = image.expect("a frame");
        let color = image.pixels[..4].try_into().expect("a pixel");
        assert!(image.pixels.chunks(4).all(|pixel| pixel == color), "frame {frame} has one color");
        found.push((frame, color));
        true
    });
    found
}

#[test]
fn a_numbered_sequence_is_found_by_any_of_its_files_and_a_gap_shows_the_frame_before_it() {
    let folder = Folder::new("reference-sequence");
    for (name, color) in [
        ("walk_0009.png", RED),
        ("walk_0010.png", GREEN),
        // 11 is missing.
        ("walk_0012.png", BLUE),
        ("run_0010.png", RED),
        ("walk_0010.jpg", RED),
    ] {
        let image = image::DynamicImage::ImageRgba8(plain(color));
        let image = if name.ends_with("jpg") { image.to_rgb8().into() } else { image };
        image.save(folder.join(name)).expect("a file");
    }
    std::fs::write(folder.join("walk_x.png"), b"no number").expect("a file");
    for name in ["walk_0009.png", "walk_0012.png"] {
        let source = survey(&folder.join(name)).expect("a sequence");
        assert_eq!((source.frames(), source.rate(), source.size()), (4, None, [6, 4]));
        assert_eq!(colors(&source, 0, 9), [(0, RED), (1, GREEN), (2, GREEN), (3, BLUE)]);
        assert_eq!(colors(&source, 2, 1), [(2, GREEN)]);
    }
    // One picture of it alone.
    let alone = ReferenceSource::survey(&folder.join("walk_0010.png"), false, &Cancel::default()).unwrap();
    assert_eq!((alone.frames(), colors(&alone, 0, 3)), (1, vec![(0, GREEN)]));
}

#[test]
fn the_frames_of_a_gif_are_decoded_from_any_frame_on_with_its_own_rate() {
    let folder = Folder::new("reference-gif");
    let path = folder.join("walk.gif");
    let mut encoder = GifEncoder::new(std::fs::File::create(&path).expect("a file"));
    encoder.set_repeat(Repeat::Infinite).expect("a loop");
    for color in [RED, GREEN, BLUE] {
        let delay = Delay::from_numer_denom_ms(80, 1);
        encoder.encode_frame(Frame::from_parts(plain(color), 0, 0, delay)).expect("a frame");
    }
    drop(encoder);
    let source = survey(&path).expect("an animation");
    assert_eq!((source.frames(), source.size()), (3, [6, 4]));
    assert!((source.rate().expect("a rate") - 12.5).abs() < 1e-3, "{:?}", source.rate());
    assert_eq!(colors(&source, 0, 9), [(0, RED), (1, GREEN), (2, BLUE)]);
    assert_eq!(colors(&source, 1, 1), [(1, GREEN)]);
    // Decoding ends when no more frames are wanted.
    let mut passed = 0;
    source.decode(0, 3, |_, _| {
        passed += 1;
        passed < 2
    });
    assert_eq!(passed, 2);
}

#[test]
fn a_large_picture_is_halved_until_it_fits() {
    let folder = Folder::new("reference-large");
    let path = folder.join("large.png");
    RgbaImage::from_pixel(2 * REFERENCE_SIDE + 2, 8, Rgba(BLUE)).save(&path).expect("a file");
    let source = survey(&path).expect("a picture");
    let [width, height] = source.size();
    assert!(width <= REFERENCE_SIDE && width > REFERENCE_SIDE / 4 && height >= 1, "{width} × {height}");
    assert_eq!(colors(&source, 0, 1), [(0, BLUE)]);
}

#[test]
fn broken_missing_and_huge_files_and_videos_are_refused_with_a_message() {
    let folder = Folder::new("reference-broken");
    std::fs::write(folder.join("broken.png"), b"\x89PNG\r\n\x1a\n and nothing else").expect("a file");
    std::fs::write(folder.join("broken.gif"), b"GIF89a").expect("a file");
    std::fs::write(folder.join("take 1.mp4"), b"").expect("a file");
    // A header of 100,000 × 100,000 pixels.
    let mut huge = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec();
    huge.extend([0, 1, 0x86, 0xa0, 0, 1, 0x86, 0xa0, 8, 6, 0, 0, 0, 0, 0, 0, 0]);
    std::fs::write(folder.join("huge.png"), huge).expect("a file");
    for (name, says) in [
        ("broken.png", "broken.png cannot be shown"),
        ("broken.gif", "broken.gif cannot be shown"),
        ("missing.png", "missing.png cannot be read"),
        ("huge.png", "huge.png cannot be shown"),
        ("take 1.mp4", "ffmpeg -i take 1.mp4 out_%04d.png"),
    ] {
        let refused = survey(&folder.join(name)).expect_err(name);
        assert!(refused.contains(says), "{name}: {refused}");
    }
    assert!(survey(folder.path()).is_err(), "a folder");
}
