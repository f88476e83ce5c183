//! Several animations at once: poses of any number of takes made into one, bone by bone, before skinning
//! (thesis §2.1.4.1: combining per bone is far cheaper than per vertex).
//!
//! Everything here takes and gives *poses*: one [`Transform`] a bone, relative to the parent, in bone order, as
//! [`crate::sample::sample_take`] writes them and [`crate::animation::to_root`](crate::animation::to_root()) reads them.
//!
//! | wish | function |
//! |---|---|
//! | any number of layers with weights and masks | [`blend`], [`blend_normalised`] |
//! | exactly two, turning at constant speed | [`blend_two`] |
//! | a movement on top of another | [`difference`], [`add`] |
//! | some bones more than others | [`Mask`] |
//! | a weight that changes over time | [`weight_at`] |
//! | from one cycle to another without a stumble | [`CrossFade`] |
//! | from any take to any other, each at its own time | [`FreeFade`] |
//! | a take once over another, gone when it ends | [`OneShot`] |
//!
//! # Rules that hold everywhere
//!
//! * **Weights.** A weight that is negative or NaN counts as 0, one that is infinite as the largest `f32`. In
//!   [`blend`] weights are relative and may be any size; where a weight is the way between two ends it is held
//!   within 0..=1.
//! * **Lengths.** As many poses are written as `out` has room for. A layer that is shorter has no say in the bones it
//!   lacks; where the base is shorter the identity stands in; a mask gives the bones past its end the weight 0.
//! * **Total.** No input panics, and no result is NaN or infinite. A number of a layer that is not finite is replaced by
//!   the base's, one of the base by that of [`Transform::IDENTITY`]; a rotation that is not of unit length is normalised.
//!   Healthy poses never take these ways.
//! * **Memory.** Masks and cycles are made once; what runs every frame allocates nothing.

mod additive;
mod cross_fade;
mod curve;
mod cycle;
mod fade;
mod free_fade;
mod layer;
mod mask;
mod one_shot;
mod playback;
mod two;

pub use additive::{add, add_to, difference, difference_of};
pub use cross_fade::CrossFade;
pub use curve::weight_at;
pub use cycle::{Cycle, common_length};
pub use fade::{FadeCurve, Faded};
pub use free_fade::FreeFade;
pub use layer::{Layer, blend, blend_normalised};
pub use mask::{Mask, NoSuchBone};
pub use one_shot::OneShot;
pub use playback::Playback;
pub use two::{blend_two, mix_poses};

use crate::data::Transform;
use crate::sample::healthy;

/// `pose` as it may be used: see [`healthy`].
fn usable(pose: Transform) -> Transform {
    healthy(pose, Transform::IDENTITY)
}

/// A weight as it may be used: 0 or more, finite.
pub(crate) fn weight_or_zero(weight: f32) -> f32 {
    // NaN fails the comparison.
    if weight > 0.0 { weight.min(f32::MAX) } else { 0.0 }
}

/// A weight that is a way between two ends: 0..=1.
pub(crate) fn fraction(weight: f32) -> f32 {
    weight_or_zero(weight).min(1.0)
}
