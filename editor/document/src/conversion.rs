//! Conversion of a model file into a new file of any format that is written.

use super::import::{formats, written_format, written_formats};
use super::source::{LoadError, file_name};
use super::{Cancel, Folder, make_folder, read_file};
use dragonfly_anim::bake::baked;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{
    Conventions, Conversion, ExportError, Format, ImportError, NoFiles, ReadOptions, SavePlan,
};
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_fbx::{ExportPreset, FBX, PRESETS, export_with};
use dragonfly_store::{folder_of, replace};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use thiserror::Error;

/// A file to convert. The extension of `output` determines the format that is written.
#[derive(Clone, Debug, PartialEq)]
pub struct ConversionOrder {
    /// The file to read.
    pub input: PathBuf,
    /// The file to write; it is replaced atomically.
    pub output: PathBuf,
    /// Units, axes and frame rate of the input that the user chose.
    pub conventions: Conventions,
    /// Name of the preset of the format, see [`export`].
    pub preset: Option<String>,
    /// Frames per second of keys that replace those of the takes, see [`baked`].
    pub bake: Option<f32>,
    /// Whether to write the file, or only to find out what would be lost.
    pub is_written: bool,
}

/// A file that was converted.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvertedFile {
    /// Name of the format that was read.
    pub from: &'static str,
    /// Size of the new file in bytes.
    pub bytes: usize,
    /// Units, axes and frame rate of the input, and where they are known from.
    pub conversion: Conversion,
    /// Content of the input that was corrected or not read, one sentence each.
    pub warnings: Vec<String>,
    /// Content that the new format cannot represent, one sentence each.
    pub lost: Vec<String>,
    /// Number of takes.
    pub takes: usize,
}

/// The reason why a file was not converted. Nothing was written.
#[derive(Debug, Error)]
pub enum ConversionError {
    /// The input cannot be read.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// The extension of the output is not one of a format that is written.
    #[error("{}: files of this kind cannot be written; use {formats}", path.display())]
    NotWritable {
        /// The output.
        path: PathBuf,
        /// Extensions of the formats that are written.
        formats: String,
    },
    /// The format cannot represent the model.
    #[error("{title}: {reason}")]
    Export {
        /// Name of the input.
        title: String,
        /// Place and reason.
        reason: String,
    },
    /// The file cannot be written.
    #[error("{0}")]
    Write(String),
}

/// Returns the presets of a format: what other programs expect of its files.
pub fn export_presets(format: &Format) -> &'static [ExportPreset] {
    if *format == FBX { PRESETS } else { &[] }
}

/// Writes a model as a new file called `name`, with the preset of the format that has this name.
///
/// # Errors
///
/// Files of the format are not written, the format has no such preset, or it cannot represent the model.
pub fn export(
    format: &Format,
    model: &ModelData,
    name: &str,
    preset: Option<&str>,
) -> Result<SavePlan, ExportError> {
    let Some(wanted) = preset else {
        let write = format.export.ok_or_else(|| ExportError::new("files of this kind cannot be written"))?;
        return write(model, name);
    };
    let found = checked_preset(format, wanted).map_err(ExportError::new)?;
    export_with(model, name, Some(found))
}

/// Returns the preset of a format that has this name.
///
/// # Errors
///
/// A text that lists the presets of the format.
pub fn checked_preset(format: &Format, name: &str) -> Result<&'static ExportPreset, String> {
    let presets = export_presets(format);
    let known = || presets.iter().map(ExportPreset::name).collect::<Vec<_>>().join(", ");
    match presets.iter().find(|preset| preset.name() == name) {
        Some(found) => Ok(found),
        None if presets.is_empty() => Err(format!(".{} files have no presets", format.extension())),
        None => Err(format!("\"{name}\" is not a preset of .{} files; use {}", format.extension(), known())),
    }
}

/// Returns the extensions of the formats that are written, with their dots.
pub fn written_extensions() -> String {
    let written = written_formats();
    written.iter().map(|format| format!(".{}", format.extension())).collect::<Vec<_>>().join(", ")
}

/// Reads a file and writes it in another format. Textures are read only from the folder of the file.
///
/// # Errors
///
/// The input cannot be read, or the output cannot be written; see [`ConversionError`].
pub fn convert(order: &ConversionOrder, cancel: &Cancel) -> Result<ConvertedFile, ConversionError> {
    let title = file_name(&order.input);
    let formats = formats();
    let target = order.output.extension().and_then(|extension| written_format(extension.to_str()?));
    let target = target.ok_or_else(|| ConversionError::NotWritable {
        path: order.output.clone(),
        formats: written_extensions(),
    })?;
    let bytes = read_file(&order.input, FILE_BYTES)
        .map_err(|reason| LoadError::File { path: order.input.clone(), reason })?;
    let options = ReadOptions {
        is_cancelled: &|| cancel.is_cancelled(),
        conventions: order.conventions,
        ..ReadOptions::default()
    };
    let imported = match Folder::of(&order.input) {
        Ok(folder) => formats.read(&title, &bytes, &folder, &options),
        Err(_) => formats.read(&title, &bytes, &NoFiles, &options),
    };
    let mut imported = imported.map_err(|error| match error {
        ImportError::Cancelled => LoadError::Cancelled,
        error => LoadError::Format { title: title.clone(), reason: error.to_string() },
    })?;
    drop(bytes);
    let name = file_name(&order.output);
    let failed = |reason: String| ConversionError::Export { title: title.clone(), reason };
    if let Some(rate) = order.bake {
        for take in &mut imported.model.animation.takes {
            *take = Arc::new(
                baked(take, rate).map_err(|error| failed(format!("take {:?}: {error}", take.name)))?,
            );
        }
    }
    let plan = export(&target, &imported.model, &name, order.preset.as_deref())
        .map_err(|error| failed(error.to_string()))?;
    if order.is_written {
        write_files(&order.output, &plan)?;
    }
    Ok(ConvertedFile {
        from: imported.format.name,
        bytes: plan.files.last().map_or(0, |file| file.bytes.len()),
        conversion: imported.conversion,
        warnings: imported.warnings.iter().map(ToString::to_string).collect(),
        lost: plan.lost.iter().map(ToString::to_string).collect(),
        takes: imported.model.animation.takes.len(),
    })
}

/// Writes the files of a plan next to `output`, the main file last. Each is replaced atomically.
///
/// # Errors
///
/// The path and the reason.
pub fn write_files(output: &Path, plan: &SavePlan) -> Result<(), ConversionError> {
    let folder = folder_of(output);
    if !folder.is_dir() {
        return Err(ConversionError::Write(format!("{}: its folder does not exist", output.display())));
    }
    let wrong = |reason: String| ConversionError::Write(reason);
    let Some((main, beside)) = plan.files.split_last() else { return Ok(()) };
    for file in beside {
        let path = folder.join(&file.name);
        make_folder(&path).map_err(wrong)?;
        replace(&path, &file.bytes).map_err(|error| wrong(error.to_string()))?;
    }
    replace(output, &main.bytes).map(drop).map_err(|error| wrong(error.to_string()))
}
