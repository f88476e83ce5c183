//! The fast path: the same poses as [`crate::sample`] and [`crate::animation`], many bones at once.
//!
//! The open path follows the formulas one bone at a time, for study, for edits and as the reference. This one stores
//! bones as a structure of arrays ([`Pose`]) and computes eight of them in one step with the instructions that the
//! machine has ([`simd::SimdLevel`]). Both agree within 1e-5 of the largest number.
//!
//! Nothing here allocates after set-up, and no result of one time is used for another: any time of a take costs the
//! same.

mod additive;
mod binding;
mod blend;
mod blend_masks;
mod crowd;
mod final_poses;
mod key_table;
mod keyed;
mod local;
mod mask;
pub mod matrix;
mod morph;
mod one_character;
mod pipeline;
mod playable;
mod played;
mod pose;
mod rig;
pub mod simd;
mod slerp;
mod still;
mod tiny;
mod to_root;
mod two_bone;
mod vertices;
mod weigh;

pub use additive::{add, difference};
pub use binding::SkinBinding;
pub(crate) use blend::WHOLE;
pub use blend::{PoseLayer, blend, blend_normalized};
pub use final_poses::final_poses;
pub use keyed::KeyedTake;
pub use mask::LaneMask;
pub use matrix::Matrix34;
pub use pipeline::{MAX_LAYERS, Playing, Scratch, pose_character, pose_crowd};
pub use playable::{Playable, sample};
pub use pose::{Pose, PoseBlock};
pub use rig::Rig;
pub use still::StillPose;
pub use to_root::{RootPoses, to_root};
pub use two_bone::{FastTwoBone, distance_left, two_bone};
pub use vertices::{SkinnedVertices, skin_morphed_vertices, skin_vertices, skin_vertices_by_matrix};
