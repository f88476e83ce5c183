//! Bytes to data, by the library's importers.

use super::load::{LoadError, file_name};
use super::{Cancel, Folder};
use crate::demo::DRAGONFLY_GLB;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{AssetFs, Format, Formats, ImportError, NoFiles, ReadOptions};
use std::path::Path;

/// Returns the file formats that the program knows: what it opens, saves, and lists in dialogs and help texts.
pub fn formats() -> Formats {
    Formats::builtin()
}

/// What an importer made.
pub(super) struct Imported {
    /// The data.
    pub(super) model: ModelData,
    /// The format of the file.
    pub(super) format: Format,
    /// What is not shown or was mended.
    pub(super) warnings: Vec<String>,
}

/// The model that is part of the program.
pub(super) fn built_in(progress: &dyn Fn(f32), cancel: &Cancel) -> Result<Imported, LoadError> {
    read("dragonfly.glb", DRAGONFLY_GLB, &NoFiles, progress, cancel)
}

/// The contents of the file at `path`; what it refers to is read from its folder.
pub(super) fn file(
    path: &Path,
    bytes: &[u8],
    progress: &dyn Fn(f32),
    cancel: &Cancel,
) -> Result<Imported, LoadError> {
    let title = file_name(path);
    let folder = Folder::of(path)
        .map_err(|error| LoadError::Format { title: title.clone(), reason: error.to_string() })?;
    read(&title, bytes, &folder, progress, cancel)
}

/// `bytes` of a file called `title`; what they refer to is asked of `door`.
pub(super) fn read(
    title: &str,
    bytes: &[u8],
    door: &dyn AssetFs,
    progress: &dyn Fn(f32),
    cancel: &Cancel,
) -> Result<Imported, LoadError> {
    let options = ReadOptions { is_cancelled: &|| cancel.is_cancelled(), progress, ..ReadOptions::default() };
    match formats().read(title, bytes, door, &options) {
        Ok(imported) => Ok(Imported {
            model: imported.model,
            format: imported.format,
            warnings: imported.warnings.iter().map(ToString::to_string).collect(),
        }),
        Err(ImportError::Cancelled) => Err(LoadError::Cancelled),
        Err(error) => Err(LoadError::Format { title: title.to_owned(), reason: error.to_string() }),
    }
}
