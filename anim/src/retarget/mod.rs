//! Retargeting: the same animation on another model (thesis §1.5: one animation for all models with the same or a very
//! similar skeleton).
//!
//! A [`SkeletonBinding`] assigns bones of one skeleton to bones of another. With it,
//!
//! * [`rebind`] copies the tracks unchanged: correct for another surface on the same skeleton;
//! * [`retarget`] also compensates for another rest pose and other proportions: correct for rigs of equal topology;
//! * [`retarget_figure`] also distributes bends over chains of different length and keeps the contacts of feet, for a binding
//!   that [`BindingGuess`] found or a user corrected.
//!
//! # The formula
//!
//! `G` is the rotation of a bone's to-root (the product of the rotations of the bone and its ancestors, scale left
//! out), subscript s the source, t the target, 0 the rest pose. What is transferred is the rotation relative to the
//! rest pose, in to-root space, to a target aligned with the source's rest pose:
//!
//! ```text
//! D(t)   = G_s(t) G_s0⁻¹                      rotation of the source's bone from its rest pose
//! G_t(t) = D(t) C G_t0                        the target's bone turns by the same, after the alignment C
//! C      = the rotation from the direction of the target's bone at rest to that of the source's bone at rest
//! ```
//!
//! `C` compensates for a T-pose on one side and an A-pose on the other. For a bone with one bound child it is the
//! shortest rotation from the target's direction (bone to child, to-root space) to the source's; with several children,
//! the one rotation that aligns all directions within [`SAME_SHAPE`], where there is one; for all others that of the
//! parent, and the identity at the root. Where both skeletons have the same rest pose it is the identity.
//!
//! Relative to the parent, with `a` the nearest bound ancestor and `K` the rest rotations of unbound bones between,
//! this is
//!
//! ```text
//! q_t(t) = L · (G_sa(t)⁻¹ G_s(t)) · E,    L = K⁻¹ G_ta0⁻¹ C_a⁻¹ G_sa0,    E = G_s0⁻¹ C G_t0
//! ```
//!
//! L and E do not depend on time. So where one channel of the source moves the bone relative to `a`, its keys are
//! multiplied one by one: times, interpolation and (as the product is linear) tangents of splines are kept, and it is
//! exact between the keys. Where several do, the product is sampled at the key times of all of them, and between, 60
//! times per second and at most 16 times from key to key.
//!
//! Translations of the trunk (from the roots down to the hips, and every other bone that has no bound ancestor) are
//! transferred relative to the rest pose and scaled, with `S` the linear part of to-root of the parent at rest and `k`
//! the ratio of sizes:
//!
//! ```text
//! x_t(t) = x_t0 + k S_t0⁻¹ C_parent⁻¹ S_s0 (x_s(t) - x_s0)
//! ```
//!
//! All other bones keep the translations of the target's rest pose, and so their lengths.
//!
//! # Unbound bones of the source
//!
//! Their movement is not lost: it is applied to their nearest bound descendants. Their rotations are part of `G_sa(t)⁻¹
//! G_s(t)` above. Their translations, and the effect of their rotations and scales on the bones below them, matter for
//! the trunk: where such bones move, the position of the bone relative to `a` replaces its translation,
//!
//! ```text
//! p_s(t) = B(t) x_s(t),    B = product of to_parent of the bones between a and the bone, top first
//! x_t(t) = x_t0 + k S_t0⁻¹ C_parent⁻¹ S_sa0 (p_s(t) - p_s0)
//! ```
//!
//! so a figure whose walk is in a bone above the hips walks as far, times `k`, where only the hips are bound. `p_s` is
//! sampled at the key times of all contributing channels, and between where bones turn or channels are curved.

mod attach;
mod binding;
mod convention;
mod expressions;
mod figure;
mod guess;
mod names;
mod reach;
mod relative_position;
mod rest;
mod rotation;
mod sample_times;
mod spread;
mod standing;
mod transfer;
mod translation;
mod twist;

pub use binding::{BindError, SkeletonBinding, rebind};
pub use convention::{BodyPart, BoneRole, SkeletonRoles};
pub use expressions::retarget_expressions;
pub use figure::{FigureError, FigureOptions, Retargeted, retarget_figure};
pub use guess::BindingGuess;
pub use names::normalized_name;
pub use rest::{SAME_SHAPE, height_ratio, leg_ratio};
pub use transfer::{RetargetOptions, retarget};
