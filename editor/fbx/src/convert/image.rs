//! Images: those in the file are copied as they are, others are named.

use crate::code::FBX_TEXTURE;
use crate::textures::{ExternalTexture, accept, names};
use dragonfly_anim::data::Image;
use dragonfly_anim::format::{ImportContext, ImportError, Place};

/// Images, textures to open, and the image of each texture file of the scene.
type ReadImages = (Vec<Image>, Vec<ExternalTexture>, Vec<u32>);

/// Returns one image for each texture file.
pub(super) fn images(scene: &ufbx::Scene, context: &ImportContext<'_>) -> Result<ReadImages, ImportError> {
    let place = Place::Pointer("/images".to_owned());
    let count = scene.texture_files.len();
    let mut images = context.vec(&place, count)?;
    let mut numbers = context.vec(&place, count)?;
    let mut textures = Vec::new();
    let mut pixels = 0;
    for (index, file) in scene.texture_files.iter().enumerate() {
        context.work(1)?;
        let place = Place::Pointer(format!("/images/{index}"));
        let names = names(&[&file.relative_filename, &file.filename, &file.absolute_filename]);
        context.charge(&place, names.iter().map(|name| 2 * name.len() as u64 + 64).sum())?;
        let mut image = Image { name: names.last().cloned().unwrap_or_default(), ..Image::default() };
        if file.content.is_empty() {
            textures.push(ExternalTexture { image: index as u32, names });
        } else {
            match accept(&file.content, pixels) {
                Ok((mime, width, height)) => {
                    pixels += u64::from(width) * u64::from(height);
                    context.charge(&place, file.content.len() as u64)?;
                    let bytes = file.content[..].into();
                    image = Image { mime: mime.to_owned(), bytes, width, height, ..image };
                }
                Err(reason) => {
                    context.warn(
                        place,
                        FBX_TEXTURE,
                        format!("{}: {reason}; the image is left empty", image.name),
                    );
                }
            }
        }
        images.push(image);
        numbers.push(index as u32);
    }
    Ok((images, textures, numbers))
}
