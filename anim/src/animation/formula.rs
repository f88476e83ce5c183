//! The two products that turn poses of bones into matrices (thesis §2.1.5.1).
//!
//! ```text
//! to_root_i = to_root_parent * to_parent_i        thesis: ToRoot_i = ToParent_i · ToRoot_p
//! final_i   = to_root_i * offset_i                thesis: Final_i  = Offset_i · ToRoot_i
//! ```
//!
//! The thesis multiplies row vectors, glam column vectors; only the order of the factors differs.
//!
//! Both are total: where a product is not finite (numbers near the limit of f32), the result is the factor that is
//! known to be finite, so no result ever contains a NaN or an infinity. Finite products are not changed.

use crate::data::{Bone, Skeleton, Skin, Transform};
use crate::sample::rest_pose;
use glam::Mat4;

/// Returns `to_parent` of one bone: bone space → parent space.
///
/// The matrix `T · R · S` of `pose`. A bone in its rest pose whose rest is sheared gives the exact rest matrix, which
/// no pose could express.
#[doc(alias("local space", "local matrix"))]
pub fn to_parent(bone: &Bone, pose: Transform) -> Mat4 {
    match bone.rest_matrix {
        Some(matrix) if matrix.is_finite() && pose == rest_pose(bone) => matrix,
        _ => pose.to_matrix(),
    }
}

/// Computes `to_root` of every bone: bone space → scene space, from poses relative to the parents.
///
/// One pass in index order, because parents come before children: O(number of bones). Where `poses` is shorter than the
/// skeleton, rest poses are used. A bone whose product is not finite gets its parent's `to_root` (a root: the
/// identity); a parent that does not come before its child is ignored. Allocates nothing.
#[doc(alias("model space", "global transform", "world matrix"))]
pub fn to_root(skeleton: &Skeleton, poses: &[Transform], out: &mut [Mat4]) {
    let count = skeleton.len().min(out.len());
    for (index, bone) in skeleton.bones.iter().enumerate().take(count) {
        let pose = poses.get(index).copied().unwrap_or_else(|| rest_pose(bone));
        let to_parent = to_parent(bone, pose);
        let parent = bone.parent.map(|parent| parent as usize).filter(|&parent| parent < index);
        out[index] = child_to_root(parent.map(|parent| out[parent]), to_parent);
    }
}

/// Returns `to_root` of one bone from that of its parent: the step that [`to_root()`] does for each bone.
pub(crate) fn child_to_root(parent: Option<Mat4>, to_parent: Mat4) -> Mat4 {
    let (product, fallback) = match parent {
        Some(parent) => (parent * to_parent, parent),
        None => (to_parent, Mat4::IDENTITY),
    };
    if product.is_finite() { product } else { fallback }
}

/// Computes `final_pose` of every joint of `skin`, in the skin's order: bind space → scene space.
///
/// `to_root` is the result of [`to_root()`] for the skeleton. A missing offset is the identity; where the product is
/// not finite, the result is `to_root` alone; a joint whose bone does not exist gives the identity. Allocates nothing.
#[doc(alias("skinning matrices", "joint matrices"))]
pub fn final_poses(skin: &Skin, to_root: &[Mat4], out: &mut [Mat4]) {
    for (joint, (&bone, out)) in skin.bones.iter().zip(out).enumerate() {
        let to_root = to_root.get(bone as usize).copied().unwrap_or(Mat4::IDENTITY);
        *out = final_pose(to_root, skin.offsets.get(joint).copied().unwrap_or(Mat4::IDENTITY));
    }
}

/// Returns `to_root * offset`, or `to_root` alone where that is not finite.
#[doc(alias = "skinning matrix")]
pub fn final_pose(to_root: Mat4, offset: Mat4) -> Mat4 {
    let product = to_root * offset;
    if product.is_finite() { product } else { to_root }
}
