//! Bytes to data, by the library's importers.

use super::folder::Folder;
use super::load::{LoadError, Source};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{AssetFs, NoFiles, ReadOptions, read};
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
    import("dragonfly.glb", &source.title(), crate::demo::DRAGONFLY_GLB, &NoFiles)
}

/// The contents of the file at `path`; what it refers to is read from its folder.
pub(super) fn file(path: &Path, bytes: &[u8]) -> Result<Imported, LoadError> {
    let name = super::load::file_name(path);
    match Folder::of(path) {
        Ok(folder) => import(&name, &name, bytes, &folder),
        // The folder went away after the file was read: what stands alone can still be opened.
        Err(_) => import(&name, &name, bytes, &NoFiles),
    }
}

fn import(name: &str, title: &str, bytes: &[u8], door: &dyn AssetFs) -> Result<Imported, LoadError> {
    let imported = read(name, bytes, door, &ReadOptions::default())
        .map_err(|error| LoadError::Format { title: title.to_owned(), reason: error.to_string() })?;
    Ok(Imported {
        model: imported.model,
        format: imported.format.to_owned(),
        warnings: imported.warnings.iter().map(ToString::to_string).collect(),
    })
}
