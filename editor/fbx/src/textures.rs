//! Textures in files of their own: named by the child, opened by the parent.

use crate::code::FBX_TEXTURE;
use dragonfly_anim::data::Image;
use dragonfly_anim::format::gltf::measure_image;
use dragonfly_anim::format::{ImportContext, ImportError, Place};
use dragonfly_anim::limits::{IMAGE_PIXELS, IMAGE_SIDE, IMAGES_PIXELS};
use percent_encoding::{AsciiSet, CONTROLS, utf8_percent_encode};
use serde::{Deserialize, Serialize};

/// Characters of a file name that mean something else in a reference.
const ENCODED: &AsciiSet = &CONTROLS.add(b'%').add(b'?').add(b'#').add(b' ');

/// Largest number of names under which one texture is looked for.
const NAMES: usize = 4;

/// A texture that is not in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ExternalTexture {
    /// Position of its image in the model.
    pub(crate) image: u32,
    /// Relative paths to try, in this order, with `/` between the parts.
    pub(crate) names: Vec<String>,
}

/// Returns the relative paths for the paths in a file: as written, then the name alone, since most files contain the path on
/// the machine of their author.
pub(crate) fn names(paths: &[&str]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let plain = paths.iter().map(|path| path.replace('\\', "/"));
    let plain: Vec<String> = plain.filter(|path| !path.is_empty()).collect();
    let relative = plain.iter().filter(|path| !path.starts_with('/') && !path.contains(':'));
    let alone = plain.iter().filter_map(|path| path.rsplit('/').next());
    for name in relative.map(String::as_str).chain(alone) {
        if names.len() < NAMES && !name.is_empty() && !names.iter().any(|known| known == name) {
            names.push(name.to_owned());
        }
    }
    names
}

/// Fills the images of external textures. One that cannot be read stays empty, with a warning.
pub(crate) fn open(
    images: &mut [Image],
    textures: &[ExternalTexture],
    context: &ImportContext<'_>,
) -> Result<(), ImportError> {
    let mut pixels: u64 = images.iter().map(|image| u64::from(image.width) * u64::from(image.height)).sum();
    for texture in textures {
        context.work(1)?;
        let Some(image) = images.get_mut(texture.image as usize) else { continue };
        let place = Place::Pointer(format!("/images/{}", texture.image));
        let mut failure = "the name is empty".to_owned();
        for name in texture.names.iter().take(NAMES) {
            let uri = utf8_percent_encode(name, ENCODED).to_string();
            match context.read_neighbor(&uri, &place) {
                Ok(bytes) => {
                    failure = match accept(&bytes, pixels) {
                        Ok((mime, width, height)) => {
                            pixels += u64::from(width) * u64::from(height);
                            *image = Image {
                                name: std::mem::take(&mut image.name),
                                file_name: Some(name.clone()),
                                mime: mime.to_owned(),
                                bytes,
                                width,
                                height,
                            };
                            String::new()
                        }
                        Err(reason) => reason,
                    };
                    break;
                }
                Err(ImportError::External { uri, reason, .. }) => failure = format!("\"{uri}\": {reason}"),
                Err(other) => return Err(other),
            }
        }
        if !failure.is_empty() {
            context.warn(place, FBX_TEXTURE, format!("{failure}; the image is left empty"));
        }
    }
    Ok(())
}

/// Returns type, width and height of an image that a model may contain in addition to images of `pixels`.
pub(crate) fn accept(bytes: &[u8], pixels: u64) -> Result<(&'static str, u32, u32), String> {
    let (mime, width, height) = measure_image(bytes).ok_or("neither PNG, JPEG, WebP nor KTX 2")?;
    let own = u64::from(width) * u64::from(height);
    if width > IMAGE_SIDE || height > IMAGE_SIDE || own > IMAGE_PIXELS || pixels + own > IMAGES_PIXELS {
        return Err(format!("{width}x{height} pixels are too many"));
    }
    Ok((mime, width, height))
}
