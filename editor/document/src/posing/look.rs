//! Rotates bones so that they look at a position.

use crate::edit::{BonePose, BoneRef};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{BoneIndex, Skeleton, Transform};
use dragonfly_anim::ik::{Gaze, LookAt, look_at as solve};
use glam::{Mat4, Vec3};

/// Returns the axis along which a bone looks, in its own space: towards its children; without children, away from its
/// parent; for a bone at the joint of its parent, y.
pub fn forward_of(skeleton: &Skeleton, poses: &[Transform], bone: BoneIndex) -> Vec3 {
    let children: Vec3 = skeleton
        .children(Some(bone))
        .filter_map(|child| poses.get(child as usize))
        .filter_map(|pose| pose.translation.is_finite().then_some(pose.translation))
        .sum();
    let own = poses.get(bone as usize).copied().unwrap_or(Transform::IDENTITY);
    let onwards = own.rotation.inverse() * own.translation;
    [children, onwards].into_iter().find_map(|axis| axis.try_normalize()).unwrap_or(Vec3::Y)
}

/// Returns the poses in which `bones` look at `target` (scene space), parents before children. A bone at the target
/// itself, or in a space without volume, stays as it is.
pub fn look_at(skeleton: &Skeleton, poses: &[Transform], bones: &[BoneIndex], target: Vec3) -> Vec<BonePose> {
    let count = skeleton.len();
    let mut now: Vec<Transform> =
        (0..count).map(|bone| poses.get(bone).copied().unwrap_or(skeleton.bones[bone].rest)).collect();
    let mut matrices = vec![Mat4::IDENTITY; count];
    let mut bones: Vec<BoneIndex> = bones.iter().copied().filter(|&bone| (bone as usize) < count).collect();
    bones.sort_unstable();
    bones.dedup();
    let mut found = Vec::with_capacity(bones.len());
    for bone in bones {
        to_root(skeleton, &now, &mut matrices);
        let gaze = [Gaze::new(bone, forward_of(skeleton, &now, bone))];
        let before = now[bone as usize].rotation;
        let solved = solve(skeleton, &matrices, &LookAt::new(&gaze), target, &mut now).is_ok();
        let rotation = &mut now[bone as usize].rotation;
        if !solved || !rotation.is_finite() {
            *rotation = before;
            continue;
        }
        if rotation.dot(before) < 0.0 {
            *rotation = -*rotation;
        }
        let rotation = Some(rotation.to_array());
        found.push(BonePose { bone: BoneRef::Index(bone), translation: None, rotation, scale: None });
    }
    found
}
