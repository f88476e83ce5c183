//! Conversion of a model file into a new file of any format that is written.

use super::bone_map::BoneMap;
use super::import::{formats, written_format, written_formats};
use super::new_folders::ensure_folder;
use super::source::{LoadError, file_name};
use super::{Cancel, Folder, make_folder, read_file};
use dragonfly_anim::bake::baked;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::obj::{OBJ, write_sequence};
use dragonfly_anim::format::{
    Conventions, Conversion, ExportError, Format, ImportError, NoFiles, ReadOptions, SavePlan,
};
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_fbx::{ExportPreset, FBX, FbxOptions, PRESETS, TexturePlacement, export_with};
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
    /// Bones of the input that get other names.
    pub renames: Option<Arc<BoneMap>>,
    /// Name of the preset of the format, see [`export`].
    pub preset: Option<String>,
    /// Place of the images, for formats that leave the choice, see [`places_textures`].
    pub textures: Option<TexturePlacement>,
    /// Frames per second of keys that replace those of the takes, see [`baked`]; for OBJ, of the files, see [`write_sequence`].
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
    /// Names and sizes of the files that it refers to, which are written next to it.
    pub beside: Vec<(String, usize)>,
    /// Units, axes and frame rate of the input, and where they are known from.
    pub conversion: Conversion,
    /// Content of the input that was corrected or not read, one sentence each.
    pub warnings: Vec<String>,
    /// Content that the new format cannot represent, one sentence each.
    pub lost: Vec<String>,
    /// Number of takes.
    pub takes: usize,
}

/// A file that was converted and is not yet written.
#[derive(Debug)]
pub struct PreparedConversion {
    output: PathBuf,
    is_written: bool,
    plan: SavePlan,
    converted: ConvertedFile,
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

/// Returns whether files of a format can contain their images or have them as files next to them.
pub fn places_textures(format: &Format) -> bool {
    *format == FBX
}

/// Writes a model as a new file called `name`, with the preset of the format that has this name, and with its images at the place
/// `textures`.
///
/// # Errors
///
/// Files of the format are not written, the format has no such preset or no choice of this kind, or it cannot represent the model.
pub fn export(
    format: &Format,
    model: &ModelData,
    name: &str,
    preset: Option<&str>,
    textures: Option<TexturePlacement>,
) -> Result<SavePlan, ExportError> {
    if preset.is_none() && textures.is_none() {
        let write = format.export.ok_or_else(|| ExportError::new("files of this kind cannot be written"))?;
        return write(model, name);
    }
    let preset = preset.map(|wanted| checked_preset(format, wanted)).transpose().map_err(ExportError::new)?;
    let textures = textures.map(|wanted| checked_textures(format, wanted)).transpose();
    let textures = textures.map_err(ExportError::new)?.unwrap_or_default();
    export_with(model, name, &FbxOptions { preset, textures })
}

/// Plans the file `name` with a model, with the preset, the place of images and the keys that were chosen. If there are frames per
/// second, each frame of a take gets a key; a file of OBJ has one pose, so that the frames of the first take are files.
pub(super) fn planned(
    format: &Format,
    mut model: ModelData,
    name: &str,
    (preset, textures, bake): (Option<&str>, Option<TexturePlacement>, Option<f32>),
) -> Result<SavePlan, String> {
    let plan = match bake {
        Some(rate) if *format == OBJ => write_sequence(&model, name, rate),
        Some(rate) => {
            for take in &mut model.animation.takes {
                let keys = baked(take, rate).map_err(|error| format!("take {:?}: {error}", take.name))?;
                *take = Arc::new(keys);
            }
            export(format, &model, name, preset, textures)
        }
        None => export(format, &model, name, preset, textures),
    };
    plan.map_err(|error| error.to_string())
}

/// Returns the placement, if the format leaves the choice.
///
/// # Errors
///
/// A text that names what files of the format do.
pub fn checked_textures(format: &Format, wanted: TexturePlacement) -> Result<TexturePlacement, String> {
    if places_textures(format) {
        return Ok(wanted);
    }
    Err(format!(
        "the place of textures can be chosen in .{} files only, not in .{}",
        FBX.extension(),
        format.extension()
    ))
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

/// Reads a file and converts it, but writes nothing yet. Textures are read only from the folder of the file.
///
/// # Errors
///
/// The input cannot be read, or the new format cannot represent it; see [`ConversionError`].
pub fn prepare_conversion(
    order: &ConversionOrder,
    cancel: &Cancel,
) -> Result<PreparedConversion, ConversionError> {
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
    let mut warnings: Vec<String> = imported.warnings.iter().map(ToString::to_string).collect();
    if let Some(renames) = &order.renames {
        let skeleton = Arc::make_mut(&mut imported.model.animation.skeleton);
        let missing = renames.rename(skeleton).map_err(failed)?;
        warnings.extend(
            missing.into_iter().map(|name| format!("the map names {name:?}, which is no bone of it")),
        );
    }
    let takes = imported.model.animation.takes.len();
    let choices = (order.preset.as_deref(), order.textures, order.bake);
    let plan = planned(&target, imported.model, &name, choices).map_err(failed)?;
    let (main, beside) =
        plan.files.split_last().map_or((None, &[][..]), |(main, beside)| (Some(main), beside));
    let converted = ConvertedFile {
        from: imported.format.name,
        bytes: main.map_or(0, |file| file.bytes.len()),
        beside: beside.iter().map(|file| (file.name.clone(), file.bytes.len())).collect(),
        conversion: imported.conversion,
        warnings,
        lost: plan.lost.iter().map(ToString::to_string).collect(),
        takes,
    };
    Ok(PreparedConversion { output: order.output.clone(), is_written: order.is_written, plan, converted })
}

impl PreparedConversion {
    /// Returns the size of all files to write, in bytes.
    pub fn bytes(&self) -> usize {
        self.plan.files.iter().map(|file| file.bytes.len()).sum()
    }

    /// Writes the files, unless the order was only to find out what would be lost.
    ///
    /// # Errors
    ///
    /// The path and the reason.
    pub fn write(self) -> Result<ConvertedFile, ConversionError> {
        if self.is_written {
            write_files(&self.output, &self.plan)?;
        }
        Ok(self.converted)
    }
}

/// Writes the files of a plan next to `output`, the main file last. Each is replaced atomically.
///
/// # Errors
///
/// The path and the reason.
pub fn write_files(output: &Path, plan: &SavePlan) -> Result<(), ConversionError> {
    let folder = folder_of(output);
    let wrong = |reason: String| ConversionError::Write(reason);
    ensure_folder(output).map_err(wrong)?;
    let Some((main, beside)) = plan.files.split_last() else { return Ok(()) };
    for file in beside {
        let path = folder.join(&file.name);
        make_folder(&path).map_err(wrong)?;
        replace(&path, &file.bytes).map_err(|error| wrong(error.to_string()))?;
    }
    replace(output, &main.bytes).map(drop).map_err(|error| wrong(error.to_string()))
}
