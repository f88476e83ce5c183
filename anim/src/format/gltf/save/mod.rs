//! Saving into a glTF file without touching what was not edited.
//!
//! A file is never rebuilt. [`SourceFile`] keeps its bytes and knows where every value of its JSON lies; [`plan`]
//! compares the takes as they were opened with the takes as they are now, and finds the few tokens and bytes that have
//! to differ; [`Plan::changes`] says what they are; [`Plan::write`] puts the file together. Bytes in, bytes out: no
//! file is opened or written here.
//!
//! What is promised:
//!
//! * Nothing edited: the same bytes, whatever the file looks like.
//! * A channel counts as edited only where its bits differ from what was opened. What importing mended (rotations made
//!   unit, keys sorted) and left out (unknown targets, second channels of a target, extensions) stays as it is in the
//!   file, in edited takes too.
//! * New numbers are appended to the buffer, as floats: to the binary chunk of a `.glb`; in a `.gltf` to its data URI,
//!   or to a new file beside it (the old ones are not touched). In the JSON only those tokens change that must; new
//!   ones are written as their neighbours are. Quantised, normalised, sparse and compressed accessors stay beside.
//! * A sampler that other channels use is left to them: the edited channel gets one of its own. No accessor of the
//!   file is ever written over, except those that an earlier save appended ([`MARK`]) and that nothing else uses.
//! * Ten saves are no larger than one: room that is no longer used is used again. [`compact`] takes away what is left.
//!
//! What glTF cannot say, and what becomes of it:
//!
//! | in the take | in the file |
//! |---|---|
//! | [`Interpolation::Closest`](crate::data::Interpolation) | `STEP` with the times moved, the same at every time |
//! | a spline of one key | that key, `LINEAR`; glTF wants two |
//! | a take that moves nothing | one key that holds the first bone where it rests, since an animation must have a channel |
//! | start and length of a take | nothing: they are those of its keys |
//! | a bone that is no joint and that nothing moves any more | its node, at rest; opened again, the file has no bone for it ([`Changes::bones_lost`]) |
//! | a channel of a node with a matrix | the matrix becomes translation, rotation and scale |
//! | key times below zero, in a take that had none | [`SaveError::Keys`] |
//! | rotations that are not unit | [`SaveError::Keys`] |
//! | rotations whose neighbours lie in different hemispheres, or that are unit but for rounding | their bits; reading turns and mends them |
//!
//! Taking a channel away takes all channels of its target away, also those that importing left out as second ones:
//! else one of them would appear. Animations are known to extensions by number; those numbers are not followed when
//! takes are deleted or reordered.
//!
//! ```
//! use dragonfly_anim::format::gltf::save::{SourceFile, plan};
//! use dragonfly_anim::format::{EditedTake, NoFiles, ReadOptions, read};
//! use std::sync::Arc;
//!
//! let bytes: &[u8] = br#"{
//!     "asset": {"version": "2.0"}, "nodes": [{"name": "tail"}],
//!     "buffers": [{"byteLength": 16, "uri": "data:;base64,AAAAAAAAgD8AAAAAAACAPw=="}],
//!     "bufferViews": [{"buffer": 0, "byteLength": 16}],
//!     "accessors": [
//!         {"bufferView": 0, "componentType": 5126, "count": 1, "type": "SCALAR", "min": [0], "max": [0]},
//!         {"bufferView": 0, "byteOffset": 4, "componentType": 5126, "count": 1, "type": "VEC3"}],
//!     "animations": [{"name": "wag", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
//!                     "samplers": [{"input": 0, "output": 1}]}]
//! }"#;
//! let options = ReadOptions::default();
//! let model = read("tail.gltf", bytes, &NoFiles, &options)?.model;
//! let source = SourceFile::open("tail.gltf", bytes, &NoFiles, &options)?;
//!
//! let mut take = (*model.animation.takes[0]).clone();
//! take.name = "wag slowly".to_owned();
//! let now = [EditedTake { origin: Some(0), take: Arc::new(take) }];
//! let plan = plan(&source, &model, &now)?;
//! assert_eq!(plan.changes().tokens[0].pointer, "/animations/0/name");
//! let files = plan.write();
//! assert_eq!(files[0].bytes.len(), bytes.len() + " slowly".len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Reading order: `json` (spans and patches), `container`, `source`, `document`; `channels` and `columns` (what
//! changed), `animation`, `order`, `nodes` (the tokens), `needs`, `reuse`, `buffer` (the bytes), `plan`, `draw`,
//! `changes`; `compact`.

mod animation;
mod buffer;
mod changes;
mod channels;
mod columns;
mod compact;
mod container;
mod document;
mod draw;
mod error;
mod json;
mod needs;
mod nodes;
mod order;
mod plan;
mod reuse;
mod source;
mod surgical;

pub use changes::{ChangedChannel, ChangedToken, Changes, ChannelChange, TakeChange, WrittenAccessor};
pub use compact::compact;
pub use error::SaveError;
pub use plan::{Plan, plan};
pub use reuse::MARK;
pub use source::SourceFile;
pub(super) use surgical::open;
