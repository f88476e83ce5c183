//! Images of a model: found, measured and copied as they are. Nothing is decoded here.

use super::uri::plain_reference;
use super::{ImportContext, ImportError, Place};
use crate::data::{Filter, Wrap};
use crate::data::{Image, TextureRef, TextureTransform};
use crate::limits::{IMAGE_PIXELS, IMAGE_SIDE, IMAGES_PIXELS};
use std::collections::HashMap;

/// An image cannot be read, or is neither PNG, JPEG nor WebP.
pub(super) const IMAGE_DATA_INVALID: &str = "IMAGE_DATA_INVALID";
/// The declared type of an image is not that of its bytes.
pub(super) const IMAGE_MIME_TYPE_INVALID: &str = "IMAGE_MIME_TYPE_INVALID";
/// An image has too many pixels.
pub(super) const IMAGE_TOO_LARGE: &str = "IMAGE_TOO_LARGE";

/// Images in files next to the model, each once.
pub(super) struct NeighborImages<'a> {
    context: &'a ImportContext<'a>,
    images: Vec<Image>,
    known: HashMap<String, u32>,
    pixels: u64,
}

impl<'a> NeighborImages<'a> {
    pub(super) fn new(context: &'a ImportContext<'a>) -> Self {
        Self { context, images: Vec::new(), known: HashMap::new(), pixels: 0 }
    }

    /// Returns a use of the image whose file is called `name` in the text of the model. One that cannot be read is left empty
    /// with a warning, since a model without textures is still useful.
    pub(super) fn texture(&mut self, name: &str, place: &Place) -> Result<TextureRef, ImportError> {
        let reference = plain_reference(name);
        let image = match self.known.get(&reference) {
            Some(&image) => image,
            None => {
                let bytes = size_of::<Image>() + 4 * reference.len();
                self.context.charge(place, 2 * bytes as u64)?;
                let image = self.images.len() as u32;
                let read = self.read(&reference, place)?;
                self.images.push(read);
                self.known.insert(reference, image);
                image
            }
        };
        Ok(TextureRef {
            image,
            set: 0,
            wrap: [Wrap::Repeat; 2],
            magnify: Filter::Linear,
            minify: Filter::Linear,
            mip: true,
            transform: TextureTransform::IDENTITY,
        })
    }

    fn read(&mut self, reference: &str, place: &Place) -> Result<Image, ImportError> {
        let mut image = Image::default();
        match self.context.read_neighbor(reference, place) {
            Ok(bytes) => {
                image.bytes = bytes;
                image.file_name = super::uri::relative_path(reference).ok();
            }
            Err(ImportError::External { uri, reason, .. }) => {
                let text = format!("\"{uri}\": {reason}; the image is left empty");
                self.context.warn(place.clone(), IMAGE_DATA_INVALID, text);
            }
            Err(other) => return Err(other),
        }
        judge(&mut image, &mut self.pixels, true, place, self.context);
        Ok(image)
    }

    /// Returns the images.
    pub(super) fn into_images(self) -> Vec<Image> {
        self.images
    }
}

/// Checks the kind and size in the first bytes. An image that is too large is emptied before it is decoded. `is_new`:
/// whether its pixels count.
pub(super) fn judge(
    image: &mut Image,
    pixels: &mut u64,
    is_new: bool,
    place: &Place,
    context: &ImportContext<'_>,
) {
    if image.bytes.is_empty() {
        return;
    }
    let Some((mime, width, height)) = measure(&image.bytes) else {
        let text = match image.bytes.starts_with(b"\xabKTX 20\xbb") {
            true => "a KTX 2 image (KHR_texture_basisu), which is not supported; it is left empty",
            false => "neither PNG, JPEG nor WebP; the image is left empty",
        };
        context.warn(place.clone(), IMAGE_DATA_INVALID, text);
        image.bytes = Vec::new().into();
        return;
    };
    if !image.mime.is_empty() && image.mime != mime {
        context.warn(
            place.clone(),
            IMAGE_MIME_TYPE_INVALID,
            format!("the declared type is \"{}\", the actual one {mime}", image.mime),
        );
    }
    image.mime = mime.to_owned();
    (image.width, image.height) = (width, height);
    let size = if is_new { u64::from(width) * u64::from(height) } else { 0 };
    *pixels += size;
    if width > IMAGE_SIDE || height > IMAGE_SIDE || size > IMAGE_PIXELS || *pixels > IMAGES_PIXELS {
        let text = format!("{width}x{height} pixels are too many; the image is left empty");
        context.warn(place.clone(), IMAGE_TOO_LARGE, text);
        image.bytes = Vec::new().into();
        *pixels -= size;
    }
}

/// Returns the type, width and height in the header, or `None` for anything but PNG, JPEG and WebP.
pub fn measure(bytes: &[u8]) -> Option<(&'static str, u32, u32)> {
    if let Some(rest) = bytes.strip_prefix(b"\x89PNG\r\n\x1a\n") {
        let header = rest.get(4..16)?.strip_prefix(b"IHDR")?;
        let word = |at: usize| Some(u32::from_be_bytes(*header.get(at..)?.first_chunk()?));
        return Some(("image/png", word(0)?, word(4)?));
    }
    if let Some(rest) = bytes.strip_prefix(b"RIFF") {
        return measure_webp(rest.get(4..)?.strip_prefix(b"WEBP")?);
    }
    let mut rest = bytes.strip_prefix(b"\xff\xd8")?;
    loop {
        let marker = *rest.strip_prefix(b"\xff")?.first()?;
        rest = rest.get(1..)?;
        if marker == 0xff {
            continue;
        }
        let body = rest.get(1..)?;
        let length = usize::from(u16::from_be_bytes(*body.first_chunk()?));
        // Start of frame, except DHT, JPG and DAC, which are in the same range.
        if (0xc0..=0xcf).contains(&marker) && !matches!(marker, 0xc4 | 0xc8 | 0xcc) {
            let height = u16::from_be_bytes(*body.get(3..)?.first_chunk()?);
            let width = u16::from_be_bytes(*body.get(5..)?.first_chunk()?);
            return Some(("image/jpeg", u32::from(width), u32::from(height)));
        }
        rest = body.get(length.max(2)..)?;
    }
}

/// Returns the size in the first chunk of a WebP: lossy, lossless or extended.
fn measure_webp(chunk: &[u8]) -> Option<(&'static str, u32, u32)> {
    let (kind, data) = (chunk.get(..4)?, chunk.get(8..)?);
    let (width, height) = match kind {
        b"VP8 " => {
            let frame = data.get(3..)?.strip_prefix(b"\x9d\x01\x2a")?;
            let side =
                |at: usize| Some(u32::from(u16::from_le_bytes(*frame.get(at..)?.first_chunk()?) & 0x3fff));
            (side(0)?, side(2)?)
        }
        b"VP8L" => {
            let bits = u32::from_le_bytes(*data.strip_prefix(b"\x2f")?.first_chunk()?);
            ((bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1)
        }
        b"VP8X" => {
            let side = |at: usize| {
                let [low, middle, high]: [u8; 3] = *data.get(at..)?.first_chunk()?;
                Some(u32::from_le_bytes([low, middle, high, 0]) + 1)
            };
            (side(4)?, side(7)?)
        }
        _ => return None,
    };
    Some(("image/webp", width, height))
}
