//! Rotates a chain of bones so that its end reaches a position, with a pole, joint limits and the rotation of the end.

use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{BoneIndex, Skeleton, Transform};
use dragonfly_anim::ik::{Chain, ChainScratch, EndOrientation, Pole, TwoBone, chain, two_bone};
use dragonfly_anim::joint::JointLimits;
use dragonfly_anim::trig::rotation_about;
use glam::{Mat4, Quat, Vec3};
use std::collections::BTreeMap;

/// A goal of a chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reaching {
    /// The bone that reaches the position. It does not count towards `length`.
    pub(super) end: BoneIndex,
    /// Number of bones above it that rotate, at least 1.
    pub(super) length: u32,
    /// Position to reach, scene space.
    pub(super) place: Vec3,
    /// Rotation that the end gets, scene space; without one it rotates with the bone above it.
    pub(super) rotation: Option<Quat>,
    /// Position towards which the chain bends, scene space.
    pub(super) pole: Option<Vec3>,
}

/// Solves chains, one after another, on the poses of a skeleton.
pub(super) struct ChainSolver<'a> {
    pub(super) skeleton: &'a Skeleton,
    pub(super) limits: Option<&'a JointLimits>,
    /// Bones that keep these rotations.
    pub(super) fixed: &'a BTreeMap<BoneIndex, Quat>,
    pub(super) poses: &'a mut [Transform],
    pub(super) to_root: &'a mut [Mat4],
    pub(super) scratch: &'a mut ChainScratch,
}

/// Returns the bones above `end` that rotate, the nearest first: at most `length` of them.
pub(super) fn row(skeleton: &Skeleton, end: BoneIndex, length: u32) -> impl Iterator<Item = BoneIndex> + '_ {
    skeleton.ancestors(end).take(length.max(1) as usize)
}

impl ChainSolver<'_> {
    /// Updates the matrices from the poses.
    pub(super) fn chain_poses(&mut self) {
        to_root(self.skeleton, self.poses, self.to_root);
    }

    /// Rotates a chain so that its end comes as near to its goal as possible. Where there is no solution, nothing
    /// moves.
    pub(super) fn reach(&mut self, wanted: &Reaching) {
        let limits = self.limits;
        let is_limited = |bone: BoneIndex| {
            self.fixed.contains_key(&bone) || limits.is_some_and(|limits| limits.get(bone).is_some())
        };
        let mut above = row(self.skeleton, wanted.end, wanted.length);
        let (Some(middle), rest) = (above.next(), above.last()) else { return };
        let limited = row(self.skeleton, wanted.end, wanted.length).any(is_limited);
        let root = rest.unwrap_or(middle);
        let solved = wanted.length == 2 && root != middle && !limited && {
            let mut limb = TwoBone::new(root, middle, wanted.end);
            limb.pole = wanted.pole.map_or(Pole::AsPosed, Pole::Point);
            limb.end_orientation =
                wanted.rotation.map_or(EndOrientation::FollowParent, EndOrientation::SetToRoot);
            two_bone(self.skeleton, self.to_root, &limb, wanted.place, self.poses).is_ok()
        };
        if !solved {
            self.reach_by_chain(root, limited, wanted);
        }
        self.chain_poses();
        if let Some(rotation) = wanted.rotation {
            self.turn_to(wanted.end, rotation);
        }
    }

    fn reach_by_chain(&mut self, root: BoneIndex, limited: bool, wanted: &Reaching) {
        let (skeleton, limits, fixed) = (self.skeleton, self.limits, self.fixed);
        let mut clamp = |bone: BoneIndex, rotation: Quat| {
            if let Some(&rotation) = fixed.get(&bone) {
                return rotation;
            }
            let rest = skeleton.bones.get(bone as usize).map_or(Quat::IDENTITY, |bone| bone.rest.rotation);
            let limit = limits.and_then(|limits| limits.get(bone));
            limit.map_or(rotation, |limit| limit.clamp(rotation, rest).rotation)
        };
        // The chain is turned towards the pole first, so that it bends to that side and keeps the side when it reaches.
        if let Some(pole) = wanted.pole.filter(|_| !limited) {
            self.swing(root, wanted, pole);
        }
        let mut row = Chain::new(root, wanted.end);
        row.tolerance = 1e-6;
        let limit: Option<dragonfly_anim::ik::Limit<'_>> = if limited { Some(&mut clamp) } else { None };
        let found = chain(skeleton, self.to_root, &row, wanted.place, limit, self.scratch, self.poses);
        if found.is_ok() {
            self.chain_poses();
            if let Some(pole) = wanted.pole.filter(|_| !limited) {
                self.swing(root, wanted, pole);
            }
        }
    }

    /// Rotates a chain about the line from its root to its end until the joint farthest from that line points to the
    /// pole.
    fn swing(&mut self, root: BoneIndex, wanted: &Reaching, pole: Vec3) {
        let place = |bone: BoneIndex| self.to_root[bone as usize].w_axis.truncate();
        let (begin, end) = (place(root), place(wanted.end));
        let Some(axis) = (end - begin).try_normalize() else { return };
        let aside = |point: Vec3| (point - begin) - axis * (point - begin).dot(axis);
        let joints = row(self.skeleton, wanted.end, wanted.length).map(|bone| aside(place(bone)));
        let Some(bend) = joints.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared())) else {
            return;
        };
        let towards = aside(pole);
        let (Some(bend), Some(towards)) = (bend.try_normalize(), towards.try_normalize()) else { return };
        let angle = libm::atan2f(axis.dot(bend.cross(towards)), bend.dot(towards));
        let (_, now, _) = self.to_root[root as usize].to_scale_rotation_translation();
        self.turn_to(root, rotation_about(axis.as_dvec3(), f64::from(angle)).as_quat() * now);
    }

    /// Gives a bone this rotation in scene space.
    pub(super) fn turn_to(&mut self, bone: BoneIndex, rotation: Quat) {
        let parent = self
            .skeleton
            .parent(bone)
            .and_then(|parent| self.to_root.get(parent as usize))
            .map_or(Quat::IDENTITY, |matrix| matrix.to_scale_rotation_translation().1);
        let local = parent.inverse() * rotation;
        let Some(pose) = self.poses.get_mut(bone as usize) else { return };
        if local.is_finite() && local.length_squared() > 0.5 {
            let local = local.normalize();
            // With the sign of the previous rotation, so that nothing flips.
            pose.rotation = if local.dot(pose.rotation) < 0.0 { -local } else { local };
            self.chain_poses();
        }
    }
}
