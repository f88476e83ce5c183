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
    /// Every bone that a joint needs: the roots, then the children of each step after those of the step before it.
    steps: Vec<ChainStep>,
    /// Number of steps of roots.
    roots: usize,
    /// 1 + the bone of each step.
    order: Vec<u32>,
    /// `order` as bytes, if they can index every bone of the rig.
    near_order: [u8; NARROW],
    /// The blocks of the pose in which there are such bones: those of the roots, then in the order of the steps that
    /// prepare them.
    blocks: Vec<u32>,
    /// Number of blocks of the roots.
    root_blocks: usize,
    /// The use of each bone, in bone order.
    uses: Vec<BoneUse>,
    /// The joints that `steps` and `uses` do not have: of a bone that has another joint, or of no bone.
    further: Vec<FurtherJoint>,
}

/// A joint without a step of its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct FurtherJoint {
    pub(super) joint: u32,
    /// 1 + the step of its bone; 0 for no bone.
    pub(super) step: u32,
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

/// A bone, its joint and the number of its children, in memory as wide as a cache line.
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
        for link in rig.by_depth().filter(|link| is_needed(link.own)) {
            children[link.parent as usize].push(link.own);
        }
        let mut order = std::mem::take(&mut children[0]);
        let roots = order.len();
        let mut at = 0;
        while let Some(&own) = order.get(at) {
            order.extend(&children[own as usize]);
            at += 1;
        }
        let plan = BlockPlan::new(&order, roots, &children);
        let steps = order.iter().zip(&plan.counts).map(|(&own, &blocks)| {
            let (joint, offset) = match uses[own as usize - 1] {
                BoneUse::Joint(joint) => (joint, joints[joint as usize].offset),
                BoneUse::Parent | BoneUse::NotNeeded => (NO_JOINT, NO_OFFSET),
            };
            ChainStep { offset, own, children: children[own as usize].len() as u32, joint, blocks }
        });
        let steps = steps.collect();
        let step_of =
            |slot: u32| (1..).zip(&order).find(|&(_, &own)| own == slot).map_or(0, |(step, _)| step);
        let further = further
            .into_iter()
            .map(|joint: u32| FurtherJoint { joint, step: step_of(joints[joint as usize].slot) })
            .collect();
        let is_near = rig.bones() < NARROW;
        let mut near_order = [0; NARROW];
        for (near, own) in near_order.iter_mut().zip(&order).filter(|_| is_near) {
            *near = *own as u8;
        }
        let BlockPlan { blocks, root_blocks, .. } = plan;
        Self { is_near, steps, roots, order, near_order, blocks, root_blocks, uses, further, joints }
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

    /// Returns every bone that a joint needs: the roots, then the children of each step after those of the step before
    /// it.
    #[inline(always)]
    pub(super) fn steps(&self) -> &[ChainStep] {
        &self.steps
    }

    /// Returns the number of steps of roots.
    #[inline(always)]
    pub(super) fn roots(&self) -> usize {
        self.roots
    }

    /// Returns 1 + the bone of each step.
    #[inline(always)]
    pub(super) fn order(&self) -> &[u32] {
        &self.order
    }

    /// Returns 1 + the bone of each step as bytes, for [`Self::is_near`].
    #[inline(always)]
    pub(super) fn near_order(&self) -> &[u8; NARROW] {
        &self.near_order
    }

    /// Returns the blocks of the pose of the roots, and those that the steps prepare, in their order.
    #[inline(always)]
    pub(super) fn blocks(&self) -> (&[u32], &[u32]) {
        self.blocks.split_at_checked(self.root_blocks).unwrap_or_default()
    }

    /// Returns the use of each bone, in bone order.
    #[inline(always)]
    pub(super) fn uses(&self) -> &[BoneUse] {
        &self.uses
    }

    /// Returns the joints that [`Self::steps`] and [`Self::uses`] do not have.
    #[inline(always)]
    pub(super) fn further(&self) -> &[FurtherJoint] {
        &self.further
    }

    /// Returns the joints.
    pub(super) fn list(&self) -> &[BoundJoint] {
        &self.joints
    }
}

/// The order in which the blocks of the pose are prepared.
struct BlockPlan {
    blocks: Vec<u32>,
    /// Number of blocks of the roots, which come first.
    root_blocks: usize,
    /// For each step the number of blocks to be prepared before it: those of its children, if no step before has
    /// prepared them, and blocks of later steps.
    counts: Vec<u32>,
}

impl BlockPlan {
    fn new(order: &[u32], roots: usize, children: &[Vec<u32>]) -> Self {
        let mut plan = Self { blocks: Vec::new(), root_blocks: 0, counts: vec![0; order.len()] };
        let mut is_known = vec![false; blocks_of(children.len())];
        let mut is_new = |slot: u32| {
            let block = (slot as usize - 1) / LANES;
            (!std::mem::replace(&mut is_known[block], true)).then_some(block as u32)
        };
        plan.blocks.extend(order[..roots].iter().filter_map(|&slot| is_new(slot)));
        plan.root_blocks = plan.blocks.len();
        for (step, own) in order.iter().enumerate() {
            for block in children[*own as usize].iter().filter_map(|&slot| is_new(slot)) {
                plan.counts[step.min((plan.blocks.len() - plan.root_blocks) * STEPS_A_BLOCK)] += 1;
                plan.blocks.push(block);
            }
        }
        plan
    }
}
