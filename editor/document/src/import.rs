//! Imports the bytes of a model with the importers of the library.

use super::Cancel;
use super::source::LoadError;
use crate::demo::DRAGONFLY_GLB;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{
    AssetFs, Conventions, Conversion, Format, Formats, ImportError, NoFiles, ReadOptions, TABLES,
};
use dragonfly_fbx::FBX;

/// Returns the file formats that the program knows: what it opens, saves, and lists in dialogs and help texts.
pub fn formats() -> Formats {
    Formats::builtin().with(FBX)
}

/// Returns the formats in which the program writes new files: those that it knows, and tables for other programs.
pub fn written_formats() -> Vec<Format> {
    let formats = formats();
    formats.iter().chain(TABLES).filter(|format| format.export.is_some()).copied().collect()
}

/// Returns the format in which files with this extension are written, given without the dot and in any case.
pub fn written_format(extension: &str) -> Option<Format> {
    written_formats().into_iter().find(|format| format.has_extension(extension))
}

/// An imported model.
pub(super) struct ImportedModel {
    /// The data.
    pub(super) model: ModelData,
    /// The format of the file.
    pub(super) format: Format,
    /// Units, axes and frame rate of the file, as they were converted.
    pub(super) conversion: Conversion,
    /// Contents that are not shown or were sanitized.
    pub(super) warnings: Vec<String>,
    /// Findings that change neither the picture nor the animation, one sentence each.
    pub(super) notes: Vec<String>,
    /// Bytes of the memory budget that the import left.
    pub(super) memory: u64,
}

/// Imports the built-in model.
pub(super) fn built_in(progress: &dyn Fn(f32), cancel: &Cancel) -> Result<ImportedModel, LoadError> {
    let files = ImportDoor { files: &NoFiles, conventions: Conventions::default() };
    read("dragonfly.glb", DRAGONFLY_GLB, files, progress, cancel)
}

/// The files next to a model, and the conventions that the user chose for it.
#[derive(Clone, Copy)]
pub(super) struct ImportDoor<'a> {
    /// The files.
    pub(super) files: &'a dyn AssetFs,
    /// Units, axes and frame rate.
    pub(super) conventions: Conventions,
}

/// Imports `bytes` of a file called `title`. Files that it refers to are read through `door`.
pub(super) fn read(
    title: &str,
    bytes: &[u8],
    door: ImportDoor<'_>,
    progress: &dyn Fn(f32),
    cancel: &Cancel,
) -> Result<ImportedModel, LoadError> {
    let options = ReadOptions {
        is_cancelled: &|| cancel.is_cancelled(),
        progress,
        conventions: door.conventions,
        ..ReadOptions::default()
    };
    match formats().read(title, bytes, door.files, &options) {
        Ok(imported) => {
            let (notes, warnings): (Vec<_>, Vec<_>) =
                imported.warnings.iter().partition(|warning| warning.is_harmless());
            Ok(ImportedModel {
                model: imported.model,
                format: imported.format,
                conversion: imported.conversion,
                warnings: warnings.iter().map(ToString::to_string).collect(),
                notes: notes.iter().map(ToString::to_string).collect(),
                memory: options.budget.remaining(),
            })
        }
        Err(ImportError::Cancelled) => Err(LoadError::Cancelled),
        Err(error) => Err(LoadError::Format { title: title.to_owned(), reason: error.to_string() }),
    }
}
