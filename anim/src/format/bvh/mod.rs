//! BVH (Biovision hierarchy): the usual format of motion captures, a text with a skeleton and one motion.
//!
//! # What is read
//!
//! A joint becomes a bone, and the tip of a joint (`End Site`) a bone `<joint>_end` without channels. The local rotation is the
//! product of the rotations about the axes in the order of the channels; a position channel replaces the offset of its axis. In the
//! rest pose every channel is zero. Every joint with channels has a key in every frame, at the number of the frame times the frame
//! time. The take is called `motion`.
//!
//! # Units
//!
//! The format has Y up and right-handed axes, and does not contain a unit of length: [`Conversion::meters_per_unit`](super::Conversion::meters_per_unit) is guessed
//! from the size of the figure (meters, centimeters, millimeters, inches, or inches divided by 0.45 as in the database of CMU),
//! such that a human is as tall as a human; where none of these fits, such that the figure is 1.7 m tall.
//!
//! # What is saved
//!
//! An edited file keeps every byte but the numbers of the frames and channels that were edited ([`save`]). [`write`](fn@write) makes a
//! file of any model.

mod angles;
mod channel;
pub mod check;
mod common_root;
mod hierarchy;
mod model;
mod motion;
mod parsed;
mod rate;
mod sampled;
pub mod save;
mod scene_pose;
mod unit;
mod write;

pub use write::write;

use super::{Format, ImportContext, ImportError, WriteSupport};
use crate::data::ModelData;
use parsed::BvhText;

/// BVH motion capture, `.bvh`.
pub const BVH: Format = Format {
    name: "bvh",
    title: "BVH motion capture",
    extensions: &["bvh"],
    sniff: |bytes| {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        text.get(..9).is_some_and(|word| word.eq_ignore_ascii_case(b"HIERARCHY"))
    },
    read,
    write: WriteSupport::Surgical(save::open),
    export: Some(|model, name| Ok(write(model)?.named(name))),
};

fn read(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    let text = BvhText::parse(bytes, context)?;
    context.converted(text.conversion);
    model::model(&text, context)
}
