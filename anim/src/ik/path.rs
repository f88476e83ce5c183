//! Paths down the tree of bones.

use super::IkError;
use crate::animation::to_parent;
use crate::data::{BoneIndex, Skeleton, Transform};
use glam::{Mat3, Mat4, Vec3};

/// Returns the pose of `bone`, when both it and the bone exist.
pub(super) fn pose_of(
    skeleton: &Skeleton,
    poses: &[Transform],
    bone: BoneIndex,
) -> Result<Transform, IkError> {
    let missing = IkError::NoSuchBone { bone };
    skeleton.bones.get(bone as usize).ok_or(missing)?;
    poses.get(bone as usize).copied().ok_or(missing)
}

/// Returns to-root of the parent of `bone`: the identity for a root.
pub(super) fn parent_to_root(
    skeleton: &Skeleton,
    to_root: &[Mat4],
    bone: BoneIndex,
) -> Result<Mat4, IkError> {
    match skeleton.parent(bone) {
        Some(parent) => {
            let matrix = to_root.get(parent as usize).copied().ok_or(IkError::NoSuchBone { bone: parent })?;
            if matrix.is_finite() { Ok(matrix) } else { Err(IkError::NotFinite { bone }) }
        }
        None => Ok(Mat4::IDENTITY),
    }
}

/// The transform between two bones of a chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// Origin of the lower bone in the space of the upper one.
    pub(super) origin: Vec3,
    /// Space of the lower bone's parent → space of the upper bone; `None` where those are the same.
    pub(super) between: Option<Mat3>,
}

/// Returns the segment from `above` to `below`; bones between them keep their poses.
pub(super) fn segment(
    skeleton: &Skeleton,
    poses: &[Transform],
    above: BoneIndex,
    below: BoneIndex,
) -> Result<Segment, IkError> {
    let mut origin = pose_of(skeleton, poses, below)?.translation;
    let mut between: Option<Mat3> = None;
    let mut bone = below;
    loop {
        bone = skeleton.parent(bone).ok_or(IkError::NotBelow { above, below })?;
        if bone == above {
            return Ok(Segment { origin, between });
        }
        let matrix = to_parent(&skeleton.bones[bone as usize], pose_of(skeleton, poses, bone)?);
        origin = matrix.transform_point3(origin);
        let linear = Mat3::from_mat4(matrix);
        between = Some(between.map_or(linear, |lower| linear * lower));
    }
}
