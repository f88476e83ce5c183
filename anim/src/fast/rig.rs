//! A skeleton in the layout of the fast path.

use super::pose::Pose;
use super::tiny::{flushed, largest};
use crate::data::{Skeleton, Transform};
use crate::sample::rest_pose;
use glam::Mat4;

/// Number of matrices that a byte can index.
pub(super) const NARROW: usize = 256;

/// The fast path's copy of a skeleton: the parents, the rest pose, and the exceptional bones.
///
/// Built once; unlike the skeleton it never changes. Bones keep their order.
#[derive(Clone, Debug)]
pub struct Rig {
    pub(super) bones: usize,
    /// One number per bone: 0 for a root, else 1 + the parent.
    parents: Vec<u32>,
    /// The bones that have a parent, those of one depth after the other: neighbors in this order do not wait for each
    /// other.
    pub(super) links: Vec<Link<u32>>,
    /// 1 + each bone without children: a number that is not finite reaches at least one of them.
    pub(super) leaves: Vec<u32>,
    /// `links` as bytes, and `leaves` below, if a byte can index all bones; otherwise empty.
    pub(super) near_links: Vec<Link<u8>>,
    pub(super) near_leaves: Vec<u8>,
    /// Bones whose rest pose is a sheared matrix, in order.
    pub(super) sheared: Vec<Sheared>,
    rest: Pose,
}

/// 1 + a bone, and 1 + its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link<P> {
    pub(super) own: P,
    pub(super) parent: P,
}

/// A bone with a rest matrix that is no translation, rotation and scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sheared {
    pub(super) bone: usize,
    /// The approximate pose that represents the matrix.
    pub(super) rest: Transform,
    pub(super) matrix: Mat4,
}

impl Rig {
    /// Creates the rig of `skeleton`. A parent that does not come before its child is ignored.
    pub fn new(skeleton: &Skeleton) -> Self {
        let bones = skeleton.len();
        let (mut parents, mut depths) = (vec![0; bones], vec![0_u32; bones]);
        let mut is_leaf = vec![true; bones];
        for (index, bone) in skeleton.bones.iter().enumerate() {
            let parent = bone.parent.map(|parent| parent as usize).filter(|&parent| parent < index);
            if let Some(parent) = parent {
                parents[index] = parent as u32 + 1;
                depths[index] = depths[parent] + 1;
                is_leaf[parent] = false;
            }
        }
        let rest = flushed_poses(skeleton.bones.iter().map(rest_pose).collect());
        let sheared = skeleton.bones.iter().enumerate().filter_map(|(bone, data)| {
            let matrix = data.rest_matrix.filter(Mat4::is_finite)?;
            Some(Sheared { bone, rest: rest[bone], matrix })
        });
        let leaves: Vec<u32> =
            (0..bones as u32).filter(|&bone| is_leaf[bone as usize]).map(|bone| bone + 1).collect();
        let mut links: Vec<Link<u32>> = (1..=bones as u32)
            .zip(&parents)
            .filter(|&(_, &parent)| parent > 0)
            .map(|(own, &parent)| Link { own, parent })
            .collect();
        // Stable: bones of one depth keep their order.
        links.sort_by_key(|link| depths[link.own as usize - 1]);
        let is_near = bones < NARROW;
        let near = |slot: u32| u8::try_from(slot).unwrap_or(0);
        Self {
            bones,
            near_links: links
                .iter()
                .filter(|_| is_near)
                .map(|link| Link { own: near(link.own), parent: near(link.parent) })
                .collect(),
            near_leaves: leaves.iter().filter(|_| is_near).map(|&leaf| near(leaf)).collect(),
            parents,
            links,
            leaves,
            sheared: sheared.collect(),
            rest: Pose::from_transforms(&rest),
        }
    }

    /// Returns the number of bones.
    pub fn bones(&self) -> usize {
        self.bones
    }

    /// Returns the rest pose of every bone, as from [`rest_pose`], with tiny numbers set to zero.
    pub fn rest(&self) -> &Pose {
        &self.rest
    }

    /// Returns one number per bone: 0 for a root, else 1 + the parent.
    pub(super) fn parents(&self) -> &[u32] {
        &self.parents
    }

    /// Returns every bone, those of one depth after the other; the parent of a root is 0.
    pub(super) fn by_depth(&self) -> impl Iterator<Item = Link<u32>> {
        let roots = (1..).zip(&self.parents).filter(|&(_, &parent)| parent == 0);
        roots.map(|(own, _)| Link { own, parent: 0 }).chain(self.links.iter().copied())
    }

    /// Returns the parent of `bone`; `None` for a root and past the end.
    pub fn parent(&self, bone: usize) -> Option<usize> {
        let parent = *self.parents.get(bone)?;
        parent.checked_sub(1).map(|parent| parent as usize)
    }
}

/// Returns `poses` with insignificant numbers set to zero.
pub(super) fn flushed_poses(mut poses: Vec<Transform>) -> Vec<Transform> {
    let size = largest(poses.iter().flat_map(|pose| pose.translation.to_array()));
    for pose in &mut poses {
        pose.translation = pose.translation.to_array().map(|value| flushed(value, size)).into();
        pose.rotation = glam::Quat::from_array(pose.rotation.to_array().map(|value| flushed(value, 1.0)));
        let size = largest(pose.scale.to_array());
        pose.scale = pose.scale.to_array().map(|value| flushed(value, size)).into();
    }
    poses
}
