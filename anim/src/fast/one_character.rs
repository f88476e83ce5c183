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
use super::played::{LocalPoses, PlayedPose};
use super::pose::PoseBlock;
use super::rig::{NARROW, Rig};
use super::simd::{Kernel, Rows, Simd};
use super::to_root::{RootPoses, fit, to_parent, to_root_with};

/// Computes the final matrices of `played`.
pub(super) struct CharacterFinals<'a> {
    pub(super) rig: &'a Rig,
    pub(super) binding: &'a SkinBinding,
    pub(super) played: &'a PlayedPose,
    /// Memory for `to_parent` of the bones that a joint needs.
    pub(super) locals: &'a mut LocalPoses,
    /// Memory for `to_root` of them.
    pub(super) roots: &'a mut RootPoses,
    pub(super) out: &'a mut [Matrix34],
}

impl Kernel for CharacterFinals<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Self { rig, binding, played, locals, roots, out } = self;
        one_character::<S>(rig, binding, played, locals, roots, out);
    }
}

#[inline(always)]
fn one_character<S: Simd>(
    rig: &Rig,
    binding: &SkinBinding,
    played: &PlayedPose,
    locals: &mut LocalPoses,
    roots: &mut RootPoses,
    out: &mut [Matrix34],
) {
    fit(rig, roots);
    locals.keep::<S>(rig, played);
    // With few registers, two things at once are slower than one after the other.
    let are_ready = !S::Rows::IS_ONE_REGISTER || !rig.sheared.is_empty();
    if are_ready {
        locals.complete::<S>(rig, played);
    }
    if !rig.sheared.is_empty() {
        locals.shear(rig, played);
    }
    let (to_parent, is_ready) = locals.parts();
    let blocks = Blocks { pose: played.blocks(), rest: rig.rest().blocks(), is_ready, are_ready };
    let to_root = roots.matrices.as_mut_slice();
    let sum = match (to_parent.first_chunk_mut::<NARROW>(), to_root.first_chunk_mut::<NARROW>()) {
        (Some(to_parent), Some(to_root)) if binding.is_near() => {
            steps::<S, _>(binding, binding.near_order(), &blocks, to_parent, to_root, out)
        }
        (Some(_), Some(_)) | (None, _) | (_, None) => {
            steps::<S, _>(binding, binding.order(), &blocks, to_parent, to_root, out)
        }
    };
    let sum = further::<S>(binding, to_root, out, sum);
    if !sum.is_number() {
        again::<S>(rig, binding, played.blocks(), roots, out);
    }
}

/// The pose of a character, and the rest pose for the blocks that it lacks.
struct Blocks<'a> {
    pose: &'a [PoseBlock],
    rest: &'a [PoseBlock],
    /// Whether `to_parent` of a block is there.
    is_ready: &'a [bool],
    /// Whether all `to_parent` are there.
    are_ready: bool,
}

/// `to_parent` by slot: 1 + the bone. Or `to_root` by slot: 1 + the step.
trait Slots {
    /// 1 + the bone of each step.
    type Order: ?Sized;
    /// Returns 1 + the bone of a step.
    fn bone(order: &Self::Order, step: u32) -> u32;
    fn slot(&self, slot: u32) -> Option<&RootMatrix>;
    fn slot_mut(&mut self, slot: u32) -> Option<&mut RootMatrix>;
    /// Returns the matrices of the bones of a block.
    fn block(&mut self, block: u32) -> Option<&mut [RootMatrix; 8]>;
}

/// Slots that a byte can index: a byte is always within the array, so that nothing is checked.
impl Slots for [RootMatrix; NARROW] {
    type Order = [u8; NARROW];

    #[inline(always)]
    fn bone(order: &[u8; NARROW], step: u32) -> u32 {
        u32::from(order[usize::from(step as u8)])
    }

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
    type Order = [u32];

    #[inline(always)]
    fn bone(order: &[u32], step: u32) -> u32 {
        order.get(step as usize).copied().unwrap_or(u32::MAX)
    }

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

/// Computes `to_root` of the bones and the final matrices of their joints. Returns NaN in some places if not all are
/// finite.
#[inline(always)]
fn steps<S: Simd, M: Slots + ?Sized>(
    binding: &SkinBinding,
    order: &M::Order,
    blocks: &Blocks,
    to_parent: &mut M,
    to_root: &mut M,
    out: &mut [Matrix34],
) -> S::Rows {
    let (of_roots, to_prepare) = binding.blocks();
    for &block in of_roots {
        prepare::<S>(blocks, block, to_parent);
    }
    for (slot, root) in (1..).zip(binding.steps().iter().take(binding.roots())) {
        if let (Some(local), Some(root)) = (to_parent.slot(root.own), to_root.slot_mut(slot)) {
            *root = *local;
        }
    }
    let mut sum = S::Rows::zero();
    let (mut to_prepare, mut child) = (to_prepare.iter(), binding.roots() as u32);
    for (slot, step) in (1..).zip(binding.steps()) {
        for &block in to_prepare.by_ref().take(step.blocks as usize) {
            prepare::<S>(blocks, block, to_parent);
        }
        let Some(own) = to_root.slot(slot) else { continue };
        let columns = S::Rows::load(&own.rows).columns();
        for _ in 0..step.children {
            let local = to_parent.slot(M::bone(order, child));
            child += 1;
            if let (Some(local), Some(root)) = (local, to_root.slot_mut(child)) {
                S::Rows::product(columns, local.three_rows()).store(&mut root.rows);
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
fn prepare<S: Simd>(blocks: &Blocks, block: u32, locals: &mut (impl Slots + ?Sized)) {
    let at = block as usize;
    if !blocks.are_ready
        && blocks.is_ready.get(at) == Some(&false)
        && let Some(pose) = blocks.pose.get(at).or(blocks.rest.get(at))
        && let Some(own) = locals.block(block)
    {
        to_parent::<S>(pose, own);
    }
}

/// Computes the final matrices of the joints that no step has, from `to_root` by slot: 1 + the step.
#[inline(always)]
fn further<S: Simd>(
    binding: &SkinBinding,
    to_root: &[RootMatrix],
    out: &mut [Matrix34],
    mut sum: S::Rows,
) -> S::Rows {
    for further in binding.further() {
        let joint = further.joint as usize;
        let to_root = to_root.get(further.step as usize).unwrap_or(&RootMatrix::IDENTITY);
        if let (Some(bound), Some(out)) = (binding.list().get(joint), out.get_mut(joint)) {
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
