//! From a pose to the final matrices of one character.
//!
//! ```text
//! to_parent                    eight bones at once
//! to_root, final_pose          bone after bone, those of one depth after the other
//! ```
//!
//! A product of the chain waits for that of the parent. The final matrix of the bone is computed meanwhile, from the
//! same registers. Bones that no joint needs are left out.

use super::binding::{ChainStep, SkinBinding};
use super::final_poses::final_poses_with;
use super::matrix::{Matrix34, RootMatrix};
use super::pose::PoseBlock;
use super::rig::{NARROW, Rig};
use super::simd::{Rows, Simd};
use super::to_root::{RootPoses, to_parents, to_root_with};

/// Computes the final matrices of `pose`. `memory` is for `to_root` of the bones that a joint needs.
#[inline(always)]
pub(super) fn one_character<S: Simd>(
    rig: &Rig,
    binding: &SkinBinding,
    pose: &[PoseBlock],
    memory: &mut RootPoses,
    out: &mut [Matrix34],
) {
    to_parents::<S>(rig, pose, memory);
    let matrices = memory.matrices.as_mut_slice();
    let sum = match matrices.first_chunk_mut::<NARROW>() {
        Some(first) if binding.is_near() => near_steps::<S>(binding.steps(), first, out),
        Some(_) | None => far_steps::<S>(binding.steps(), matrices, out),
    };
    let sum = further::<S>(binding, matrices, out, sum);
    if !sum.is_number() {
        again::<S>(rig, binding, pose, memory, out);
    }
}

/// Computes `to_root` of the bones in place, where their `to_parent` is, and the final matrices of their joints. Returns NaN
/// in some places if not all are finite.
#[inline(always)]
fn near_steps<S: Simd>(
    steps: &[ChainStep],
    matrices: &mut [RootMatrix; NARROW],
    out: &mut [Matrix34],
) -> S::Rows {
    let mut sum = S::Rows::zero();
    for step in steps {
        // Without a bounds check: a byte is always within the array.
        let parent = S::Rows::load(&matrices[usize::from(step.parent as u8)].rows);
        let own = &mut matrices[usize::from(step.own as u8)];
        let to_root = parent.times(own.three_rows());
        to_root.store(&mut own.rows);
        sum = joint_of::<S>(step, to_root, out, sum);
    }
    sum
}

/// As [`near_steps`], for any number of bones.
#[inline(always)]
fn far_steps<S: Simd>(steps: &[ChainStep], matrices: &mut [RootMatrix], out: &mut [Matrix34]) -> S::Rows {
    let mut sum = S::Rows::zero();
    for step in steps {
        let Some(parent) = matrices.get(step.parent as usize) else { continue };
        let parent = S::Rows::load(&parent.rows);
        let Some(own) = matrices.get_mut(step.own as usize) else { continue };
        let to_root = parent.times(own.three_rows());
        to_root.store(&mut own.rows);
        sum = joint_of::<S>(step, to_root, out, sum);
    }
    sum
}

/// Computes the final matrix of the joint of a step, if it has one.
#[inline(always)]
fn joint_of<S: Simd>(step: &ChainStep, to_root: S::Rows, out: &mut [Matrix34], sum: S::Rows) -> S::Rows {
    // The number of no joint is larger than that of any.
    match out.get_mut(step.joint as usize) {
        Some(out) => {
            let product = to_root.times(&step.offset);
            product.store_packed(out);
            product.checked(sum)
        }
        None => sum,
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
