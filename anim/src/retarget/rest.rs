//! Comparison of two rest poses: directions and sizes.

use super::SkeletonBinding;
use crate::animation::to_root;
use crate::data::{BoneIndex, Skeleton};
use crate::ik::turn::arc_between;
use crate::sample::rest_pose;
use glam::{DMat3, DQuat, DVec3, Mat4, Vec3};

/// Tolerance in radians (5°): if one rotation aligns the directions to several children within this, they have the same
/// shape in another pose.
pub const SAME_SHAPE: f64 = 0.087_27;

/// A skeleton in its rest pose.
pub(super) struct RestPose {
    /// Bone space → to-root space.
    pub(super) to_root: Vec<Mat4>,
    /// Product of the rotations down to the bone.
    pub(super) turned: Vec<DQuat>,
    /// Relative to the parent.
    pub(super) own: Vec<DQuat>,
}

impl RestPose {
    pub(super) fn of(skeleton: &Skeleton) -> Self {
        let mut matrices = vec![Mat4::IDENTITY; skeleton.len()];
        to_root(skeleton, &[], &mut matrices);
        let (mut turned, mut own) = (Vec::new(), Vec::new());
        for (index, bone) in skeleton.bones.iter().enumerate() {
            let rotation = rest_pose(bone).rotation.as_dquat().normalize();
            let above = parent_of(skeleton, index).map_or(DQuat::IDENTITY, |parent| turned[parent]);
            own.push(rotation);
            turned.push((above * rotation).normalize());
        }
        Self { to_root: matrices, turned, own }
    }

    /// Returns the origin of a bone, to-root space.
    pub(super) fn origin(&self, bone: usize) -> DVec3 {
        self.to_root[bone].w_axis.truncate().as_dvec3()
    }
}

/// Returns the parent of a bone; a parent that does not come before its child is ignored.
pub(super) fn parent_of(skeleton: &Skeleton, bone: usize) -> Option<usize> {
    skeleton.parent(bone as BoneIndex).map(|parent| parent as usize)
}

/// Returns the bone of the source that moves bone `bone` of the target.
pub(super) fn source_of(binding: &SkeletonBinding, source: &Skeleton, bone: usize) -> Option<usize> {
    let bound = binding.source_of.get(bone).copied().flatten()? as usize;
    (bound < source.len()).then_some(bound)
}

/// Returns the nearest ancestor of `bone` in the target that is bound.
pub(super) fn bound_above(
    binding: &SkeletonBinding,
    source: &Skeleton,
    target: &Skeleton,
    bone: usize,
) -> Option<usize> {
    let above = std::iter::successors(parent_of(target, bone), |&bone| parent_of(target, bone));
    above.into_iter().find(|&bone| source_of(binding, source, bone).is_some())
}

/// Returns `C` of every bone of the target.
pub(super) fn alignments(
    binding: &SkeletonBinding,
    (source, source_rest): (&Skeleton, &RestPose),
    (target, target_rest): (&Skeleton, &RestPose),
) -> Vec<DQuat> {
    let mut below: Vec<Vec<(DVec3, DVec3)>> = vec![Vec::new(); target.len()];
    for bone in 0..target.len() {
        let Some(from) = source_of(binding, source, bone) else { continue };
        let Some(above) = bound_above(binding, source, target, bone) else { continue };
        let Some(from_above) = source_of(binding, source, above) else { continue };
        let direction = target_rest.origin(bone) - target_rest.origin(above);
        let wanted = source_rest.origin(from) - source_rest.origin(from_above);
        if let (Some(direction), Some(wanted)) = (direction.try_normalize(), wanted.try_normalize()) {
            below[above].push((direction, wanted));
        }
    }
    let mut aligned: Vec<DQuat> = Vec::with_capacity(target.len());
    for (bone, pairs) in below.iter().enumerate() {
        let parent = parent_of(target, bone).map_or(DQuat::IDENTITY, |parent| aligned[parent]);
        aligned.push(match &pairs[..] {
            [] => parent,
            // Starts from the parent's alignment, so that the bone is not twisted relative to its parent.
            &[(direction, wanted)] => (arc_between(parent * direction, wanted) * parent).normalize(),
            several => common_turn(several).unwrap_or(parent),
        });
    }
    aligned
}

/// Returns the one rotation that aligns all first directions with the second ones within [`SAME_SHAPE`].
fn common_turn(pairs: &[(DVec3, DVec3)]) -> Option<DQuat> {
    let (first, first_wanted) = *pairs.first()?;
    let off_axis = |pair: &&(DVec3, DVec3)| first.cross(pair.0).length();
    let second = pairs.iter().max_by(|a, b| off_axis(a).total_cmp(&off_axis(b)))?;
    let turn = frame(first_wanted, second.1)? * frame(first, second.0)?.conjugate();
    let fits = |(direction, wanted): &(DVec3, DVec3)| angle_between(turn * *direction, *wanted) <= SAME_SHAPE;
    pairs.iter().all(fits).then(|| turn.normalize())
}

/// Returns the angle between two directions, radians.
fn angle_between(one: DVec3, other: DVec3) -> f64 {
    libm::atan2(one.cross(other).length(), one.dot(other))
}

/// Returns axes from two directions; `None` where they are parallel.
fn frame(first: DVec3, second: DVec3) -> Option<DQuat> {
    let third = first.cross(second);
    if third.length() < 1e-3 {
        return None;
    }
    let third = third.normalize();
    Some(DQuat::from_mat3(&DMat3::from_cols(first, third.cross(first), third)))
}

/// Returns the ratio of sizes, target to source: of the heights of the hips at rest over the lowest bound bone, along
/// `up`.
///
/// `hips` is a bone of the target. Where the hips are not bound, or one of the heights is below a thousandth of the
/// skeleton's size (a snake, a fish): the ratio of the summed distances of bound bones from their nearest bound
/// ancestor. 1 where that is undefined too. Always positive and finite.
pub fn height_ratio(
    source: &Skeleton,
    target: &Skeleton,
    binding: &SkeletonBinding,
    hips: BoneIndex,
    up: Vec3,
) -> f32 {
    let (source_rest, target_rest) = (RestPose::of(source), RestPose::of(target));
    let up = up.as_dvec3().try_normalize().unwrap_or(DVec3::Y);
    let (mut lowest, mut sizes) = ([f64::INFINITY; 2], [0.0; 2]);
    for bone in 0..target.len() {
        let Some(from) = source_of(binding, source, bone) else { continue };
        let origins = [source_rest.origin(from), target_rest.origin(bone)];
        lowest = [0, 1].map(|side| origins[side].dot(up).min(lowest[side]));
        let Some(above) = bound_above(binding, source, target, bone) else { continue };
        let Some(from_above) = source_of(binding, source, above) else { continue };
        let above = [source_rest.origin(from_above), target_rest.origin(above)];
        sizes = [0, 1].map(|side| sizes[side] + origins[side].distance(above[side]));
    }
    let hips = hips as usize;
    if let Some(from) = source_of(binding, source, hips) {
        let origins = [source_rest.origin(from), target_rest.origin(hips)];
        let heights = [0, 1].map(|side| origins[side].dot(up) - lowest[side]);
        if heights[0] > 1e-3 * sizes[0] && heights[1] > 1e-3 * sizes[1] {
            return usable(heights[1] / heights[0]).unwrap_or(1.0);
        }
    }
    usable(sizes[1] / sizes[0]).unwrap_or(1.0)
}

/// Returns the ratio of the lengths of a leg at rest, target to source: from `thigh` down to `foot`, bones of the
/// target.
///
/// `None` where one of the two is not bound, `foot` is not a descendant of `thigh`, or a leg has no length.
pub fn leg_ratio(
    source: &Skeleton,
    target: &Skeleton,
    binding: &SkeletonBinding,
    thigh: BoneIndex,
    foot: BoneIndex,
) -> Option<f32> {
    let from = |bone: BoneIndex| source_of(binding, source, bone as usize);
    let target_length = length(target, &RestPose::of(target), thigh as usize, foot as usize)?;
    let source_length = length(source, &RestPose::of(source), from(thigh)?, from(foot)?)?;
    usable(target_length / source_length)
}

/// Returns the length of the path from one bone down to another.
fn length(skeleton: &Skeleton, rest: &RestPose, above: usize, mut below: usize) -> Option<f64> {
    if below >= skeleton.len() {
        return None;
    }
    let mut length = 0.0;
    while below != above {
        let parent = parent_of(skeleton, below)?;
        length += rest.origin(below).distance(rest.origin(parent));
        below = parent;
    }
    Some(length)
}

fn usable(ratio: f64) -> Option<f32> {
    let ratio = ratio as f32;
    (ratio.is_finite() && ratio > 0.0).then_some(ratio)
}
