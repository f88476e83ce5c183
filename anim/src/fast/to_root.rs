//! `to_root` of every bone: bone space → scene space (thesis §2.1.5.1).
//!
//! ```text
//! to_parent_i = T · R · S                       eight bones at once
//! to_root_i   = to_root_parent * to_parent_i    one after the other, parents first, two rows in one register
//! ```
//!
//! Two passes, one for each line, both in the same memory. The second goes through the skeleton by depth: a product
//! needs that of its parent, and bones of one depth do not wait for each other, as the bones of a limb would.
//!
//! What `to_parent` is in detail: `local.rs`.

use super::local::local_rows;
use super::matrix::{Matrix34, RootMatrix, mat4, matrix34};
use super::pose::PoseBlock;
use super::rig::{Link, NARROW, Rig};
use super::simd::{Float8, Kernel, Rows, Simd, SimdLevel};
use glam::Mat4;

/// `to_root` of every bone of one character.
#[derive(Clone, Debug)]
pub struct RootPoses {
    /// The identity, used as the parent of roots; then one per lane; padded to the number of matrices that a byte can
    /// index.
    pub(super) matrices: Vec<RootMatrix>,
    bones: usize,
    /// Instructions with which limbs are solved ([`super::two_bone()`]).
    pub(super) level: SimdLevel,
}

impl RootPoses {
    /// Allocates matrices for the bones of `rig`, all the identity.
    pub fn new(rig: &Rig) -> Self {
        let blocks = rig.rest().blocks().len();
        Self {
            matrices: vec![RootMatrix::IDENTITY; (1 + blocks * 8).max(NARROW)],
            bones: rig.bones,
            level: SimdLevel::best(),
        }
    }

    /// Returns one matrix per bone: bone space → scene space.
    pub fn matrices(&self) -> impl ExactSizeIterator<Item = &Matrix34> {
        self.bones().iter().map(RootMatrix::packed)
    }

    /// Returns the matrix of `bone`; the identity past the end.
    pub fn get(&self, bone: usize) -> &Matrix34 {
        self.bones().get(bone).unwrap_or(&RootMatrix::IDENTITY).packed()
    }

    /// Returns the matrix of `bone`; `None` past the end.
    pub(super) fn bone(&self, bone: u32) -> Option<&Matrix34> {
        self.bones().get(bone as usize).map(RootMatrix::packed)
    }

    fn bones(&self) -> &[RootMatrix] {
        &self.matrices[1..=self.bones]
    }
}

/// Computes `to_root` of every bone from `pose`, the blocks of a pose of `rig`'s bones.
///
/// Where `pose` has fewer blocks than the rig, rest poses are used. A bone whose product is not finite gets its
/// parent's `to_root`, as on the open path. Allocates nothing, unless `out` was made for another rig.
#[doc(alias = "model space")]
pub fn to_root(level: SimdLevel, rig: &Rig, pose: &[PoseBlock], out: &mut RootPoses) {
    level.run(ToRoot { rig, pose, out });
}

struct ToRoot<'a> {
    rig: &'a Rig,
    pose: &'a [PoseBlock],
    out: &'a mut RootPoses,
}

impl Kernel for ToRoot<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        to_root_with::<S>(self.rig, self.pose, self.out);
    }
}

/// As [`to_root`], as part of a larger kernel.
#[inline(always)]
pub(super) fn to_root_with<S: Simd>(rig: &Rig, pose: &[PoseBlock], out: &mut RootPoses) {
    to_parents::<S>(rig, pose, out);
    let matrices = out.matrices.as_mut_slice();
    match matrices.first_chunk_mut() {
        Some(first) if rig.bones < NARROW => near_chain::<S>(&rig.near_links, first),
        Some(_) | None => far_chain::<S>(&rig.links, matrices),
    }
    if !leaves_are_finite::<S>(rig, matrices) {
        carefully(rig, pose, matrices);
    }
}

/// Computes `to_parent` of every bone in the memory for `to_root`.
#[inline(always)]
pub(super) fn to_parents<S: Simd>(rig: &Rig, pose: &[PoseBlock], out: &mut RootPoses) {
    fit(rig, out);
    let matrices = out.matrices.as_mut_slice();
    let mut own = matrices.get_mut(1..).unwrap_or_default().as_chunks_mut::<8>().0.iter_mut();
    let rest = rig.rest().blocks();
    for (pose, own) in pose.iter().take(rest.len()).zip(&mut own) {
        to_parent::<S>(pose, own);
    }
    for (rest, own) in rest.iter().skip(pose.len()).zip(own) {
        to_parent::<S>(rest, own);
    }
    if !rig.sheared.is_empty() {
        put_sheared(rig, pose, matrices);
    }
}

/// Resizes `out`, if it was made for another rig.
#[inline(always)]
pub(super) fn fit(rig: &Rig, out: &mut RootPoses) {
    if out.bones != rig.bones {
        *out = RootPoses::new(rig);
    }
}

/// Computes `T · R · S` of eight bones.
#[inline(always)]
pub(super) fn to_parent<S: Simd>(pose: &PoseBlock, out: &mut [RootMatrix; 8]) {
    let columns = local_rows::<S::F8>(
        S::F8::load_four(&pose.rotation),
        S::F8::load_three(&pose.translation),
        S::F8::load_three(&pose.scale),
    );
    let [a, b, c, d, e, f, g, h] = out;
    let out = [
        &mut a.rows,
        &mut b.rows,
        &mut c.rows,
        &mut d.rows,
        &mut e.rows,
        &mut f.rows,
        &mut g.rows,
        &mut h.rows,
    ];
    S::Rows::store_eight(columns, out);
}

/// Computes `to_root` of every bone in place, where its `to_parent` is, parents first.
#[inline(always)]
fn near_chain<S: Simd>(links: &[Link<u8>], matrices: &mut [RootMatrix; NARROW]) {
    for link in links {
        // Without a bounds check: a byte is always within the array.
        let parent = S::Rows::load(&matrices[usize::from(link.parent)].rows);
        let own = &mut matrices[usize::from(link.own)];
        parent.times(own.three_rows()).store(&mut own.rows);
    }
}

/// As [`near_chain`], for any number of bones.
#[inline(always)]
fn far_chain<S: Simd>(links: &[Link<u32>], matrices: &mut [RootMatrix]) {
    for link in links {
        let Some(parent) = matrices.get(link.parent as usize) else { return };
        let parent = S::Rows::load(&parent.rows);
        let Some(own) = matrices.get_mut(link.own as usize) else { return };
        parent.times(own.three_rows()).store(&mut own.rows);
    }
}

/// Replaces the matrices of sheared bones in their rest pose by the exact rest matrices.
#[cold]
pub(super) fn put_sheared(rig: &Rig, pose: &[PoseBlock], matrices: &mut [RootMatrix]) {
    for sheared in &rig.sheared {
        let (block, at) = (sheared.bone / 8, sheared.bone % 8);
        let posed = pose.get(block).or(rig.rest().blocks().get(block));
        if posed.is_some_and(|posed| posed.get(at) == sheared.rest)
            && let Some(own) = matrices.get_mut(1 + sheared.bone)
        {
            own.set(&matrix34(sheared.matrix));
        }
    }
}

/// Returns whether all leaves are finite. A number that is not spreads along its row from parent to child, and so
/// reaches the leaves.
#[inline(always)]
fn leaves_are_finite<S: Simd>(rig: &Rig, matrices: &[RootMatrix]) -> bool {
    let mut sum = S::Rows::zero();
    match matrices.first_chunk::<NARROW>() {
        Some(first) if rig.bones < NARROW => {
            for &leaf in &rig.near_leaves {
                sum = S::Rows::load(&first[usize::from(leaf)].rows).checked(sum);
            }
        }
        Some(_) | None => {
            for leaf in rig.leaves.iter().filter_map(|&leaf| matrices.get(leaf as usize)) {
                sum = S::Rows::load(&leaf.rows).checked(sum);
            }
        }
    }
    sum.is_number()
}

/// Computes as the open path does, for poses whose products leave the range of f32.
#[cold]
fn carefully(rig: &Rig, pose: &[PoseBlock], out: &mut [RootMatrix]) {
    for bone in 0..rig.bones {
        let block = pose.get(bone / 8).or(rig.rest().blocks().get(bone / 8));
        let transform = block.map_or_else(Default::default, |block| block.get(bone));
        let sheared = rig.sheared.iter().find(|sheared| sheared.bone == bone && sheared.rest == transform);
        let to_parent = sheared.map_or_else(|| transform.to_matrix(), |sheared| sheared.matrix);
        let parent = rig.parent(bone).map_or(Mat4::IDENTITY, |parent| mat4(out[1 + parent].packed()));
        let product = parent * to_parent;
        out[1 + bone].set(&matrix34(if product.is_finite() { product } else { parent }));
    }
}
