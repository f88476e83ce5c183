//! Additional transformations of single bones on top of the running animation, such as aiming while running (thesis
//! §2.1.7.2).
//!
//! A list is applied to poses relative to the parents after sampling and blending, before the poses are chained from
//! the root:
//!
//! ```text
//! sample_take → blend → additional::apply → to_root → final_poses
//! ```
//!
//! Each entry has a bone, a space, a mode (add or replace), the parts of the pose that it changes, and a weight.

mod one;
mod space;

use crate::data::{BoneIndex, Skeleton, Transform};

/// The axes in which the transform of an [`Additional`] is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[doc(alias("local space", "model space"))]
pub enum Space {
    /// The bone's own axes (local space).
    #[default]
    Bone,
    /// The axes of the parent bone; for a root, those of the scene.
    Parent,
    /// The axes of the scene (model space), independent of the bones above.
    Root,
}

/// How an [`Additional`] combines with the animated pose.
///
/// `X` is the entry's transform with parts `Xt`, `Xr`, `Xs`; the pose has `T`, `R`, `S`; `P` is the parent's to-root,
/// `|P|` its axes without their lengths. `rest` is the bone's rest pose.
///
/// | | add | replace |
/// |---|---|---|
/// | bone | `T + R·S·Xt`, `R·Xr`, `S∘Xs` | `rest`, to which `X` is added in the bone's space |
/// | parent | `T + Xt`, `Xr·R`, `S∘Xs` | `X` |
/// | root | `T + P⁻¹·Xt`, `(\|P\|⁻¹·Xr·\|P\|)·R`, `S∘Xs` | `P⁻¹·X`, decomposed |
///
/// Rotations turn about the bone's own origin in each space; scales are along the bone's own axes, multiplied component
/// by component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum AdditionalMode {
    /// Adds to the animated pose.
    #[default]
    Add,
    /// Replaces the animated pose.
    Replace,
}

/// The parts of a pose that an [`Additional`] changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PoseParts {
    /// Whether the translation is changed.
    pub translation: bool,
    /// Whether the rotation is changed.
    pub rotation: bool,
    /// Whether the scale is changed.
    pub scale: bool,
}

impl PoseParts {
    /// The whole pose.
    pub const ALL: Self = Self { translation: true, rotation: true, scale: true };

    /// The rotation alone.
    pub const ROTATION: Self = Self { translation: false, rotation: true, scale: false };
}

impl Default for PoseParts {
    fn default() -> Self {
        Self::ALL
    }
}

/// One additional transformation of one bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Additional {
    /// The bone to change.
    pub bone: BoneIndex,
    /// The transform to add, or to replace the pose with.
    pub transform: Transform,
    /// The axes in which `transform` is given.
    pub space: Space,
    /// Whether `transform` is added or replaces the pose.
    pub mode: AdditionalMode,
    /// The parts of the pose that are changed.
    pub parts: PoseParts,
    /// Strength of the effect, 0..=1; rotations turn at constant speed.
    pub weight: f32,
}

impl Additional {
    /// Creates an entry that turns `bone` by `rotation` on top of the animation, in `space`, with weight 1.
    pub fn turn(bone: BoneIndex, rotation: glam::Quat, space: Space) -> Self {
        let transform = Transform { rotation, ..Transform::IDENTITY };
        Self { bone, transform, space, mode: AdditionalMode::Add, parts: PoseParts::ALL, weight: 1.0 }
    }
}

/// Applies `list` to `poses` (relative to the parents), in order; each entry works on the result of those before it.
///
/// * Weight 0 (also negative and NaN) leaves the pose unchanged bit for bit, and so does adding the identity; 1 or more
///   is the full effect.
/// * An entry is skipped when its bone has no pose or its transform is not finite.
/// * Parts that come out not finite, or cannot be computed because a bone above has scale zero, keep their values.
/// * Under parents with different scales per axis `P⁻¹·Xr·P` is no rotation; the axes without their lengths give the
///   nearest one. Mirrored parents are exact.
///
/// [`Space::Root`] walks up to the root: O(depth) per entry; the others are O(1). Allocates nothing.
pub fn apply(skeleton: &Skeleton, list: &[Additional], poses: &mut [Transform]) {
    for additional in list {
        one::apply_one(skeleton, additional, poses);
    }
}
