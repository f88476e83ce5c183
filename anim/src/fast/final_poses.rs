//! `final_pose` of every joint of a skin: bind space → scene space (thesis §2.1.5.1).
//!
//! ```text
//! final_j = to_root_bone(j) * offset_j      for column vectors; two rows in one register
//! ```

use super::matrix::{IDENTITY, Matrix34, mat4, matrix34};
use super::rig::{NARROW, Rig};
use super::simd::{Kernel, LANES, Rows, Simd, SimdLevel};
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
    /// A bit for each bone of each eight: whether it is the bone of a joint, or above one.
    needed: Vec<u8>,
}

/// A joint's bone and offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundJoint {
    /// 1 + the bone; 0, the identity, for a bone that the rig does not have.
    pub(super) slot: u32,
    /// Bind space → bone space.
    pub(super) offset: [[f32; 4]; 3],
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
        let joints = skin.bones.iter().zip(offsets).map(|(&bone, offset)| {
            let [i, j, k] = [0, 4, 8].map(|row| [0, 1, 2, 3].map(|column| offset[row + column]));
            BoundJoint { slot: slot(bone), offset: [i, j, k] }
        });
        let needed = needed(rig, skin.bones.iter().map(|&bone| bone as usize));
        Self { joints: joints.collect(), is_near: rig.bones() < NARROW, needed }
    }

    /// Returns the number of joints.
    pub fn joints(&self) -> usize {
        self.joints.len()
    }

    /// Returns a bit for each bone of each eight: whether it is the bone of a joint, or above one.
    pub(super) fn needed(&self) -> &[u8] {
        &self.needed
    }

    /// Returns the joints.
    pub(super) fn list(&self) -> &[BoundJoint] {
        &self.joints
    }
}

/// Returns a bit for each bone of each eight: whether it is one of `bones`, or above one.
fn needed(rig: &Rig, bones: impl Iterator<Item = usize>) -> Vec<u8> {
    let mut needed = vec![0; rig.bones().div_ceil(LANES)];
    for bone in bones.filter(|&bone| bone < rig.bones()) {
        let mut above = Some(bone);
        while let Some(bone) = above {
            let bit = 1 << (bone % LANES);
            if needed[bone / LANES] & bit != 0 {
                // So are those above it.
                break;
            }
            needed[bone / LANES] |= bit;
            above = rig.parent(bone);
        }
    }
    needed
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
    let mut sum = S::Rows::zero();
    let Some(first) = to_root.matrices.first_chunk::<NARROW>() else { return false };
    for (joint, out) in binding.joints.iter().zip(out) {
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
    for (joint, out) in binding.joints.iter().zip(out) {
        let to_root = to_root.matrices.get(joint.slot as usize).map_or(Mat4::IDENTITY, |matrix| mat4(matrix.packed()));
        *out = matrix34(final_pose(to_root, mat4(joint.offset.as_flattened().first_chunk().unwrap_or(&IDENTITY))));
    }
}
