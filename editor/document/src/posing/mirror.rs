//! Mirrors poses: the other side of the body gets the pose of one side.

use crate::bones::{MirrorPairs, MirrorPlane, Stance};
use dragonfly_anim::data::{BoneIndex, Skeleton};
use glam::{Mat3, Mat4, Quat, Vec3};

/// Mirrors poses of one skeleton. Each pose is compared with the pose in which the skeleton is symmetric, so the bones
/// of the two sides may have any axes.
#[derive(Clone, Debug)]
pub struct Mirror {
    /// The pairs of bones.
    pub pairs: MirrorPairs,
    /// The mirror plane.
    pub plane: MirrorPlane,
    stances: Vec<BoneStance>,
}

/// A bone in the symmetric pose of the skeleton, from which mirrored poses are measured.
#[derive(Clone, Copy, Debug)]
struct BoneStance {
    /// Matrix from the space of the parent to scene space, without the translation.
    parent: Mat3,
    parent_turn: Quat,
    /// In the space of the parent.
    translation: Vec3,
    rotation: Quat,
    scale: Vec3,
}

impl Mirror {
    /// Finds the pairs and the mirror plane of a skeleton. Takes time in proportion to its bones.
    pub fn of(skeleton: &Skeleton) -> Self {
        Self::with(skeleton, MirrorPairs::of(skeleton))
    }

    /// Finds the mirror plane of a skeleton with these pairs.
    pub fn with(skeleton: &Skeleton, pairs: MirrorPairs) -> Self {
        let Stance { to_root, plane, .. } = Stance::of(skeleton, &pairs.pairs);
        let stance = |(index, bone): (usize, &dragonfly_anim::data::Bone)| {
            let parent = bone.parent.and_then(|parent| to_root.get(parent as usize)).copied();
            let parent = parent.filter(|matrix| matrix.determinant().abs() > 1e-18).unwrap_or(Mat4::IDENTITY);
            let local = parent.inverse() * to_root[index];
            let (scale, rotation, translation) = parts(&local);
            BoneStance {
                parent: Mat3::from_mat4(parent),
                parent_turn: parts(&parent).1,
                translation,
                rotation,
                scale,
            }
        };
        let stances = skeleton.bones.iter().enumerate().map(stance).collect();
        Self { pairs, plane, stances }
    }

    /// Returns the bone that gets the mirrored pose of a bone; `None` where the other side is missing.
    pub fn target(&self, bone: BoneIndex) -> Option<BoneIndex> {
        self.pairs.mirror_of(bone)
    }

    /// Returns the translation of the mirror bone for a translation of `bone` (both in parent space).
    pub fn translation(&self, bone: BoneIndex, translation: Vec3) -> Option<Vec3> {
        let (from, to) = self.both(bone)?;
        let moved = self.plane.direction(from.parent * (translation - from.translation));
        let moved = to.translation + to.parent.inverse() * moved;
        moved.is_finite().then_some(moved)
    }

    /// Returns the rotation of the mirror bone for a rotation of `bone` (both in parent space, unit length).
    pub fn rotation(&self, bone: BoneIndex, rotation: Quat) -> Option<Quat> {
        let turned = self.rotation_rate(bone, rotation)?;
        (turned.length_squared() > 1e-12).then(|| turned.normalize())
    }

    /// Returns the rate of change of the mirror bone's rotation for one of `bone`: [`Self::rotation`] without normalizing,
    /// which is linear.
    pub fn rotation_rate(&self, bone: BoneIndex, rate: Quat) -> Option<Quat> {
        let (from, to) = self.both(bone)?;
        let turn = from.parent_turn * (rate * from.rotation.inverse()) * from.parent_turn.inverse();
        // A mirror reverses the sense of a rotation: the axis is mirrored and negated, and the angle stays.
        let axis = -self.plane.direction(Vec3::new(turn.x, turn.y, turn.z));
        let turn = Quat::from_xyzw(axis.x, axis.y, axis.z, turn.w);
        let turned = to.parent_turn.inverse() * turn * to.parent_turn * to.rotation;
        turned.is_finite().then_some(turned)
    }

    /// Returns the scale of the mirror bone for a scale of `bone`.
    pub fn scale(&self, bone: BoneIndex, scale: Vec3) -> Option<Vec3> {
        let (from, to) = self.both(bone)?;
        let scaled = to.scale * (scale / from.scale);
        scaled.is_finite().then_some(scaled)
    }

    fn both(&self, bone: BoneIndex) -> Option<(&BoneStance, &BoneStance)> {
        Some((self.stances.get(bone as usize)?, self.stances.get(self.target(bone)? as usize)?))
    }
}

/// Returns scale, rotation and translation of a matrix; those of the identity where it cannot be decomposed.
fn parts(matrix: &Mat4) -> (Vec3, Quat, Vec3) {
    let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
    let whole = scale.is_finite() && rotation.is_finite() && translation.is_finite();
    if whole && rotation.length_squared() > 0.5 {
        (scale, rotation.normalize(), translation)
    } else {
        (Vec3::ONE, Quat::IDENTITY, Vec3::ZERO)
    }
}
