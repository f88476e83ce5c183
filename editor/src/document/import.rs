//! Bytes to data, by the library's importers.

use super::load::{LoadError, Source};
use dragonfly_anim::data::ModelData;
use std::path::Path;

/// What an importer made.
pub(super) struct Imported {
    /// The data.
    pub(super) model: ModelData,
    /// "glb", "gltf".
    pub(super) format: String,
    /// What is not shown or was mended.
    pub(super) warnings: Vec<String>,
}

/// The model that is part of the program.
pub(super) fn built_in(source: &Source) -> Result<Imported, LoadError> {
    Err(LoadError::Format {
        title: source.title(),
        reason: "the importer is not part of this build".to_owned(),
    })
}

/// The contents of the file at `path`; what it refers to is read from its folder.
pub(super) fn file(path: &Path, _bytes: &[u8]) -> Result<Imported, LoadError> {
    Err(LoadError::Format {
        title: super::load::file_name(path),
        reason: "the importer is not part of this build".to_owned(),
    })
}
