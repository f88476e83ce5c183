//! A skin in the layout of the fast path.

use super::matrix::{Matrix34, matrix34};
use super::pose::blocks_of;
use super::rig::{NARROW, Rig};
use super::simd::LANES;
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
    /// 1 + each child that a joint needs, in the order of the steps of their parents.
    children: Vec<u32>,
    /// The blocks of the pose in which there are such bones, in the order of the steps that prepare them.
    blocks: Vec<u32>,
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

/// A bone, its joint and its children, in memory as wide as a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct ChainStep {
    /// Bind space → bone space.
    pub(super) offset: [[f32; 4]; 3],
    /// 1 + the bone.
    pub(super) own: u32,
    /// Number of children that a joint needs.
    pub(super) children: u32,
    /// Number of the joint; [`NO_JOINT`].
    pub(super) joint: u32,
    /// Number of blocks of the pose whose `to_parent` is computed before this step.
    pub(super) blocks: u32,
}

/// Stands for no joint: a number that no skin reaches.
const NO_JOINT: u32 = u32::MAX;
/// Steps from one block to the next, unless it is needed earlier: the bones near the root leave time, as they wait for
/// their parents.
const STEPS_A_BLOCK: usize = 2;
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
        let is_needed = |slot: u32| uses[slot as usize - 1] != BoneUse::NotNeeded;
        let mut children = vec![Vec::new(); 1 + rig.bones()];
        for link in rig.links.iter().filter(|link| is_needed(link.own)) {
            children[link.parent as usize].push(link.own);
        }
        let order: Vec<u32> = rig.by_depth().map(|link| link.own).filter(|&own| is_needed(own)).collect();
        let (blocks, counts) = blocks_of_steps(&order, &children);
        let steps = order.iter().zip(counts).map(|(&own, blocks)| {
            let (joint, offset) = match uses[own as usize - 1] {
                BoneUse::Joint(joint) => (joint, joints[joint as usize].offset),
                BoneUse::Parent | BoneUse::NotNeeded => (NO_JOINT, NO_OFFSET),
            };
            ChainStep { offset, own, children: children[own as usize].len() as u32, joint, blocks }
        });
        let steps = steps.collect();
        let children = order.iter().flat_map(|&own| &children[own as usize]).copied().collect();
        Self { is_near: rig.bones() < NARROW, steps, children, blocks, uses, further, joints }
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

    /// Returns 1 + each child that a joint needs, in the order of the steps of their parents.
    #[inline(always)]
    pub(super) fn children(&self) -> &[u32] {
        &self.children
    }

    /// Returns the blocks of the pose that the steps prepare, in their order.
    #[inline(always)]
    pub(super) fn blocks(&self) -> &[u32] {
        &self.blocks
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

/// Returns the blocks of the pose that the steps of the bones of `order` need, and how many are to be prepared before
/// each step: those of its bone and of its children, if no step before has prepared them, and blocks of later steps.
fn blocks_of_steps(order: &[u32], children: &[Vec<u32>]) -> (Vec<u32>, Vec<u32>) {
    let (mut blocks, mut counts) = (Vec::new(), vec![0; order.len()]);
    let mut is_known = vec![false; blocks_of(children.len())];
    for (step, own) in order.iter().enumerate() {
        for &slot in std::iter::once(own).chain(&children[*own as usize]) {
            let block = (slot as usize - 1) / LANES;
            if !std::mem::replace(&mut is_known[block], true) {
                counts[step.min(blocks.len() * STEPS_A_BLOCK)] += 1;
                blocks.push(block as u32);
            }
        }
    }
    (blocks, counts)
}
