//! Blending: the poses of any number of takes combined into one, bone by bone, before skinning (thesis §2.1.4.1:
//! combining per bone is far cheaper than per vertex).
//!
//! Everything here reads and writes *poses*: one [`Transform`] per bone, relative to the parent, in bone order, as
//! [`crate::sample::sample_take`] writes them and [`crate::animation::to_root`](crate::animation::to_root()) reads
//! them.
//!
//! | task | function |
//! |---|---|
//! | any number of layers with weights and masks | [`blend`], [`blend_normalized`] |
//! | exactly two, rotations at constant speed | [`blend_two`] |
//! | an additive animation on top of another | [`difference`], [`add`] |
//! | some bones more than others | [`Mask`] |
//! | a weight that changes over time | [`weight_at`] |
//! | from one cycle to another, in step | [`CrossFade`] |
//! | from any take to any other, each at its own time | [`FreeFade`] |
//! | a take once on top of another, gone when it ends | [`OneShot`] |
//!
//! # Common rules
//!
//! * **Weights.** A weight that is negative or NaN counts as 0, one that is infinite as the largest `f32`. In
//!   [`blend`] weights are relative and may be any size; where a weight interpolates between two ends it is clamped
//!   to 0..=1.
//! * **Lengths.** The length of `out` is the number of poses written. A layer that is shorter does not affect the bones
//!   that it lacks; where the base is shorter, the identity is used; a mask has the weight 0 past its end.
//! * **Total.** No input panics, and no result is NaN or infinite. If a number of a layer is not finite, the base's
//!   number is used instead; if a number of the base is not finite, that of [`Transform::IDENTITY`]. A rotation that is
//!   not of unit length is normalized. Valid poses are never changed by this.
//! * **Memory.** Masks and cycles are created once; functions that run every frame allocate nothing.

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
pub use layer::{Layer, blend, blend_normalized};
pub use mask::{Mask, NoSuchBone};
pub use one_shot::OneShot;
pub use playback::Playback;
pub use two::{blend_two, mix_poses};

use crate::data::Transform;
use crate::sample::healthy;

/// Returns `pose` with unusable numbers replaced: see [`healthy`].
fn usable(pose: Transform) -> Transform {
    healthy(pose, Transform::IDENTITY)
}

/// Returns a usable weight: 0 or more, finite.
pub(crate) fn weight_or_zero(weight: f32) -> f32 {
    // NaN fails the comparison.
    if weight > 0.0 { weight.min(f32::MAX) } else { 0.0 }
}

/// Clamps a weight that interpolates between two ends to 0..=1.
pub(crate) fn fraction(weight: f32) -> f32 {
    weight_or_zero(weight).min(1.0)
}
