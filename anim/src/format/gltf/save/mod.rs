//! Saves edited takes into a glTF file without changing the bytes of anything else.
//!
//! A file is never rebuilt. [`SourceFile`] keeps its bytes and the range of every value of its JSON. [`plan`] compares
//! the takes as they were opened with the takes as they are now and finds the few tokens and bytes that have to change;
//! [`Plan::changes`] lists them; [`Plan::write`] returns the new file. Only bytes go in and out: no file is opened or
//! written here.
//!
//! Guarantees:
//!
//! * Without an edit the bytes stay the same, whatever the file contains.
//! * A channel counts as edited only if its bits differ from the opened ones. What the importer corrected (rotations
//!   normalized, keys sorted) and left out (unknown targets, second channels of a target, extensions) stays as it is in
//!   the file, even in edited takes.
//! * New numbers are appended to the buffer as floats: to the binary chunk of a `.glb`; in a `.gltf` to its data URI,
//!   or to a new file (existing ones are not changed). In the JSON only the necessary tokens change, and new ones are
//!   formatted like their neighbors. Quantized, normalized, sparse and compressed accessors are kept.
//! * A sampler that other channels use stays unchanged: the edited channel gets its own. No accessor of the file is
//!   overwritten, except those that an earlier save appended ([`MARK`]) and that nothing else uses.
//! * A file is no larger after ten saves than after one: room that is no longer used is reused. [`compact`] removes
//!   what is left unused.
//!
//! What glTF cannot represent:
//!
//! | in the take | in the file |
//! |---|---|
//! | [`Interpolation::Closest`](crate::data::Interpolation) | `STEP` with the times moved, the same at every time |
//! | a spline of one key | that key, `LINEAR`; glTF requires two |
//! | a take that animates nothing | one key that keeps the first bone at rest, since an animation must have a channel |
//! | start and length of a take | not stored: they are those of its keys |
//! | a bone that is not a joint and that no take animates any more | its node, at rest; the saved file has no bone for it ([`Changes::bones_lost`]) |
//! | a root bone that an edit added | a node at the end of the list, above the former root nodes in all scenes |
//! | a channel of a node with a matrix | the matrix becomes translation, rotation and scale |
//! | extras, where the `extras` of the animation are no object | left out, see [`Changes::extras_lost`] |
//! | key times below zero | themselves, although glTF forbids them; the importer keeps them with a warning |
//! | rotations that are not of unit length | [`SaveError::Keys`] |
//! | neighboring rotations in different hemispheres, or of unit length except for rounding | their bits; the importer negates and normalizes them |
//!
//! Removing a channel removes all channels of its target, including those that the importer left out as duplicates;
//! otherwise one of them would take effect. Extensions refer to animations by number; those numbers are not updated
//! when takes are deleted or reordered.
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
//! Reading order: `json` (ranges and patches), `container`, `source`, `document`; `channels` and `columns` (what
//! changed), `animation`, `order`, `nodes`, `roots` (the tokens), `needs`, `reuse`, `buffer` (the bytes), `plan`, `draw`,
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
mod extras;
mod json;
mod mark;
mod needs;
mod nodes;
mod order;
mod plan;
mod planned;
mod reuse;
mod roots;
mod source;
mod surgical;

pub use buffer::buffer_of_save;
pub use changes::{ChangedChannel, ChangedToken, Changes, ChannelChange, TakeChange, WrittenAccessor};
pub(super) use columns::{EncodedKeys, KeyColumns, KeysOwner, keys as encode_keys};
pub use compact::compact;
pub use error::SaveError;
pub use mark::MARK;
pub use plan::{plan, plan_with_skeleton};
pub use planned::Plan;
pub use source::SourceFile;
pub(super) use surgical::open;
