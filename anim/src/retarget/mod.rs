//! The same animation on another model (thesis §1.5: one animation for all models with the same or a very similar
//! skeleton).
//!
//! A [`Binding`] says which bone of one skeleton is which bone of another. With it,
//!
//! * [`rebind`] hands the tracks over as they are: right for another surface on the same skeleton;
//! * [`retarget`] also makes up for another rest pose and other proportions: right for rigs of equal topology.
//!
//! # The formula
//!
//! `G` is the rotation of a bone's to-root (the product of the rotations of the bone and its ancestors, scale left out),
//! subscript s the source, t the target, 0 the rest pose. What is carried over is the turn away from the rest, in to-root
//! space, onto a target that stands as the source rests:
//!
//! ```text
//! D(t)   = G_s(t) G_s0⁻¹                      how far the source's bone has turned
//! G_t(t) = D(t) C G_t0                        the target's bone turns as far, from where C puts it
//! C      = the rotation that brings the bone of the target's rest to where that of the source's rest points
//! ```
//!
//! `C` makes up for a T-pose on one side and an A-pose on the other. For a bone with one bound child it is the shortest
//! rotation from the target's direction (bone to child, to-root space) to the source's; with several children, the one
//! rotation that brings all directions onto each other within [`SAME_SHAPE`], where there is one; for all others that of
//! the parent, and the identity at the root. Where both skeletons rest alike it is the identity.
//!
//! Relative to the parent, with `a` the nearest bound ancestor and `K` the rests of unbound bones between, this is
//!
//! ```text
//! q_t(t) = L · (G_sa(t)⁻¹ G_s(t)) · E,    L = K⁻¹ G_ta0⁻¹ C_a⁻¹ G_sa0,    E = G_s0⁻¹ C G_t0
//! ```
//!
//! L and E do not depend on time. So where one channel of the source moves the bone relative to `a`, its keys are
//! multiplied one by one: times, interpolation and (as the product is linear) tangents of splines are kept, and it is
//! exact between the keys. Where several do, the product is sampled at the union of their key times.
//!
//! Translations of the trunk (from the roots down to the hips) are carried over relative to the rest and scaled, with `S`
//! the linear part of to-root of the parent at rest and `k` the ratio of sizes:
//!
//! ```text
//! x_t(t) = x_t0 + k S_t0⁻¹ C_parent⁻¹ S_s0 (x_s(t) - x_s0)
//! ```
//!
//! All other bones keep the translations of the target's rest, and so their lengths.

mod binding;
mod names;
mod rest;
mod rotation;
mod transfer;
mod translation;

pub use binding::{BindError, Binding, rebind};
pub use names::normalized_name;
pub use rest::{SAME_SHAPE, height_ratio, leg_ratio};
pub use transfer::{RetargetOptions, retarget};
