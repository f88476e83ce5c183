//! The parent space of a bone.

use crate::animation::to_parent;
use crate::data::{BoneIndex, Skeleton, Transform};
use crate::sample::rest_pose;
use glam::Mat4;

/// Returns `to_root` of the parent of bone number `index` for the given poses: parent space → scene space; the identity
/// for a root.
///
/// The same product as [`crate::animation::to_root`](crate::animation::to_root()), for one chain only and from the bone
/// upwards; a parent that does not come before its child is ignored.
pub(super) fn parent_to_root(skeleton: &Skeleton, index: usize, poses: &[Transform]) -> Mat4 {
    let mut to_root = Mat4::IDENTITY;
    for above in skeleton.ancestors(index as BoneIndex).map(|above| above as usize) {
        let bone = &skeleton.bones[above];
        let pose = poses.get(above).copied().unwrap_or_else(|| rest_pose(bone));
        to_root = to_parent(bone, pose) * to_root;
    }
    to_root
}
