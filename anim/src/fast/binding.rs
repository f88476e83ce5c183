//! A skin in the layout of the fast path.

use super::matrix::{Matrix34, matrix34};
use super::rig::{Link, NARROW, Rig};
use super::tiny::{flushed, largest};
use crate::data::Skin;
use glam::Mat4;

/// A skin in the layout of the fast path: the bone of each joint, and its offset.
#[derive(Clone, Debug)]
pub struct SkinBinding {
    joints: Vec<BoundJoint>,
    /// Whether a byte can index every bone of the rig.
    is_near: bool,
    /// Every bone that a joint needs, those of one depth after the other.
    steps: Vec<ChainStep>,
    /// The use of each bone, in bone order.
    uses: Vec<BoneUse>,
    /// The joints that `steps` and `uses` do not have: of a bone that has another joint, or of no bone.
    further: Vec<u32>,
}

/// A joint's bone and offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundJoint {
    /// 1 + the bone; 0, the identity, for a bone that the rig does not have.
    pub(super) slot: u32,
    /// Bind space → bone space.
    pub(super) offset: [[f32; 4]; 3],
}

/// Use of a bone for the joints of a skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum BoneUse {
    /// Nothing, also of those below it.
    NotNeeded,
    /// Its matrix, for bones below it.
    Parent,
    /// Its matrix, for the joint of this number.
    Joint(u32),
}

/// A bone and its joint, in memory as wide as a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct ChainStep {
    /// Bind space → bone space.
    pub(super) offset: [[f32; 4]; 3],
    /// 1 + the bone.
    pub(super) own: u32,
    /// 1 + the parent; 0 for a root.
    pub(super) parent: u32,
    /// Number of the joint; [`NO_JOINT`].
    pub(super) joint: u32,
}

/// Stands for no joint: a number that no skin reaches.
const NO_JOINT: u32 = u32::MAX;
const NO_OFFSET: [[f32; 4]; 3] = [[0.0; 4]; 3];

impl SkinBinding {
    /// Creates the binding of `skin` to `rig`. An offset that is missing or not finite is the identity; tiny numbers
    /// become zero.
    pub fn new(rig: &Rig, skin: &Skin) -> Self {
        let offset = |joint: usize| {
            let offset = skin.offsets.get(joint).copied().unwrap_or(Mat4::IDENTITY);
            matrix34(if offset.is_finite() { offset } else { Mat4::IDENTITY })
        };
        let is_translation = |at: usize| at % 4 == 3;
        let mut offsets: Vec<Matrix34> = (0..skin.bones.len()).map(offset).collect();
        let far = largest(offsets.iter().flat_map(|offset| [offset[3], offset[7], offset[11]]));
        for offset in &mut offsets {
            let linear =
                largest(offset.iter().enumerate().filter(|(at, _)| !is_translation(*at)).map(|(_, v)| *v));
            for (at, value) in offset.iter_mut().enumerate() {
                *value = flushed(*value, if is_translation(at) { far } else { linear });
            }
        }
        let slot = |bone: u32| if (bone as usize) < rig.bones() { bone + 1 } else { 0 };
        let joints = skin.bones.iter().zip(offsets).map(|(&bone, offset)| {
            let [i, j, k] = [0, 4, 8].map(|row| [0, 1, 2, 3].map(|column| offset[row + column]));
            BoundJoint { slot: slot(bone), offset: [i, j, k] }
        });
        let joints: Vec<BoundJoint> = joints.collect();
        let (mut uses, mut further) = (vec![BoneUse::NotNeeded; rig.bones()], Vec::new());
        for (number, joint) in (0..).zip(&joints) {
            match (joint.slot as usize).checked_sub(1).map(|bone| &mut uses[bone]) {
                Some(joint @ (BoneUse::NotNeeded | BoneUse::Parent)) => *joint = BoneUse::Joint(number),
                Some(BoneUse::Joint(_)) | None => further.push(number),
            }
            let mut above = (joint.slot as usize).checked_sub(1).and_then(|bone| rig.parent(bone));
            while let Some(bone) = above.filter(|&bone| uses[bone] == BoneUse::NotNeeded) {
                uses[bone] = BoneUse::Parent;
                above = rig.parent(bone);
            }
        }
        let steps = rig.by_depth().filter_map(|Link { own, parent }| {
            let (joint, offset) = match uses[own as usize - 1] {
                BoneUse::Joint(joint) => (joint, joints[joint as usize].offset),
                BoneUse::Parent => (NO_JOINT, NO_OFFSET),
                BoneUse::NotNeeded => return None,
            };
            Some(ChainStep { offset, own, parent, joint })
        });
        Self { is_near: rig.bones() < NARROW, steps: steps.collect(), uses, further, joints }
    }

    /// Returns the number of joints.
    pub fn joints(&self) -> usize {
        self.joints.len()
    }

    /// Returns whether a byte can index every bone of the rig.
    #[inline(always)]
    pub(super) fn is_near(&self) -> bool {
        self.is_near
    }

    /// Returns every bone that a joint needs, those of one depth after the other.
    #[inline(always)]
    pub(super) fn steps(&self) -> &[ChainStep] {
        &self.steps
    }

    /// Returns the use of each bone, in bone order.
    #[inline(always)]
    pub(super) fn uses(&self) -> &[BoneUse] {
        &self.uses
    }

    /// Returns the joints that [`Self::steps`] and [`Self::uses`] do not have, each with its number.
    #[inline(always)]
    pub(super) fn further(&self) -> impl Iterator<Item = (usize, &BoundJoint)> {
        self.further.iter().filter_map(|&joint| Some((joint as usize, self.joints.get(joint as usize)?)))
    }

    /// Returns the joints.
    pub(super) fn list(&self) -> &[BoundJoint] {
        &self.joints
    }
}
