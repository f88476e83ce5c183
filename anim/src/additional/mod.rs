//! Additional transformations of single bones on top of the running animation: running while aiming (thesis §2.1.7.2).
//!
//! A list is applied to poses relative to the parents after sampling and blending, before the poses are chained from the
//! root:
//!
//! ```text
//! sample_take → blend → additional::apply → to_root → final_poses
//! ```
//!
//! Each entry says which bone, in which space, whether it adds or replaces, which parts, and with what weight.

mod one;
mod space;

use crate::data::{BoneIndex, Skeleton, Transform};

/// In which axes an [`Additional`] is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Space {
    /// The bone's own (local).
    #[default]
    Bone,
    /// The parent bone's; for a root the scene's.
    Parent,
    /// The scene's (model space), whatever the bones above do.
    Root,
}

/// What an [`Additional`] does with the animation that is there.
///
/// `X` is the entry's transform with parts `Xt`, `Xr`, `Xs`; the pose has `T`, `R`, `S`; `P` is the parent's to-root, `|P|`
/// its axes without their lengths. `rest` is the bone's rest pose.
///
/// | | add | replace |
/// |---|---|---|
/// | bone | `T + R·S·Xt`, `R·Xr`, `S∘Xs` | `rest`, to which `X` is added in the bone's space |
/// | parent | `T + Xt`, `Xr·R`, `S∘Xs` | `X` |
/// | root | `T + P⁻¹·Xt`, `(\|P\|⁻¹·Xr·\|P\|)·R`, `S∘Xs` | `P⁻¹·X`, taken apart |
///
/// Rotations turn about the bone's own origin in each space; scales are along the bone's own axes, multiplied one by one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Change {
    /// On top of the animation.
    #[default]
    Add,
    /// In its place.
    Replace,
}

/// Which parts of a pose an [`Additional`] touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Parts {
    /// The translation.
    pub translation: bool,
    /// The rotation.
    pub rotation: bool,
    /// The scale.
    pub scale: bool,
}

impl Parts {
    /// The whole pose.
    pub const ALL: Self = Self { translation: true, rotation: true, scale: true };

    /// The rotation alone.
    pub const ROTATION: Self = Self { translation: false, rotation: true, scale: false };
}

impl Default for Parts {
    fn default() -> Self {
        Self::ALL
    }
}

/// One additional transformation of one bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Additional {
    /// Which bone.
    pub bone: BoneIndex,
    /// What to add or put in place.
    pub transform: Transform,
    /// In which axes it is meant.
    pub space: Space,
    /// Add or replace.
    pub change: Change,
    /// What it touches.
    pub parts: Parts,
    /// 0..=1: how far towards the full effect; rotations turn at constant speed.
    pub weight: f32,
}

impl Additional {
    /// Turns `bone` by `rotation` on top of the animation, in `space`, with weight 1.
    pub fn turn(bone: BoneIndex, rotation: glam::Quat, space: Space) -> Self {
        let transform = Transform { rotation, ..Transform::IDENTITY };
        Self { bone, transform, space, change: Change::Add, parts: Parts::ALL, weight: 1.0 }
    }
}

/// Applies `list` to `poses` (relative to the parents), in order; each entry finds what those before it left.
///
/// * Weight 0 (also negative and NaN) leaves the pose bit for bit, and so does adding a transform of nothing; 1 or more
///   is the full effect.
/// * An entry is passed over when its bone has no pose or its transform is not finite.
/// * Parts that come out not finite, or cannot be computed because a bone above has no size, stay as they were.
/// * Under parents with different scales per axis `P⁻¹·Xr·P` is no rotation; the axes without their lengths give the
///   nearest one. Mirrored parents are exact.
///
/// [`Space::Root`] walks up to the root: O(depth) an entry, the others O(1). Allocates nothing.
pub fn apply(skeleton: &Skeleton, list: &[Additional], poses: &mut [Transform]) {
    for additional in list {
        one::apply_one(skeleton, additional, poses);
    }
}
