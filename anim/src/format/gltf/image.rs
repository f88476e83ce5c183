//! Images: found, measured and copied as they are. Nothing is decoded here.

use super::accessor::{GltfDocument, invalid};
use super::buffer::{Fetched, fetch, is_missing};
use super::check as code;
use crate::data::Image;
use crate::format::image::judge;
use crate::format::{ImportError, Place};
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
            let place = Place::Pointer(path.clone());
            // Equal bytes are shared, and decoded once: their pixels count once.
            let known = contents.get(&image.bytes[..]).map(Arc::clone);
            let before = pixels;
            judge(&mut image, &mut pixels, known.is_none(), &place, document.context);
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
