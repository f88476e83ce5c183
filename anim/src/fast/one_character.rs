//! From a pose to the final matrices of one character.
//!
//! ```text
//! to_parent                    eight bones at once, shortly before they are needed
//! final_pose, children         bone after bone, those of one depth after the other
//! ```
//!
//! Near the root there are few bones of one depth, and each waits for its parent: `to_parent` of other bones is computed
//! meanwhile. A step takes the `to_root` of a bone from memory once, for its final matrix and for `to_root` of its
//! children. Bones that no joint needs are left out.

use super::binding::SkinBinding;
use super::final_poses::final_poses_with;
use super::matrix::{Matrix34, RootMatrix};
use super::pose::PoseBlock;
use super::rig::{NARROW, Rig};
use super::simd::{Rows, Simd};
use super::to_root::{RootPoses, fit, to_parent, to_parents, to_root_with};

/// Computes the final matrices of `pose`. `memory` is for `to_root` of the bones that a joint needs.
#[inline(always)]
pub(super) fn one_character<S: Simd>(
    rig: &Rig,
    binding: &SkinBinding,
    pose: &[PoseBlock],
    memory: &mut RootPoses,
    out: &mut [Matrix34],
) {
    // With few registers, two things at once are slower than one after the other.
    let are_ready = !S::Rows::IS_ONE_REGISTER || !rig.sheared.is_empty();
    if are_ready {
        to_parents::<S>(rig, pose, memory);
    } else {
        fit(rig, memory);
    }
    let blocks = Blocks { pose, rest: rig.rest().blocks(), are_ready };
    let matrices = memory.matrices.as_mut_slice();
    let sum = match matrices.first_chunk_mut::<NARROW>() {
        Some(first) if binding.is_near() => steps::<S>(binding, &blocks, first, out),
        Some(_) | None => steps::<S>(binding, &blocks, matrices, out),
    };
    let sum = further::<S>(binding, matrices, out, sum);
    if !sum.is_number() {
        again::<S>(rig, binding, pose, memory, out);
    }
}

/// The pose of a character, and the rest pose for the blocks that it lacks.
struct Blocks<'a> {
    pose: &'a [PoseBlock],
    rest: &'a [PoseBlock],
    /// Whether all `to_parent` are there.
    are_ready: bool,
}

/// `to_root` of bones, or `to_parent` as long as it is not computed, by slot: 1 + the bone.
trait Slots {
    fn slot(&self, slot: u32) -> Option<&RootMatrix>;
    fn slot_mut(&mut self, slot: u32) -> Option<&mut RootMatrix>;
    /// Returns the matrices of the bones of a block.
    fn block(&mut self, block: u32) -> Option<&mut [RootMatrix; 8]>;
}

/// Slots that a byte can index: a byte is always within the array, so that nothing is checked.
impl Slots for [RootMatrix; NARROW] {
    #[inline(always)]
    fn slot(&self, slot: u32) -> Option<&RootMatrix> {
        Some(&self[usize::from(slot as u8)])
    }

    #[inline(always)]
    fn slot_mut(&mut self, slot: u32) -> Option<&mut RootMatrix> {
        Some(&mut self[usize::from(slot as u8)])
    }

    #[inline(always)]
    fn block(&mut self, block: u32) -> Option<&mut [RootMatrix; 8]> {
        self.get_mut(1..)?.as_chunks_mut().0.get_mut(block as usize)
    }
}

impl Slots for [RootMatrix] {
    #[inline(always)]
    fn slot(&self, slot: u32) -> Option<&RootMatrix> {
        self.get(slot as usize)
    }

    #[inline(always)]
    fn slot_mut(&mut self, slot: u32) -> Option<&mut RootMatrix> {
        self.get_mut(slot as usize)
    }

    #[inline(always)]
    fn block(&mut self, block: u32) -> Option<&mut [RootMatrix; 8]> {
        self.get_mut(1..)?.as_chunks_mut().0.get_mut(block as usize)
    }
}

/// Computes `to_root` of the bones in place, where their `to_parent` is, and the final matrices of their joints. Returns
/// NaN in some places if not all are finite.
#[inline(always)]
fn steps<S: Simd>(
    binding: &SkinBinding,
    blocks: &Blocks,
    matrices: &mut (impl Slots + ?Sized),
    out: &mut [Matrix34],
) -> S::Rows {
    let mut sum = S::Rows::zero();
    let (mut children, mut to_prepare) = (binding.children().iter(), binding.blocks().iter());
    for step in binding.steps() {
        for &block in to_prepare.by_ref().take(step.blocks as usize) {
            prepare::<S>(blocks, block, matrices);
        }
        let Some(to_root) = matrices.slot(step.own) else { continue };
        let columns = S::Rows::load(&to_root.rows).columns();
        for &child in children.by_ref().take(step.children as usize) {
            if let Some(own) = matrices.slot_mut(child) {
                S::Rows::product(columns, own.three_rows()).store(&mut own.rows);
            }
        }
        // The number of no joint is larger than that of any.
        if let Some(out) = out.get_mut(step.joint as usize) {
            let product = S::Rows::product(columns, &step.offset);
            product.store_packed(out);
            sum = product.checked(sum);
        }
    }
    sum
}

/// Computes the `to_parent` of a block, unless they are there.
#[inline(always)]
fn prepare<S: Simd>(blocks: &Blocks, block: u32, matrices: &mut (impl Slots + ?Sized)) {
    let at = block as usize;
    if !blocks.are_ready
        && let Some(pose) = blocks.pose.get(at).or(blocks.rest.get(at))
        && let Some(own) = matrices.block(block)
    {
        to_parent::<S>(pose, own);
    }
}

/// Computes the final matrices of the joints that no step has.
#[inline(always)]
fn further<S: Simd>(
    binding: &SkinBinding,
    matrices: &[RootMatrix],
    out: &mut [Matrix34],
    mut sum: S::Rows,
) -> S::Rows {
    for (joint, bound) in binding.further() {
        let to_root = matrices.get(bound.slot as usize).unwrap_or(&RootMatrix::IDENTITY);
        if let Some(out) = out.get_mut(joint) {
            let product = S::Rows::load(&to_root.rows).times(&bound.offset);
            product.store_packed(out);
            sum = product.checked(sum);
        }
    }
    sum
}

/// Computes the matrices step by step, with what is prescribed for numbers that are not finite.
#[cold]
#[inline(always)]
fn again<S: Simd>(
    rig: &Rig,
    binding: &SkinBinding,
    pose: &[PoseBlock],
    to_root: &mut RootPoses,
    out: &mut [Matrix34],
) {
    to_root_with::<S>(rig, pose, to_root);
    final_poses_with::<S>(binding, to_root, out);
}
