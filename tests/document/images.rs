//! No image makes the program panic, hang, or eat memory, whatever has happened to its bytes.

use dragonfly_anim::data::Image;
use dragonfly_document::images::decode;
use dragonfly_kit::mutate::Mutator;
use dragonfly_kit::random::seed;
use image::{ImageFormat, RgbImage, RgbaImage};
use std::io::Cursor;
use std::time::{Duration, Instant};

/// Stack size: the program decodes on threads with 2 MiB, and an eighth of that leaves a margin.
const STACK: usize = 256 << 10;
/// Longest time for decoding one small image.
const LONGEST: Duration = Duration::from_secs(2);
/// Largest number of pixels of an image that is decoded here.
const PIXELS: u64 = 1 << 20;

/// Returns small images of each format that models contain.
fn seeds() -> Vec<Vec<u8>> {
    let rgba = RgbaImage::from_fn(9, 7, |x, y| image::Rgba([x as u8 * 20, y as u8 * 30, 128, 255 - x as u8]));
    let rgb = RgbImage::from_fn(17, 16, |x, y| image::Rgb([x as u8 * 15, y as u8 * 15, 40]));
    let grey = image::DynamicImage::from(rgb.clone()).into_luma16();
    let encode = |write: &dyn Fn(&mut Cursor<Vec<u8>>)| {
        let mut bytes = Cursor::new(Vec::new());
        write(&mut bytes);
        bytes.into_inner()
    };
    let ktx2 = |name: &str| std::fs::read(dragonfly_kit::folder::data("ktx2").join(name)).unwrap();
    vec![
        ktx2("etc1s.ktx2"),
        ktx2("uastc.ktx2"),
        ktx2("uastc_zstd.ktx2"),
        encode(&|out| rgba.write_to(out, ImageFormat::Png).unwrap()),
        encode(&|out| rgb.write_to(out, ImageFormat::Png).unwrap()),
        encode(&|out| grey.write_to(out, ImageFormat::Png).unwrap()),
        encode(&|out| rgb.write_to(out, ImageFormat::Jpeg).unwrap()),
        encode(&|out| {
            image::DynamicImage::from(rgb.clone()).into_luma8().write_to(out, ImageFormat::Jpeg).unwrap();
        }),
    ]
}

/// Decodes an image. Returns whether that succeeded; a decoded image must be complete.
fn try_decode(bytes: &[u8]) -> bool {
    let image = Image { bytes: bytes.into(), ..Image::default() };
    let begin = Instant::now();
    let decoded = decode(&image, PIXELS);
    assert!(begin.elapsed() < LONGEST, "took {:?}", begin.elapsed());
    match decoded {
        Ok(decoded) => {
            assert_eq!(decoded.pixels.len() as u64, u64::from(decoded.width) * u64::from(decoded.height) * 4);
            true
        }
        Err(reason) => {
            assert!(!reason.is_empty());
            false
        }
    }
}

/// Runs `work` on a stack of the guaranteed minimum size and forwards its panic.
fn on_small_stack(work: impl FnOnce() + Send + 'static) {
    let thread = std::thread::Builder::new().stack_size(STACK).spawn(work).unwrap();
    if let Err(panic) = thread.join() {
        std::panic::resume_unwind(panic);
    }
}

#[test]
fn twenty_thousand_damaged_images_decode_or_return_an_error() {
    on_small_stack(|| {
        let seeds = seeds();
        assert!(seeds.iter().all(|bytes| try_decode(bytes)), "each is right before it is damaged");
        let seed = seed(41_117);
        let mut mutator = Mutator::new(seed, &[b"IHDR", b"PLTE", b"tRNS", b"IDAT", b"\xff\xc0", b"\xff\xda"]);
        let mut pictures = 0;
        for number in 0..20_000 {
            let bytes = mutator.mutant(&seeds);
            let tried = std::panic::catch_unwind(|| try_decode(&bytes));
            pictures +=
                u32::from(tried.unwrap_or_else(|_| panic!("image {number} of seed {seed}: {bytes:?}")));
        }
        println!("20000 images, {pictures} of them pictures, seed {seed}");
        assert!(pictures > 100 && pictures < 19_900, "{pictures}: most are damaged, not all beyond use");
    });
}

#[test]
fn an_image_cut_or_changed_at_any_byte_decodes_or_returns_an_error() {
    on_small_stack(|| {
        for bytes in seeds() {
            for length in 0..bytes.len() {
                try_decode(&bytes[..length]);
            }
            for position in 0..bytes.len() {
                let old = bytes[position];
                for new in [0x00, 0xff, old.wrapping_add(1), old.wrapping_sub(1)] {
                    let mut changed = bytes.clone();
                    changed[position] = new;
                    try_decode(&changed);
                }
            }
        }
    });
}
