//! Images of a model: found, measured and copied as they are. Nothing is decoded here.

use super::image_kind::measure_image;
use super::uri::plain_reference;
use super::{ImportContext, ImportError, Place};
use crate::data::{Filter, Wrap};
use crate::data::{Image, TextureRef, TextureTransform};
use crate::limits::{IMAGE_PIXELS, IMAGE_SIDE, IMAGES_PIXELS};
use std::collections::HashMap;

/// An image cannot be read, or is of no kind of [`IMAGE_KINDS`](super::image_kind::IMAGE_KINDS).
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
    let Some((mime, width, height)) = measure_image(&image.bytes) else {
        let text = "neither PNG, JPEG, WebP nor KTX 2 with Basis Universal; the image is left empty";
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
