#![doc = include_str!("layout.md")]

mod bone;
pub mod code;
mod container;
mod error;
mod image;
mod keys;
mod material;
mod mesh;
mod morph;
mod part;
mod parts;
mod reader;
mod record;
mod scene;
mod take;
mod vertex;
mod writer;

pub use error::WriteError;
pub use part::VERSION;

use super::losses::avatar_lost;
use super::{
    ByteBudget, ExportError, Format, ImportContext, ImportError, NoFiles, Place, ReadOptions, Warning,
    WholeFile, WriteSupport,
};
use crate::data::{AnimationData, ModelData};
use part::ENDING_MAGIC;
use parts::PARTS;
use reader::DfmReader;
use std::sync::Arc;
use writer::DfmWriter;

/// The thesis's serialization, extended by everything else that this library's models contain.
pub const DFM: Format = Format {
    name: "dfm",
    title: "Dragonfly model",
    extensions: &["dfm"],
    sniff: looks_like_dfm,
    read: import,
    write: WriteSupport::Whole(export),
    export: Some(|model, name| Ok(export(model)?.named(name))),
};

/// Returns the bytes of a `.dfm` file that contains `model`.
///
/// [`read`] returns the same model, every float bit for bit, including NaN; this function verifies that the written
/// file can be read. Refused are models that break the invariants of their types (columns of different lengths, an
/// index out of range, not exactly one track per bone), and models that need 4 GiB or more.
pub fn write(model: &ModelData) -> Result<Vec<u8>, WriteError> {
    let mut writer = DfmWriter::new(&PARTS);
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

/// Writes the whole file; the format represents everything that a model contains, but not the extras of its takes and
/// its avatar.
fn export(model: &ModelData) -> Result<WholeFile, ExportError> {
    let takes = model.animation.takes.iter().enumerate().filter(|(_, take)| !take.extras.is_empty());
    let lost = takes.map(|(number, take)| {
        let names: Vec<&str> = take.extras.iter().map(|(name, _)| name).collect();
        Warning {
            place: Place::Pointer(format!("/takes/{number}")),
            code: code::DFM_EXTRAS,
            text: format!("take \"{}\": this format has no room for its {}", take.name, names.join(", ")),
        }
    });
    Ok(WholeFile { bytes: write(model)?, lost: lost.chain(avatar_lost(model)).collect() })
}

/// Detects the size of a vertex, at byte 8, or the ending.
fn looks_like_dfm(bytes: &[u8]) -> bool {
    let size = (PARTS[part::DfmPart::Vertices as usize].sizes[0] as u32).to_le_bytes();
    let begins = bytes.get(8..12) == Some(&size) && !bytes.starts_with(b"glTF");
    let total = (bytes.len() as u64).to_le_bytes();
    begins || (bytes.ends_with(&ENDING_MAGIC) && bytes.starts_with(&total[..4]))
}

fn read_model(bytes: &[u8], context: &ImportContext<'_>, strict: bool) -> Result<ModelData, ImportError> {
    let mut reader = DfmReader::new(&PARTS, bytes, context, strict)?;
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
    Ok(ModelData { name, meshes, instances, skins, materials, images, animation, ..ModelData::default() })
}
