#![doc = include_str!("layout.md")]

mod bone;
pub mod code;
mod container;
mod image;
mod keys;
mod material;
mod mesh;
mod morph;
mod part;
mod reader;
mod record;
mod scene;
mod take;
mod vertex;
mod writer;

use super::{
    ByteBudget, ExportError, Format, ImportContext, ImportError, NoFiles, Place, ReadOptions, WholeFile,
    WriteSupport,
};
use crate::data::{AnimationData, ModelData};
use reader::DfmReader;
use std::sync::Arc;
use thiserror::Error;
use writer::DfmWriter;

/// Major and minor version that is written. Files of another major version are refused. Files of a newer minor version
/// are read, with a warning, without the content that this version does not know.
pub const VERSION: (u16, u16) = (1, 0);

/// Tag before the directory of the parts.
const DIRECTORY_TAG: [u8; 4] = *b"SUMS";

/// Last four bytes of every file.
const ENDING_MAGIC: [u8; 4] = *b"dfm\x1a";

/// The thesis's serialization, extended by everything else that this library's models contain.
pub const DFM: Format = Format {
    name: "dfm",
    title: "Dragonfly model",
    extensions: &["dfm"],
    sniff: looks_like_dfm,
    read: import,
    write: WriteSupport::Whole(export),
};

/// Reason why a model could not be written. Displayed as `place: reason`, on one line.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WriteError {
    /// A part of the model breaks the invariants of its type, so that reading would not restore it.
    #[error("{place}: {}", super::error::one_line(reason))]
    Invalid {
        /// Place in the model, such as `/meshes/0/primitives/1`.
        place: String,
        /// Description of the error, with the numbers.
        reason: String,
    },
    /// The reader refuses an index or another number of the model; its place is in the file that would have been
    /// written.
    #[error("the model cannot be read back: {0}")]
    Refused(#[from] ImportError),
    /// The file would be longer than its first four bytes can represent.
    #[error("file: {bytes} bytes, at most {}", u32::MAX)]
    TooLarge {
        /// Number of bytes of the whole file.
        bytes: u64,
    },
}

/// Returns the bytes of a `.dfm` file that contains `model`.
///
/// [`read`] returns the same model, every float bit for bit, including NaN; this function verifies that the written
/// file can be read. Refused are models that break the invariants of their types (columns of different lengths, an
/// index out of range, not exactly one track per bone), and models that need 4 GiB or more.
pub fn write(model: &ModelData) -> Result<Vec<u8>, WriteError> {
    let mut writer = DfmWriter::new();
    writer.text(&model.name);
    image::write(model, &mut writer)?;
    material::write(model, &mut writer);
    bone::write(model, &mut writer);
    scene::write_skins(model, &mut writer)?;
    mesh::write(model, &mut writer)?;
    scene::write_instances(model, &mut writer)?;
    take::write(model, &mut writer)?;
    let bytes = writer.finish()?;
    read(&bytes)?;
    Ok(bytes)
}

/// Returns the model in a `.dfm` file, every float bit for bit as it was written.
///
/// Refused are files that are truncated, damaged, of another major version, or inconsistent; the error contains the
/// offset. Allocates at most 256 MiB plus 32 times the bytes of the file; usually two or three times.
/// [`format::read`](super::read) also refuses numbers that are not finite, key times that do not increase, and files
/// that exceed the [limits](crate::limits) of importers.
pub fn read(bytes: &[u8]) -> Result<ModelData, ImportError> {
    let options = ReadOptions { budget: ByteBudget::at_most(u64::MAX), ..ReadOptions::default() };
    options.budget.input(bytes.len());
    read_model(bytes, &ImportContext::new(&NoFiles, &options), false)
}

/// Reads as an importer: the result has the properties that every imported model has.
fn import(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    read_model(bytes, context, true)
}

/// Writes the whole file; the format represents everything that a model contains.
fn export(model: &ModelData) -> Result<WholeFile, ExportError> {
    Ok(WholeFile { bytes: write(model)?, lost: Vec::new() })
}

impl From<WriteError> for ExportError {
    fn from(error: WriteError) -> Self {
        Self::new(error)
    }
}

/// Detects the size of a vertex, at byte 8, or the ending.
fn looks_like_dfm(bytes: &[u8]) -> bool {
    let size = (part::DfmPart::Vertices.layout().size as u32).to_le_bytes();
    let begins = bytes.get(8..12) == Some(&size) && !bytes.starts_with(b"glTF");
    let total = (bytes.len() as u64).to_le_bytes();
    begins || (bytes.ends_with(&ENDING_MAGIC) && bytes.starts_with(&total[..4]))
}

fn read_model(bytes: &[u8], context: &ImportContext<'_>, strict: bool) -> Result<ModelData, ImportError> {
    let mut reader = DfmReader::new(bytes, context, strict)?;
    context.progress(0.2)?;
    let name = reader.text()?;
    let images = image::read(&mut reader)?;
    let materials = material::read(&mut reader)?;
    let skeleton = bone::read(&mut reader)?;
    let skins = scene::read_skins(&mut reader)?;
    context.progress(0.4)?;
    let (meshes, largest_joints) = mesh::read(&mut reader)?;
    context.progress(0.7)?;
    let instances = scene::read_instances(&mut reader, &meshes, &skins, &largest_joints)?;
    let takes = take::read(&mut reader, &skeleton, &instances)?;
    reader.finish()?;
    let animation = AnimationData { skeleton: Arc::new(skeleton), takes };
    Ok(ModelData { name, meshes, instances, skins, materials, images, animation })
}

/// Returns the error of an invalid file at byte `at`.
fn invalid(at: usize, code: &'static str, reason: String) -> ImportError {
    ImportError::Invalid { place: Place::Byte(at as u64), code, reason }
}

/// Returns the error of an invalid model at `place`.
fn refuse(place: String, reason: String) -> WriteError {
    WriteError::Invalid { place, reason }
}
