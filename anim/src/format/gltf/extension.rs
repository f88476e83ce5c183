//! Supported extensions, and the handling of all others.

use super::{avatar, check as code, draco};
use crate::format::{IMAGE_KINDS, ImportContext, ImportError, Place};
use gltf::json;

/// Extensions whose content is read, in addition to those of [`IMAGE_KINDS`].
const SUPPORTED: &[&str] = &[
    draco::NAME,
    "EXT_meshopt_compression",
    "KHR_animation_pointer",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_texture_transform",
    avatar::VRM_0,
    avatar::VRM_1,
    avatar::VRM_ANIMATION,
];

/// Returns whether the content of an extension of glTF is read, as far as a model has room for it.
pub fn supports_extension(name: &str) -> bool {
    SUPPORTED.contains(&name) || IMAGE_KINDS.iter().any(|kind| kind.gltf_extension == Some(name))
}

/// Refuses required extensions that are not supported; adds a warning for each other unsupported extension.
pub(super) fn check(root: &json::Root, context: &ImportContext<'_>) -> Result<(), ImportError> {
    for (index, name) in root.extensions_required.iter().enumerate() {
        context.work(1)?;
        if !supports_extension(name) {
            let place = Place::Pointer(format!("/extensionsRequired/{index}"));
            return Err(unsupported(place, name));
        }
    }
    for (index, name) in root.extensions_used.iter().enumerate() {
        context.work(1)?;
        if !supports_extension(name) {
            let place = Place::Pointer(format!("/extensionsUsed/{index}"));
            let text = match name.as_str() {
                "KHR_lights_punctual" => "the file's lights are not shown".to_owned(),
                _ => format!("{name} is not shown"),
            };
            context.warn(place, code::UNSUPPORTED_EXTENSION, text);
        }
    }
    Ok(())
}

fn unsupported(place: Place, name: &str) -> ImportError {
    ImportError::Unsupported { place, feature: format!("the extension {name}") }
}
