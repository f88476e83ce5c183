//! `final_pose` of every joint of a skin: bind space → scene space (thesis §2.1.5.1).
//!
//! ```text
//! final_j = to_root_bone(j) * offset_j      for column vectors; two rows in one register
//! ```

use super::matrix::{Matrix34, MatrixRows, doubled, mat4, matrix34};
use super::rig::{NARROW, Rig};
use super::simd::{Float4, Float8, Kernel, Simd, SimdLevel};
use super::tiny::{flushed, largest};
use super::to_root::RootPoses;
use crate::animation::final_pose;
use crate::data::Skin;
use glam::Mat4;

/// A skin in the layout of the fast path: the bone of each joint, and its offset.
#[derive(Clone, Debug)]
pub struct SkinBinding {
    joints: Vec<BoundJoint>,
    /// Whether a byte can index every bone of the rig.
    is_near: bool,
}

/// A joint's bone and offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundJoint {
    /// 1 + the bone; 0, the identity, for a bone that the rig does not have.
    pub(super) slot: u32,
    /// Bind space → bone space.
    pub(super) offset: Matrix34,
}

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
        let joints =
            skin.bones.iter().zip(offsets).map(|(&bone, offset)| BoundJoint { slot: slot(bone), offset });
        Self { joints: joints.collect(), is_near: rig.bones() < NARROW }
    }

    /// Returns the number of joints.
    pub fn joints(&self) -> usize {
        self.joints.len()
    }

    /// Returns the joints.
    pub(super) fn list(&self) -> &[BoundJoint] {
        &self.joints
    }
}

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
    let is_finite = if binding.is_near {
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
    let zero = S::F8::splat(0.0);
    let (mut upper, mut lower) = (zero, zero.low());
    let Some(first) = to_root.matrices.first_chunk::<NARROW>() else { return false };
    for (joint, out) in binding.joints.iter().zip(out) {
        let to_root = if NEAR {
            &first[usize::from(joint.slot as u8)]
        } else {
            to_root.matrices.get(joint.slot as usize).unwrap_or(&first[0])
        };
        let product = MatrixRows::<S>::load(to_root).times(doubled::<S>(&joint.offset));
        // Stays zero while everything is finite.
        upper = product.0.mul_add(zero, upper);
        lower = product.1.mul_add(zero.low(), lower);
        product.store(out);
    }
    let mut four = [0.0; 4];
    lower.store(&mut four);
    // NaN is not less than anything.
    (upper + S::F8::twice(&four)).less(S::F8::splat(1.0)).all()
}

/// Computes as the open path does, for products that leave the range of f32.
#[cold]
fn carefully(binding: &SkinBinding, to_root: &RootPoses, out: &mut [Matrix34]) {
    for (joint, out) in binding.joints.iter().zip(out) {
        let to_root = to_root.matrices.get(joint.slot as usize).map_or(Mat4::IDENTITY, mat4);
        *out = matrix34(final_pose(to_root, mat4(&joint.offset)));
    }
}
