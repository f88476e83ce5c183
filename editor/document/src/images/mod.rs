//! The images of a model: surveyed when it is opened, and decoded one at a time by what draws it, within limits: a file of
//! one kilobyte must not allocate all memory.

mod ktx2;
mod rows;

use super::Cancel;
use dragonfly_anim::data::Image;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use std::collections::HashMap;
use std::io::Cursor;

/// Maximum width and height of an image; the limit of current GPUs.
pub const MAX_SIDE: u32 = 16_384;
/// Maximum number of pixels of one image.
pub const MAX_PIXELS: u64 = 64 << 20;
/// Maximum number of pixels of all images of a model.
pub const MAX_PIXELS_TOTAL: u64 = 256 << 20;

/// An image ready for the GPU. It exists only on the way there.
#[derive(Clone, Debug, PartialEq)]
pub struct DecodedImage {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// RGBA, 8 bits each, rows from the top, `width * height * 4` bytes.
    pub pixels: Vec<u8>,
}

/// The images of a model that can be decoded, as their headers describe them. It keeps no pixels.
#[derive(Clone, Debug, Default)]
pub struct ImageSurvey {
    images: Vec<Option<SurveyedImage>>,
    memory: u64,
}

/// An image that can be decoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurveyedImage {
    source: u32,
    size: ImageSize,
}

impl SurveyedImage {
    /// Returns the index of the first image of the model with the same content.
    pub fn source(&self) -> u32 {
        self.source
    }

    /// Returns its width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.size.width, self.size.height]
    }

    /// Returns the most memory in bytes that decoding needs, with the decoded pixels, if the result is halved this many
    /// times.
    pub fn peak(&self, halvings: u32) -> u64 {
        self.size.peak(halvings)
    }
}

impl ImageSurvey {
    /// Reads the header of every image. Decoding one of them may take `memory` bytes.
    ///
    /// Also returns a warning for each image that cannot be shown. Stops early, without the rest, when `cancel` is raised.
    pub fn new(images: &[Image], memory: u64, cancel: &Cancel) -> (Self, Vec<String>) {
        let mut survey = Self { images: Vec::with_capacity(images.len()), memory };
        let mut warnings = Vec::new();
        let mut known: HashMap<&[u8], usize> = HashMap::new();
        let mut pixels = MAX_PIXELS_TOTAL;
        for (index, image) in images.iter().enumerate() {
            if cancel.is_cancelled() {
                break;
            }
            // Images without data are not alike: each has its own warning.
            let source =
                if image.bytes.is_empty() { index } else { *known.entry(&image.bytes[..]).or_insert(index) };
            let surveyed = if source != index {
                survey.images[source]
            } else {
                let size = size_of_image(image).and_then(|size| {
                    // The smallest result, because what draws it decides how small it has to be.
                    size.check(pixels, memory, MAX_HALVINGS).map(|()| size)
                });
                match size {
                    Ok(size) => {
                        pixels -= size.pixels();
                        Some(SurveyedImage { source: index as u32, size })
                    }
                    Err(reason) => {
                        warnings.push(not_shown(images, index as u32, &reason));
                        None
                    }
                }
            };
            survey.images.push(surveyed);
        }
        (survey, warnings)
    }

    /// Returns image number `index`; `None` if it cannot be decoded.
    pub fn get(&self, index: u32) -> Option<&SurveyedImage> {
        self.images.get(index as usize)?.as_ref()
    }

    /// Returns the memory in bytes that the images may use: the promise of the import, without what the rest of the model needs.
    pub fn memory(&self) -> u64 {
        self.memory
    }

    /// Decodes image number `index` of `images`, which were surveyed, with its sides halved `halvings` times.
    ///
    /// # Errors
    /// A warning for the user. A decoder that panics loses only its image, like one that fails.
    pub fn decode(&self, images: &[Image], index: u32, halvings: u32) -> Result<DecodedImage, String> {
        let image = self.get(index).and_then(|surveyed| Some((surveyed, images.get(index as usize)?)));
        let Some((surveyed, image)) = image else { return Err(format!("image {index} is not shown")) };
        std::panic::catch_unwind(|| decode_smaller(image, surveyed.size, halvings))
            .unwrap_or_else(|_| Err("the decoder failed".to_owned()))
            .map_err(|reason| not_shown(images, index, &reason))
    }

    /// Decodes every image once per content, one at a time, and keeps none. Returns a warning for each that fails.
    pub fn damage(&self, images: &[Image]) -> Vec<String> {
        let sources = (0..)
            .zip(&self.images)
            .filter(|(index, image)| image.is_some_and(|image| image.source == *index));
        // Halved, because only then it was checked that decoding has enough memory.
        sources.filter_map(|(index, _)| self.decode(images, index, MAX_HALVINGS).err()).collect()
    }
}

/// Returns the warning about an image that cannot be shown.
fn not_shown(images: &[Image], index: u32, reason: &str) -> String {
    format!("image {} is not shown: {reason}", label(images, index))
}

/// Returns the index and the name of an image for messages, as in `2 "wings.png"`.
pub fn label(images: &[Image], index: u32) -> String {
    let name =
        images.get(index as usize).map_or("", |image| image.file_name.as_deref().unwrap_or(&image.name));
    if name.is_empty() { format!("{index}") } else { format!("{index} \"{name}\"") }
}

/// Size of an image, from its header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct ImageSize {
    width: u32,
    height: u32,
    /// Bytes of the decoded pixels before their conversion to RGBA.
    raw: u64,
    /// Whether they need no conversion.
    is_rgba: bool,
    decoder: PixelDecoder,
}

/// The decoder of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PixelDecoder {
    /// All pixels at once.
    Whole,
    /// Row by row.
    Rows,
    /// The transcoder of KTX 2.
    Ktx2,
}

/// Number of halvings after which the memory of the result hardly counts.
const MAX_HALVINGS: u32 = 4;

impl ImageSize {
    fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Returns the bytes of the image after `halvings` of its size.
    fn kept(&self, halvings: u32) -> u64 {
        let side = |side: u32| u64::from((side >> halvings).max(1));
        4 * side(self.width) * side(self.height)
    }

    /// Returns the most memory that decoding needs.
    fn peak(&self, halvings: u32) -> u64 {
        match self.decoder {
            PixelDecoder::Rows => self.kept(halvings) + rows::memory_of_rows(self.width),
            PixelDecoder::Whole | PixelDecoder::Ktx2 if halvings == 0 && self.is_rgba => self.raw,
            PixelDecoder::Whole | PixelDecoder::Ktx2 => self.raw + self.kept(halvings),
        }
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

/// Decodes one image of at most `budget` pixels to RGBA.
///
/// The size is read from the header first, so that the check costs nothing.
pub fn decode(image: &Image, budget: u64) -> Result<DecodedImage, String> {
    let size = size_of_image(image)?;
    size.check(budget, u64::MAX, 0)?;
    decode_smaller(image, size, 0)
}

/// Decodes an image to RGBA, with its sides halved until the longer one is at most `side` pixels. A decoder that panics fails.
///
/// # Errors
///
/// The reason: it is broken, or larger than the limits.
pub fn decode_within(image: &Image, side: u32) -> Result<DecodedImage, String> {
    let size = size_of_image(image)?;
    size.check(MAX_PIXELS, u64::MAX, 0)?;
    let longest = size.width.max(size.height);
    let halvings = (0..32).find(|halvings| longest >> halvings <= side).unwrap_or(32);
    std::panic::catch_unwind(|| decode_smaller(image, size, halvings))
        .unwrap_or_else(|_| Err("the decoder failed".to_owned()))
}

/// Returns the size in the header of an image. A decoder that panics fails.
fn size_of_image(image: &Image) -> Result<ImageSize, String> {
    if image.bytes.is_empty() {
        return Err("it has no data".to_owned());
    }
    let measure = || {
        if ktx2::is_ktx2(&image.bytes) {
            let [width, height] = ktx2::size_of(&image.bytes)?;
            let size = ImageSize { width, height, raw: 0, is_rgba: true, decoder: PixelDecoder::Ktx2 };
            return Ok(ImageSize { raw: ktx2::raw_bytes(size.pixels()), ..size });
        }
        let (width, height) = reader(image)?.into_dimensions().map_err(|error| error.to_string())?;
        let size = ImageSize { width, height, raw: 0, is_rgba: false, decoder: PixelDecoder::Whole };
        // Some decoders allocate by the size, so it is checked before one is created.
        size.check(MAX_PIXELS_TOTAL, u64::MAX, 0)?;
        let mut reader = reader(image)?;
        reader.limits(limits(&size));
        let decoder = reader.into_decoder().map_err(|error| error.to_string())?;
        let is_rgba = decoder.color_type() == image::ColorType::Rgba8;
        let is_png = image::guess_format(&image.bytes).is_ok_and(|format| format == ImageFormat::Png);
        let has_rows = is_png && rows::has_rows(&image.bytes);
        let kind = if has_rows { PixelDecoder::Rows } else { PixelDecoder::Whole };
        Ok(ImageSize { raw: decoder.total_bytes(), is_rgba, decoder: kind, ..size })
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
    let mut decoded = match size.decoder {
        PixelDecoder::Rows => return rows::decode_rows(&image.bytes, halvings),
        PixelDecoder::Whole => {
            let mut reader = reader(image)?;
            reader.limits(limits(&size));
            reader.decode().map_err(|error| error.to_string())?
        }
        PixelDecoder::Ktx2 => DynamicImage::ImageRgba8(ktx2::decode(&image.bytes, size)?),
    };
    if halvings > 0 {
        let side = |side: u32| (side >> halvings).max(1);
        decoded = decoded.thumbnail_exact(side(size.width), side(size.height));
    }
    let rgba = decoded.into_rgba8();
    Ok(DecodedImage { width: rgba.width(), height: rgba.height(), pixels: rgba.into_raw() })
}
