//! Supported extensions, and the handling of all others.

use super::check as code;
use crate::format::{ImportContext, ImportError, Place};
use gltf::json;

/// Extensions that are supported completely.
pub const SUPPORTED: &[&str] = &[
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Stores the data of accessors elsewhere. A file with accessors that have no data of their own needs this extension
/// even if it does not list it as required.
const DRACO: &str = "KHR_draco_mesh_compression";

/// Refuses required extensions that are not supported; adds a warning for each other unsupported extension.
pub(super) fn check(root: &json::Root, context: &ImportContext<'_>) -> Result<(), ImportError> {
    for (index, name) in root.extensions_required.iter().enumerate() {
        context.work(1)?;
        if !SUPPORTED.contains(&name.as_str()) {
            let place = Place::Pointer(format!("/extensionsRequired/{index}"));
            return Err(ImportError::Unsupported { place, feature: format!("the extension {name}") });
        }
    }
    for (index, name) in root.extensions_used.iter().enumerate() {
        context.work(1)?;
        if name == DRACO && root.accessors.iter().any(|a| a.buffer_view.is_none() && a.sparse.is_none()) {
            let place = Place::Pointer(format!("/extensionsUsed/{index}"));
            return Err(ImportError::Unsupported { place, feature: format!("the extension {name}") });
        }
        if !SUPPORTED.contains(&name.as_str()) {
            let place = Place::Pointer(format!("/extensionsUsed/{index}"));
            let what = if name == "KHR_lights_punctual" { "the file's lights" } else { name };
            context.warn(place, code::UNSUPPORTED_EXTENSION, format!("{what} is not shown"));
        }
    }
    Ok(())
}
