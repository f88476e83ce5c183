//! The rest pose of a capture, on the ground.

use crate::animation::to_root;
use crate::data::{BoneIndex, Skeleton, Take, Transform};
use crate::sample::sample_take;
use glam::{Mat4, Vec3};
use std::borrow::Cow;

/// Part of the depth below the ground by which the take must raise the figure.
const RAISED: f32 = 0.5;

/// Returns the skeleton with its rest pose raised to the ground, where the rest pose hangs below the ground and the take raises it:
/// files of captures leave the hips at the origin, and their height is in the motion alone. Without this, the height of the hips
/// would be added to that of the target's hips.
///
/// `hips` is the bone that carries the figure. A skeleton that stands on the ground, or whose take stays below it, is returned as it is.
pub(super) fn standing<'a>(
    source: &'a Skeleton,
    take: &Take,
    hips: BoneIndex,
    up: Vec3,
) -> Cow<'a, Skeleton> {
    let rest = matrices(source, None, 0.0);
    let depth = -lowest(&rest, up);
    let begin = lowest(&matrices(source, Some(take), take.start), up);
    // Also false for numbers that are not finite.
    if !(depth > 0.0 && begin + depth > RAISED * depth) {
        return Cow::Borrowed(source);
    }
    let Some(raised) = raised_bone(source, take, hips) else { return Cow::Borrowed(source) };
    let parent = source.bones[raised as usize].parent.and_then(|parent| rest.get(parent as usize));
    let inverse = parent.map_or(Mat4::IDENTITY, Mat4::inverse);
    let by = inverse.transform_vector3(up * depth);
    if !by.is_finite() {
        return Cow::Borrowed(source);
    }
    let mut standing = source.clone();
    let bone = &mut standing.bones[raised as usize];
    bone.rest.translation += by;
    if let Some(matrix) = &mut bone.rest_matrix {
        matrix.w_axis += by.extend(0.0);
    }
    Cow::Owned(standing)
}

/// Returns the topmost bone with keys of translation, of the hips and the bones above them.
fn raised_bone(source: &Skeleton, take: &Take, hips: BoneIndex) -> Option<BoneIndex> {
    let is_moved =
        |bone: &BoneIndex| take.tracks.get(*bone as usize).is_some_and(|track| !track.translation.is_empty());
    source.with_ancestors(hips).filter(is_moved).last()
}

fn matrices(source: &Skeleton, take: Option<&Take>, time: f32) -> Vec<Mat4> {
    let mut poses = vec![Transform::IDENTITY; source.len()];
    let mut matrices = vec![Mat4::IDENTITY; source.len()];
    sample_take(take, source, time, &mut poses);
    to_root(source, &poses, &mut matrices);
    matrices
}

/// Returns the height of the lowest bone.
fn lowest(matrices: &[Mat4], up: Vec3) -> f32 {
    matrices.iter().map(|matrix| matrix.w_axis.truncate().dot(up)).fold(f32::INFINITY, f32::min)
}
