//! Luna's `.m3d`: the text format of the programs in Frank Luna's books about Direct3D, in three dialects.
//!
//! Labels are never compared, as in those programs: only the order of the numbers counts. Errors name the line.
//!
//! # What is read
//!
//! Bones, which have no names in the file, are called `bone0`, `bone1`, …; at rest they are where their offsets lead to bone space
//! from. Clips become takes. Each material has a range of triangles, which becomes a primitive. Textures are read from files next
//! to the model; those that are missing are warnings.
//!
//! # Axes
//!
//! The format does not contain its axes, and there are files of both kinds: [`Conversion::handedness`](super::Conversion) is
//! guessed from the triangles. Where most of them oppose the normals of their vertices, the file is right-handed.
//!
//! # What is saved
//!
//! An edited file keeps every byte but the rows of keys that were edited, their counts, and the names of takes ([`save`]).
//! [`write`](fn@write) makes a file of any model.

mod bones;
pub mod check;
mod clips;
mod dialect;
mod geometry;
mod material;
mod model;
pub mod save;
mod scan;
mod text;
mod weights;
mod write;

pub use dialect::M3dDialect;
pub use write::write;

use super::{Format, ImportContext, ImportError, WriteSupport};
use crate::data::ModelData;
use dialect::is_other_format;
use text::M3dText;

/// Luna's text format, `.m3d`.
pub const M3D: Format = Format {
    name: "m3d",
    title: "Luna's m3d",
    extensions: &["m3d"],
    sniff,
    read,
    write: WriteSupport::Surgical(save::open),
    export: Some(|model, name| Ok(write(model, M3dDialect::Dx12)?.named(name))),
};

/// Bytes in which the header is looked for.
const HEADER: usize = 128;

fn sniff(bytes: &[u8]) -> bool {
    let start = bytes[..bytes.len().min(HEADER)].to_ascii_lowercase();
    let has = |word: &[u8]| start.windows(word.len()).any(|part| part == word);
    is_other_format(bytes) || (has(b"m3d") && has(b"header"))
}

fn read(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    let text = M3dText::parse(bytes, context)?;
    context.converted(text.conversion);
    context.progress(0.5)?;
    model::model(bytes, text, context)
}
