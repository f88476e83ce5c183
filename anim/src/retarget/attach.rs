//! Feet that are not below their legs.
//!
//! Some rigs have feet that hang at the root and are moved by a constraint in the program that made them (Quaternius). They are
//! retargeted on a copy of the skeleton in which each foot is a child of its lower leg, and then get keys of their own.

use super::SkeletonBinding;
use super::convention::{BodyPart, BoneRole, SkeletonRoles};
use crate::animation::to_root;
use crate::data::{BoneIndex, Channel, Interpolation, Skeleton, Take, Track, Transform};
use crate::sample::{rest_pose, sample_take};
use glam::{Mat4, Quat, Vec3};

/// A skeleton whose feet are below their legs, and the way back.
pub(super) struct AttachedFeet {
    pub(super) skeleton: Skeleton,
    /// For each bone of it the bone of the original skeleton.
    order: Vec<usize>,
    /// Feet, bones of the original skeleton.
    feet: Vec<usize>,
}

impl AttachedFeet {
    /// Returns the skeleton with attached feet; `None` where all feet are below their legs.
    pub(super) fn of(skeleton: &Skeleton, roles: &SkeletonRoles) -> Option<Self> {
        let bone = |part, side| roles.bones(BoneRole { part, side }).first().map(|&bone| bone as usize);
        let parent_of = |bone: usize| skeleton.bones[bone].parent.map(|parent| parent as usize);
        let is_below = |bone: usize, above: usize| {
            std::iter::successors(Some(bone), |&bone| parent_of(bone)).any(|one| one == above)
        };
        let mut parents: Vec<Option<usize>> = (0..skeleton.len()).map(parent_of).collect();
        let mut feet = Vec::new();
        for side in [1, 2] {
            let Some(leg) = bone(BodyPart::LowerLeg, side) else { continue };
            let Some(foot) = bone(BodyPart::Foot, side).filter(|&foot| !is_below(foot, leg)) else {
                continue;
            };
            if !is_below(leg, foot) {
                parents[foot] = Some(leg);
                feet.push(foot);
            }
        }
        if feet.is_empty() {
            return None;
        }
        let order = parents_first(&parents);
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(new, &old)| place[old] = new);
        let mut matrices = vec![Mat4::IDENTITY; skeleton.len()];
        to_root(skeleton, &[], &mut matrices);
        let bones = order.iter().map(|&old| {
            let mut bone = skeleton.bones[old].clone();
            bone.parent = parents[old].map(|parent| place[parent] as BoneIndex);
            if let Some(leg) = parents[old].filter(|_| feet.contains(&old)) {
                bone.rest = parts(matrices[leg].inverse() * matrices[old]);
                bone.rest_matrix = None;
            }
            bone
        });
        Some(Self { skeleton: Skeleton { bones: bones.collect() }, order, feet })
    }

    /// Returns the binding with the bones of this skeleton.
    pub(super) fn binding(&self, binding: &SkeletonBinding) -> SkeletonBinding {
        let source_of = self.order.iter().map(|&old| binding.source_of.get(old).copied().flatten()).collect();
        let unbound = |bone: &usize| binding.source_of.get(self.order[*bone]).copied().flatten().is_none();
        let unbound_target = (0..self.order.len()).filter(unbound).map(|bone| bone as BoneIndex).collect();
        SkeletonBinding { source_of, unbound_source: binding.unbound_source.clone(), unbound_target }
    }

    /// Returns the bone of the original skeleton.
    pub(super) fn original(&self, bone: BoneIndex) -> BoneIndex {
        self.order.get(bone as usize).map_or(bone, |&old| old as BoneIndex)
    }

    /// Converts a take to the original skeleton, with keys of the feet at `times`.
    pub(super) fn detached(&self, take: &Take, original: &Skeleton, times: &[f32]) -> Take {
        let mut tracks: Vec<Track> =
            (0..self.order.len()).map(|bone| Track { bone: bone as BoneIndex, ..Track::default() }).collect();
        for (new, &old) in self.order.iter().enumerate() {
            if let Some(track) = take.tracks.get(new) {
                tracks[old] = Track { bone: old as BoneIndex, ..track.clone() };
            }
        }
        let mut poses = vec![Transform::IDENTITY; self.order.len()];
        let mut matrices = vec![Mat4::IDENTITY; self.order.len()];
        let mut keys: Vec<Vec<(Vec3, Quat)>> = vec![Vec::new(); self.feet.len()];
        let place = |old: usize| self.order.iter().position(|&one| one == old).unwrap_or_default();
        for &time in times {
            sample_take(Some(take), &self.skeleton, time, &mut poses);
            to_root(&self.skeleton, &poses, &mut matrices);
            for (keys, &foot) in keys.iter_mut().zip(&self.feet) {
                let parent = original.bones[foot]
                    .parent
                    .map_or(Mat4::IDENTITY, |parent| matrices[place(parent as usize)]);
                let local = parts(parent.inverse() * matrices[place(foot)]);
                let before: Quat =
                    keys.last().map_or(rest_pose(&original.bones[foot]).rotation, |(_, turn)| *turn);
                let turn = if before.dot(local.rotation) < 0.0 { -local.rotation } else { local.rotation };
                keys.push((local.translation, turn));
            }
        }
        for (keys, &foot) in keys.into_iter().zip(&self.feet) {
            let (translations, rotations): (Vec<Vec3>, Vec<Quat>) = keys.into_iter().unzip();
            tracks[foot].translation = Channel::new(times, translations, Interpolation::Linear);
            tracks[foot].rotation = Channel::new(times, rotations, Interpolation::Linear);
        }
        Take { tracks, morphs: Vec::new(), ..take.clone() }
    }
}

/// Returns all bones, each after its parent.
fn parents_first(parents: &[Option<usize>]) -> Vec<usize> {
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); parents.len()];
    let mut stack = Vec::new();
    for bone in (0..parents.len()).rev() {
        match parents[bone] {
            Some(parent) => children[parent].push(bone),
            None => stack.push(bone),
        }
    }
    let mut order = Vec::with_capacity(parents.len());
    while let Some(bone) = stack.pop() {
        order.push(bone);
        stack.extend(&children[bone]);
    }
    order
}

fn parts(matrix: Mat4) -> Transform {
    let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
    Transform { translation, rotation: rotation.normalize(), scale }
}
