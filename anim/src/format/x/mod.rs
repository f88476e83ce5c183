//! DirectX `.x`: frames, meshes and animation sets, as text, binary tokens, or either of them compressed.
//!
//! # What is read
//!
//! Frames become bones, meshes with skin weights get a skin and do not follow the frame that contains them, all others do. Animation
//! sets become takes. A skin that names a frame which is not in the file gets a bone that does not move. Objects of other types are
//! skipped.
//!
//! # Axes and times
//!
//! The format is left-handed with Y up and has no unit; rotation keys have the inverse sense. Times are in ticks: the rate is in the
//! file or 4800 per second. Small exporters count frames and write no rate: where a file without a rate has no tick of 1000 or more,
//! 30 per second are assumed, with a warning. [`Conversion::frame_rate`](super::Conversion) has the rate, and where it is from.
//!
//! # What is saved
//!
//! An edited text keeps every byte but the keys that were edited ([`save`]). Binary and compressed files cannot be edited.
//! [`write`](fn@write) makes a text of any model.

mod animation;
mod binary;
pub mod check;
mod geometry;
mod header;
mod inflate;
mod key_text;
mod lexer;
mod mesh;
mod model;
mod names;
pub mod save;
mod scene;
mod skeleton;
mod skin;
mod surface;
mod take;
mod write;

pub use write::write;

use super::{Format, ImportContext, ImportError, WriteSupport};
use crate::data::ModelData;
use header::XFile;
use scene::XScene;

/// DirectX objects, `.x`.
pub const X: Format = Format {
    name: "x",
    title: "DirectX",
    extensions: &["x"],
    sniff: |bytes| bytes.starts_with(b"xof "),
    read,
    write: WriteSupport::Surgical(save::open),
    export: Some(|model, name| Ok(write(model)?.named(name))),
};

fn read(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    let file = XFile::open(bytes, context)?;
    let scene = XScene::parse(&file, context)?;
    let conversion = take::conversion(&scene, context);
    context.converted(conversion);
    context.progress(0.5)?;
    model::model(&file, scene, &conversion, context)
}
