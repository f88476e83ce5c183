//! Decodes textures within limits: a file of one kilobyte must not allocate all memory.

use super::{Cancel, DecodedImage};
use dragonfly_anim::data::Image;
use image::{ImageDecoder, ImageReader, Limits};
use std::collections::HashMap;
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

/// Decodes every image once per content, in order, with at most `memory` bytes in all. Calls `progress` with the number
/// of decoded images after each.
///
/// Where there is not enough memory for all of them, the large ones are kept at a half, a quarter, … of their size. That,
/// and an image that fails, is a warning. Stops early, with `None` for the rest, when `cancel` is raised.
pub fn decode_all(images: &[Image], memory: u64, cancel: &Cancel, mut done: impl FnMut(usize)) -> Decoded {
    let mut decoded = Decoded::default();
    let mut known: HashMap<&[u8], usize> = HashMap::new();
    let twins: Vec<usize> = images
        .iter()
        .enumerate()
        // Images without data are not alike: each has its own warning.
        .map(|(index, image)| match image.bytes.is_empty() {
            true => index,
            false => *known.entry(&image.bytes[..]).or_insert(index),
        })
        .collect();
    let sizes: Vec<Result<ImageSize, String>> = images
        .iter()
        .zip(&twins)
        .enumerate()
        .map(|(index, (image, &twin))| if twin == index { size_of_image(image) } else { Err(String::new()) })
        .collect();
    let halvings = halvings(&sizes, memory);
    let (mut pixels, mut left) = (MAX_PIXELS_TOTAL, memory);
    for (index, image) in images.iter().enumerate() {
        let result = if cancel.is_cancelled() {
            None
        } else if twins[index] != index {
            decoded.images[twins[index]].clone()
        } else {
            let result = sizes[index].clone().and_then(|size| {
                let halvings = if size.is_large() { halvings } else { 0 };
                size.check(pixels, left, halvings)?;
                let image = decode_guarded(image, size, halvings)?;
                Ok((size, halvings, image))
            });
            match result {
                Ok((size, halvings, image)) => {
                    pixels -= size.pixels();
                    left -= (image.pixels.len() as u64).min(left);
                    if halvings > 0 {
                        decoded.warnings.push(format!(
                            "image {} is shown with {} × {} instead of {} × {} pixels: \
                             the images of this model are too many for its size",
                            label(index, &images[index]),
                            image.width,
                            image.height,
                            size.width,
                            size.height
                        ));
                    }
                    Some(Arc::new(image))
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

/// Size of an image, from its header.
#[derive(Clone, Copy, Debug)]
struct ImageSize {
    width: u32,
    height: u32,
    /// Bytes of the decoded pixels before their conversion to RGBA.
    raw: u64,
    /// Whether they need no conversion.
    is_rgba: bool,
}

/// Largest number of times that the size of an image is halved.
const MAX_HALVINGS: u32 = 4;
/// Number of pixels up to which an image is small enough to be kept as it is.
const SMALL: u64 = 512 * 512;

impl ImageSize {
    fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    fn is_large(&self) -> bool {
        self.pixels() > SMALL
    }

    /// Returns the bytes of the image after `halvings` of its size.
    fn kept(&self, halvings: u32) -> u64 {
        let side = |side: u32| u64::from((side >> halvings).max(1));
        4 * side(self.width) * side(self.height)
    }

    /// Returns the most memory that decoding needs.
    fn peak(&self, halvings: u32) -> u64 {
        if halvings == 0 && self.is_rgba { self.raw } else { self.raw + self.kept(halvings) }
    }

    /// Refuses an image beyond the limits.
    fn check(&self, pixels: u64, memory: u64, halvings: u32) -> Result<(), String> {
        let Self { width, height, .. } = self;
        if *width > MAX_SIDE || *height > MAX_SIDE || self.pixels() > MAX_PIXELS {
            return Err(format!(
                "{width} × {height} pixels are more than {MAX_SIDE} per side or {} million",
                MAX_PIXELS >> 20
            ));
        }
        if self.pixels() > pixels {
            return Err(format!(
                "the images of this model have more than {} million pixels",
                MAX_PIXELS_TOTAL >> 20
            ));
        }
        let peak = self.peak(halvings);
        if peak > memory {
            let mega = |bytes: u64| bytes.div_ceil(1 << 20);
            return Err(format!(
                "{width} × {height} pixels need {} MB of memory, {} are left for a file of this size",
                mega(peak),
                mega(memory)
            ));
        }
        Ok(())
    }
}

/// Returns how many times the sizes of the large images are halved, so that all of them fit into `memory` bytes.
fn halvings(sizes: &[Result<ImageSize, String>], memory: u64) -> u32 {
    // One that does not even fit alone is left out.
    let sizes =
        || sizes.iter().flatten().filter(|size| size.check(MAX_PIXELS_TOTAL, memory, MAX_HALVINGS).is_ok());
    let fits = |halvings: &u32| {
        let of = |size: &ImageSize| if size.is_large() { *halvings } else { 0 };
        let kept: u64 = sizes().map(|size| size.kept(of(size))).sum();
        let more = sizes().map(|size| size.peak(of(size)) - size.kept(of(size)).min(size.peak(of(size))));
        kept + more.max().unwrap_or(0) <= memory
    };
    (0..MAX_HALVINGS).find(fits).unwrap_or(MAX_HALVINGS)
}

/// Decodes an image. A decoder that panics loses only its image, like one that fails.
fn decode_guarded(image: &Image, size: ImageSize, halvings: u32) -> Result<DecodedImage, String> {
    std::panic::catch_unwind(|| decode_smaller(image, size, halvings))
        .unwrap_or_else(|_| Err("the decoder failed".to_owned()))
}

/// Decodes one image of at most `budget` pixels to RGBA.
///
/// The size is read from the header first, so that the check costs nothing.
pub fn decode(image: &Image, budget: u64) -> Result<DecodedImage, String> {
    let size = size_of_image(image)?;
    size.check(budget, u64::MAX, 0)?;
    decode_smaller(image, size, 0)
}

/// Returns the size in the header of an image. A decoder that panics fails.
fn size_of_image(image: &Image) -> Result<ImageSize, String> {
    if image.bytes.is_empty() {
        return Err("it has no data".to_owned());
    }
    let measure = || {
        let (width, height) = reader(image)?.into_dimensions().map_err(|error| error.to_string())?;
        let size = ImageSize { width, height, raw: 0, is_rgba: false };
        // Some decoders allocate by the size, so it is checked before one is created.
        size.check(MAX_PIXELS_TOTAL, u64::MAX, 0)?;
        let mut reader = reader(image)?;
        reader.limits(limits(&size));
        let decoder = reader.into_decoder().map_err(|error| error.to_string())?;
        let is_rgba = decoder.color_type() == image::ColorType::Rgba8;
        Ok(ImageSize { raw: decoder.total_bytes(), is_rgba, ..size })
    };
    std::panic::catch_unwind(measure).unwrap_or_else(|_| Err("the decoder failed".to_owned()))
}

fn reader(image: &Image) -> Result<ImageReader<Cursor<&[u8]>>, String> {
    ImageReader::new(Cursor::new(&image.bytes[..])).with_guessed_format().map_err(|error| error.to_string())
}

fn limits(size: &ImageSize) -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    // The widest format has sixteen bits per channel; decoders need up to twice that memory.
    limits.max_alloc = Some((size.pixels() * 16).max(1 << 20));
    limits
}

fn decode_smaller(image: &Image, size: ImageSize, halvings: u32) -> Result<DecodedImage, String> {
    let mut reader = reader(image)?;
    reader.limits(limits(&size));
    let mut decoded = reader.decode().map_err(|error| error.to_string())?;
    if halvings > 0 {
        let side = |side: u32| (side >> halvings).max(1);
        decoded = decoded.thumbnail_exact(side(size.width), side(size.height));
    }
    let rgba = decoded.into_rgba8();
    Ok(DecodedImage { width: rgba.width(), height: rgba.height(), pixels: rgba.into_raw() })
}

/// Returns the index and the name of an image for messages, as in `2 "wings.png"`.
fn label(index: usize, image: &Image) -> String {
    let name = image.file_name.as_deref().unwrap_or(&image.name);
    if name.is_empty() { format!("{index}") } else { format!("{index} \"{name}\"") }
}
