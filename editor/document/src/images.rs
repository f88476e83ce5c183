//! Decodes textures within limits: a file of one kilobyte must not allocate all memory.

use super::{Cancel, DecodedImage};
use dragonfly_anim::data::Image;
use image::{ImageReader, Limits};
use std::io::Cursor;
use std::sync::Arc;

/// Maximum width and height of an image; the limit of current GPUs.
pub const MAX_SIDE: u32 = 16_384;
/// Maximum number of pixels of one image.
pub const MAX_PIXELS: u64 = 64 << 20;
/// Maximum number of pixels of all images of a model.
pub const MAX_PIXELS_TOTAL: u64 = 256 << 20;

/// The decoded images of a model.
#[derive(Debug, Default)]
pub struct Decoded {
    /// One per image; `None` where it failed.
    pub images: Vec<Option<Arc<DecodedImage>>>,
    /// The reasons, one sentence per failure.
    pub warnings: Vec<String>,
}

/// Decodes every image once per source, in order. Calls `progress` with the number of decoded images after each.
///
/// An image that fails is a warning and `None`. Stops early, with `None` for the rest, when `cancel` is raised.
pub fn decode_all(images: &[Image], cancel: &Cancel, mut done: impl FnMut(usize)) -> Decoded {
    let mut decoded = Decoded::default();
    let mut budget = MAX_PIXELS_TOTAL;
    for (index, image) in images.iter().enumerate() {
        let twin = images[..index].iter().position(|earlier| same_source(earlier, image));
        let result = if cancel.is_cancelled() {
            None
        } else if let Some(twin) = twin {
            decoded.images[twin].clone()
        } else {
            match decode_guarded(image, budget) {
                Ok(pixels) => {
                    budget -= u64::from(pixels.width) * u64::from(pixels.height);
                    Some(Arc::new(pixels))
                }
                Err(reason) => {
                    decoded.warnings.push(format!("image {} is not shown: {reason}", label(index, image)));
                    None
                }
            }
        };
        decoded.images.push(result);
        done(index + 1);
    }
    decoded
}

/// Decodes an image. A decoder that panics loses only its image, like one that fails.
fn decode_guarded(image: &Image, budget: u64) -> Result<DecodedImage, String> {
    std::panic::catch_unwind(|| decode(image, budget))
        .unwrap_or_else(|_| Err("the decoder failed".to_owned()))
}

/// Decodes one image of at most `budget` pixels to RGBA.
///
/// The size is read from the header first, so that the check costs nothing.
pub fn decode(image: &Image, budget: u64) -> Result<DecodedImage, String> {
    if image.bytes.is_empty() {
        return Err("it has no data".to_owned());
    }
    let reader = || {
        ImageReader::new(Cursor::new(&image.bytes[..]))
            .with_guessed_format()
            .map_err(|error| error.to_string())
    };
    let (width, height) = reader()?.into_dimensions().map_err(|error| error.to_string())?;
    let pixels = u64::from(width) * u64::from(height);
    if width > MAX_SIDE || height > MAX_SIDE || pixels > MAX_PIXELS {
        return Err(format!(
            "{width} × {height} pixels are more than {MAX_SIDE} per side or {} million",
            MAX_PIXELS >> 20
        ));
    }
    if pixels > budget {
        return Err(format!(
            "the images of this model have more than {} million pixels",
            MAX_PIXELS_TOTAL >> 20
        ));
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    // The widest format has sixteen bits per channel; decoders need up to twice that memory.
    limits.max_alloc = Some((pixels * 16).max(1 << 20));
    let mut reader = reader()?;
    reader.limits(limits);
    let rgba = reader.decode().map_err(|error| error.to_string())?.into_rgba8();
    Ok(DecodedImage { width: rgba.width(), height: rgba.height(), pixels: rgba.into_raw() })
}

/// Returns whether both have the same bytes. Compares addresses, not contents: importers share equal data.
fn same_source(one: &Image, other: &Image) -> bool {
    !one.bytes.is_empty() && Arc::ptr_eq(&one.bytes, &other.bytes)
}

/// Returns the index and the name of an image for messages, as in `2 "wings.png"`.
fn label(index: usize, image: &Image) -> String {
    let name = image.file_name.as_deref().unwrap_or(&image.name);
    if name.is_empty() { format!("{index}") } else { format!("{index} \"{name}\"") }
}
