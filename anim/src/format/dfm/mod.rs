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
use reader::Reader;
use std::sync::Arc;
use thiserror::Error;
use writer::Writer;

/// Major and minor version that is written. Files of another major version are refused; those of a newer minor version
/// are read, with a warning, as far as this one knows them.
pub const VERSION: (u16, u16) = (1, 0);

/// Before the directory of the parts.
const DIRECTORY_TAG: [u8; 4] = *b"SUMS";

/// The last four bytes of every file.
const ENDING_MAGIC: [u8; 4] = *b"dfm\x1a";

/// The thesis's serialization, with what this library's models have beyond it.
pub const DFM: Format = Format {
    name: "dfm",
    title: "Dragonfly model",
    extensions: &["dfm"],
    sniff: looks_like_dfm,
    read: import,
    write: WriteSupport::Whole(export),
};

/// Why a model could not be written. Shown as `place: reason`, on one line.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum WriteError {
    /// A part of the model breaks the promises of its type, so that reading could not bring it back.
    #[error("{place}: {}", super::error::one_line(reason))]
    Invalid {
        /// Where in the model: `/meshes/0/primitives/1`.
        place: String,
        /// What is wrong, with the numbers.
        reason: String,
    },
    /// An index or another number of the model is refused by the reader; its place is that in the file that would have
    /// been written.
    #[error("the model cannot be read back: {0}")]
    Refused(#[from] ImportError),
    /// The first four bytes of a file cannot say how long this one would be.
    #[error("file: {bytes} bytes, at most {}", u32::MAX)]
    TooLarge {
        /// Bytes of the whole file.
        bytes: u64,
    },
}

/// The bytes of a `.dfm` file that holds `model`.
///
/// [`read`] gives the same model back, every float bit for bit, NaN included. What is written was read once by way of
/// proof. A model that breaks the promises of its types (columns of different lengths, an index that names nothing,
/// tracks that are not one a bone) is refused, as is one that needs 4 GiB or more.
pub fn write(model: &ModelData) -> Result<Vec<u8>, WriteError> {
    let mut writer = Writer::new();
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

/// The model in a `.dfm` file, every float bit for bit as it was written.
///
/// Refused are files that are cut short, altered, of another major version, or that contradict themselves; the error
/// names the offset. Takes at most 256 MiB and 32 times the bytes of the file; mostly two or three times. Where numbers
/// that are not finite, key times that do not rise, and the [limits](crate::limits) of importers matter, use
/// [`format::read`](super::read), which refuses those as well.
pub fn read(bytes: &[u8]) -> Result<ModelData, ImportError> {
    let options = ReadOptions { budget: ByteBudget::at_most(u64::MAX), ..ReadOptions::default() };
    options.budget.input(bytes.len());
    read_model(bytes, &ImportContext::new(&NoFiles, &options), false)
}

/// As an importer: what is read keeps what every imported model promises.
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

/// By the size of a vertex, which stands at byte 8, or by the ending.
fn looks_like_dfm(bytes: &[u8]) -> bool {
    let size = (part::Part::Vertices.layout().size as u32).to_le_bytes();
    let begins = bytes.get(8..12) == Some(&size) && !bytes.starts_with(b"glTF");
    let total = (bytes.len() as u64).to_le_bytes();
    begins || (bytes.ends_with(&ENDING_MAGIC) && bytes.starts_with(&total[..4]))
}

fn read_model(bytes: &[u8], context: &ImportContext<'_>, strict: bool) -> Result<ModelData, ImportError> {
    let mut reader = Reader::new(bytes, context, strict)?;
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

/// The file is wrong at byte `at`.
fn invalid(at: usize, code: &'static str, reason: String) -> ImportError {
    ImportError::Invalid { place: Place::Byte(at as u64), code, reason }
}

/// The model is wrong at `place`.
fn refuse(place: String, reason: String) -> WriteError {
    WriteError::Invalid { place, reason }
}
