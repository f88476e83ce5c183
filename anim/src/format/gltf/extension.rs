//! Extensions: those that are read, and what becomes of the others.

use super::check as code;
use crate::format::{ImportContext, ImportError, Place};
use gltf::json;

/// Extensions that are read in full.
pub const SUPPORTED: &[&str] = &[
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Keeps the numbers of accessors elsewhere. Where an accessor has none of its own, the file needs the extension even
/// though it does not say so.
const DRACO: &str = "KHR_draco_mesh_compression";

/// Refuses what the file needs and is not read; warns of what it uses.
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
