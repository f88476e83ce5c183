//! Images: found, measured and copied as they are. Nothing is decoded here.

use super::accessor::{GltfDocument, invalid};
use super::buffer::{Fetched, fetch, is_missing};
use super::check as code;
use crate::data::Image;
use crate::format::{ImportContext, ImportError, Place};
use crate::limits::{IMAGE_PIXELS, IMAGE_SIDE, IMAGES_PIXELS};
use gltf::json;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// The images of a model, each source once, and the number in this list for each image of the file.
#[derive(Default)]
pub(super) struct Images {
    pub(super) images: Vec<Image>,
    pub(super) numbers: Vec<u32>,
}

/// Source of an image; images of a file with the same source become one.
#[derive(PartialEq, Eq, Hash)]
enum ImageSource<'a> {
    View(usize),
    Uri(&'a str),
}

/// Returns all images. One that cannot be read is left empty with a warning, since a model without textures is still
/// useful.
pub(super) fn images(document: &GltfDocument<'_>) -> Result<Images, ImportError> {
    let mut read = Images::default();
    let mut known: HashMap<ImageSource<'_>, u32> = HashMap::new();
    let mut contents: HashSet<Arc<[u8]>> = HashSet::new();
    let mut pixels = 0;
    for (index, image) in document.root.images.iter().enumerate() {
        document.context.work(1)?;
        let path = format!("/images/{index}");
        let key = match (&image.buffer_view, &image.uri) {
            (Some(view), None) => ImageSource::View(view.value()),
            (None, Some(uri)) => ImageSource::Uri(uri),
            _ => {
                let reason = "an image needs either a URI or a buffer view".to_owned();
                return Err(invalid(Place::Pointer(path), code::UNDEFINED_PROPERTY, reason));
            }
        };
        let next = read.images.len() as u32;
        let number = *known.entry(key).or_insert(next);
        if number == next {
            let mut image = read_image(document, image, &path)?;
            // Equal bytes are shared, and decoded once: their pixels count once.
            let known = contents.get(&image.bytes[..]).map(Arc::clone);
            let before = pixels;
            judge(&mut image, &mut pixels, known.is_none(), &path, document.context);
            match known.filter(|_| !image.bytes.is_empty()) {
                Some(known) => image.bytes = known,
                None if pixels > before => _ = contents.insert(Arc::clone(&image.bytes)),
                None => {}
            }
            document.context.charge(&Place::Pointer(path), 4 * size_of::<Image>() as u64)?;
            read.images.push(image);
        }
        read.numbers.push(number);
    }
    Ok(read)
}

fn read_image(document: &GltfDocument<'_>, image: &json::Image, path: &str) -> Result<Image, ImportError> {
    let declared = image.mime_type.as_ref().map(|mime| mime.0.clone()).unwrap_or_default();
    let name = image.name.clone().unwrap_or_default();
    let mut read = Image { name, mime: declared, ..Image::default() };
    if let Some(view) = image.buffer_view {
        let from = format!("{path}/bufferView");
        match document.view(view, &from) {
            Ok((bytes, _)) => {
                document.context.charge(&Place::Pointer(from), bytes.len() as u64)?;
                read.bytes = bytes.into();
            }
            Err(error) if is_missing(&error) => {
                let text = format!("{error}; the image is left empty");
                document.context.warn(Place::Pointer(from), code::IMAGE_DATA_INVALID, text);
            }
            Err(other) => return Err(other),
        }
    } else if let Some(uri) = &image.uri {
        let place = Place::Pointer(format!("{path}/uri"));
        match fetch(uri, &place, document.context) {
            Ok(Fetched { bytes, mime, path }) => {
                (read.bytes, read.file_name) = (bytes, path);
                if read.mime.is_empty() {
                    read.mime = mime;
                }
            }
            Err(ImportError::External { uri, reason, .. }) => {
                let text = format!("\"{uri}\": {reason}; the image is left empty");
                document.context.warn(place, code::IMAGE_DATA_INVALID, text);
            }
            Err(other) => return Err(other),
        }
    }
    Ok(read)
}

/// Checks the kind and size in the first bytes. An image that is too large is emptied before it is decoded. `is_new`:
/// whether its pixels count.
fn judge(image: &mut Image, pixels: &mut u64, is_new: bool, path: &str, context: &ImportContext<'_>) {
    if image.bytes.is_empty() {
        return;
    }
    let place = || Place::Pointer(path.to_owned());
    let Some((mime, width, height)) = measure(&image.bytes) else {
        context.warn(place(), code::IMAGE_DATA_INVALID, "neither PNG nor JPEG; the image is left empty");
        image.bytes = Vec::new().into();
        return;
    };
    if !image.mime.is_empty() && image.mime != mime {
        context.warn(
            place(),
            code::IMAGE_MIME_TYPE_INVALID,
            format!("the declared type is \"{}\", the actual one {mime}", image.mime),
        );
    }
    image.mime = mime.to_owned();
    (image.width, image.height) = (width, height);
    let size = if is_new { u64::from(width) * u64::from(height) } else { 0 };
    *pixels += size;
    if width > IMAGE_SIDE || height > IMAGE_SIDE || size > IMAGE_PIXELS || *pixels > IMAGES_PIXELS {
        let text = format!("{width}x{height} pixels are too many; the image is left empty");
        context.warn(place(), code::IMAGE_TOO_LARGE, text);
        image.bytes = Vec::new().into();
        *pixels -= size;
    }
}

/// Returns the type, width and height in the header, or `None` for anything but PNG and JPEG.
pub fn measure(bytes: &[u8]) -> Option<(&'static str, u32, u32)> {
    if let Some(rest) = bytes.strip_prefix(b"\x89PNG\r\n\x1a\n") {
        let header = rest.get(4..16)?.strip_prefix(b"IHDR")?;
        let word = |at: usize| Some(u32::from_be_bytes(*header.get(at..)?.first_chunk()?));
        return Some(("image/png", word(0)?, word(4)?));
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
