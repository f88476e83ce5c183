//! `final_pose` of every joint of a skin: bind space → scene space (thesis §2.1.5.1).
//!
//! ```text
//! final_j = to_root_bone(j) * offset_j      for column vectors; two rows in one register
//! ```

use super::binding::SkinBinding;
use super::matrix::{IDENTITY, Matrix34, mat4, matrix34};
use super::rig::NARROW;
use super::simd::{Kernel, Rows, Simd, SimdLevel};
use super::to_root::RootPoses;
use crate::animation::final_pose;
use glam::Mat4;

/// Computes `final_pose` of every joint of `binding`, in the skin's order, up to the length of `out`.
///
/// Where a product is not finite: the bone's `to_root` alone, as on the open path. Allocates nothing.
#[doc(alias = "skinning matrices")]
pub fn final_poses(level: SimdLevel, binding: &SkinBinding, to_root: &RootPoses, out: &mut [Matrix34]) {
    level.run(FinalPoses { binding, to_root, out });
}

struct FinalPoses<'a> {
    binding: &'a SkinBinding,
    to_root: &'a RootPoses,
    out: &'a mut [Matrix34],
}

impl Kernel for FinalPoses<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        final_poses_with::<S>(self.binding, self.to_root, self.out);
    }
}

/// Computes the same as [`final_poses`]; inlined into larger kernels.
#[inline(always)]
pub(super) fn final_poses_with<S: Simd>(binding: &SkinBinding, to_root: &RootPoses, out: &mut [Matrix34]) {
    let is_finite = if binding.is_near() {
        products::<S, true>(binding, to_root, out)
    } else {
        products::<S, false>(binding, to_root, out)
    };
    if !is_finite {
        carefully(binding, to_root, out);
    }
}

/// Computes all products and returns whether they are finite. `NEAR`: a byte indexes every bone, so no index can be out
/// of range.
#[inline(always)]
fn products<S: Simd, const NEAR: bool>(
    binding: &SkinBinding,
    to_root: &RootPoses,
    out: &mut [Matrix34],
) -> bool {
    let mut sum = S::Rows::zero();
    let Some(first) = to_root.matrices.first_chunk::<NARROW>() else { return false };
    for (joint, out) in binding.list().iter().zip(out) {
        let to_root = if NEAR {
            &first[usize::from(joint.slot as u8)]
        } else {
            to_root.matrices.get(joint.slot as usize).unwrap_or(&first[0])
        };
        let product = S::Rows::load(&to_root.rows).times(&joint.offset);
        sum = product.checked(sum);
        product.store_packed(out);
    }
    sum.is_number()
}

/// Computes as the open path does, for products that leave the range of f32.
#[cold]
fn carefully(binding: &SkinBinding, to_root: &RootPoses, out: &mut [Matrix34]) {
    for (joint, out) in binding.list().iter().zip(out) {
        let to_root =
            to_root.matrices.get(joint.slot as usize).map_or(Mat4::IDENTITY, |matrix| mat4(matrix.packed()));
        *out = matrix34(final_pose(
            to_root,
            mat4(joint.offset.as_flattened().first_chunk().unwrap_or(&IDENTITY)),
        ));
    }
}
