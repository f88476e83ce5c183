//! Skeletal animation as plain data and functions, with nothing hidden.
//!
//! A *model* is geometry with skinning information, a skeleton, and several *takes* (clips, animations).
//! Each frame, for one take and one time:
//!
//! 1. [`sample`] finds the keys around the time and mixes them: one [`data::Transform`] a bone, in its parent's space;
//! 2. [`animation::Animation`] chains them from the root to the children (`to_root`) and puts the skin's offset in
//!    front (`final_pose = to_root × offset`);
//! 3. [`skin`] moves every vertex by the final poses of the bones that influence it. A shader does the same.
//!
//! Matrices are glam's: column vectors, so a product reads right to left. The thesis this library grew from writes
//! row vectors, so its `Final = Offset · ToRoot` is our `to_root * offset`; the numbers are the same.
//!
//! Field synonyms, once: take = clip = glTF animation; bone = joint; to-root = model space = global.
//!
//! The library starts no thread, opens no file and no window: importers take bytes and ask a door
//! ([`format::AssetFs`]) for anything else.

#![deny(unsafe_code)]

pub mod additional;
pub mod animation;
pub mod attach;
mod axes;
pub mod blend;
pub mod bounds;
pub mod check;
pub mod compressed;
pub mod data;
pub mod evaluator;
pub mod explain;
pub mod fast;
pub mod format;
pub mod hit;
pub mod ik;
pub mod joint;
pub mod level;
pub mod limits;
pub mod motion;
pub mod reduce;
pub mod retarget;
pub mod sample;
pub mod skin;
pub mod tutorial;
