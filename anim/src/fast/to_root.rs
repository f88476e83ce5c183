//! `to_root` of every bone: bone space → scene space (thesis §2.1.5.1).
//!
//! ```text
//! to_parent_i = T · R · S                       eight bones at once
//! to_root_i   = to_root_parent * to_parent_i    one after the other, parents first, two rows in one register
//! ```
//!
//! Two passes, one for each line: with both in one the matrices of eight bones would need more registers than there
//! are, and that costs more than storing them and loading them again.
//!
//! With the unit quaternion (x y z w), the scale (a b c) and the translation t:
//!
//! ```text
//!             ┌ a (1 - 2y² - 2z²)   b (2xy - 2zw)       c (2xz + 2yw)      tx ┐
//! to_parent = │ a (2xy + 2zw)       b (1 - 2x² - 2z²)   c (2yz - 2xw)      ty │
//!             └ a (2xz - 2yw)       b (2yz + 2xw)       c (1 - 2x² - 2y²)  tz ┘
//! ```

use super::matrix::{IDENTITY, Matrix34, MatrixRows, mat4, matrix34};
use super::pose::PoseBlock;
use super::rig::{NARROW, Rig};
use super::simd::{Float4, Float8, Kernel, Simd, SimdLevel};
use glam::Mat4;
use std::cell::Cell;

/// `to_root` of every bone of one character.
#[derive(Clone, Debug)]
pub struct RootPoses {
    /// The identity, used as the parent of roots; then one per lane; padded to the number of matrices that a byte can
    /// index.
    pub(super) matrices: Vec<Matrix34>,
    /// Results of the first pass, for the second.
    local: Vec<LocalMatrices>,
    bones: usize,
    /// Instructions with which limbs are solved ([`super::two_bone()`]).
    pub(super) level: SimdLevel,
}

impl RootPoses {
    /// Allocates matrices for the bones of `rig`, all the identity.
    pub fn new(rig: &Rig) -> Self {
        let blocks = rig.parents.len();
        Self {
            matrices: vec![IDENTITY; (1 + blocks * 8).max(NARROW)],
            local: vec![[[[0.0; 8]; 4]; 3]; blocks],
            bones: rig.bones,
            level: SimdLevel::best(),
        }
    }

    /// Returns one matrix per bone: bone space → scene space.
    pub fn matrices(&self) -> &[Matrix34] {
        &self.matrices[1..=self.bones]
    }

    /// Returns the matrix of `bone`; the identity past the end.
    pub fn get(&self, bone: usize) -> &Matrix34 {
        self.matrices().get(bone).unwrap_or(&IDENTITY)
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
    fit(rig, out);
    let RootPoses { matrices, local, .. } = out;
    for (local, pose) in local.iter_mut().zip(pose) {
        to_parent::<S>(pose, local);
    }
    for (local, rest) in local.iter_mut().zip(rig.rest().blocks()).skip(pose.len()) {
        to_parent::<S>(rest, local);
    }
    if !rig.sheared.is_empty() {
        put_sheared(rig, pose, local);
    }
    let is_finite = if rig.bones < NARROW {
        chain::<S, u8>(rig.bones, &rig.near_parents, local, matrices);
        leaves_are_finite::<S, u8>(&rig.near_leaves, matrices)
    } else {
        chain::<S, u32>(rig.bones, &rig.parents, local, matrices);
        leaves_are_finite::<S, u32>(&rig.leaves, matrices)
    };
    if !is_finite {
        carefully(rig, pose, matrices);
    }
}

/// The index of a matrix.
trait MatrixIndex: Copy {
    /// Returns the element of `all` with this index; `first` are the first elements of `all`.
    fn of<'a, T>(self, first: &'a [T; NARROW], all: &'a [T]) -> Option<&'a T>;
}

impl MatrixIndex for u8 {
    // Without a bounds check: a byte is always within `first`.
    #[inline(always)]
    fn of<'a, T>(self, first: &'a [T; NARROW], _: &'a [T]) -> Option<&'a T> {
        Some(&first[usize::from(self)])
    }
}

impl MatrixIndex for u32 {
    #[inline(always)]
    fn of<'a, T>(self, _: &'a [T; NARROW], all: &'a [T]) -> Option<&'a T> {
        all.get(self as usize)
    }
}

/// Resizes `out`, if it was made for another rig.
#[inline(always)]
fn fit(rig: &Rig, out: &mut RootPoses) {
    if out.bones != rig.bones {
        *out = RootPoses::new(rig);
    }
}

/// `to_parent` of eight bones: rows of bone `k` in the low halves and of bone `k + 4` in the high halves of `[row][k]`.
type LocalMatrices = [[[f32; 8]; 4]; 3];

/// Computes `T · R · S` of eight bones.
#[inline(always)]
fn to_parent<S: Simd>(pose: &PoseBlock, local: &mut LocalMatrices) {
    let [x, y, z, w] = S::F8::load_four(&pose.rotation);
    let [a, b, c] = S::F8::load_three(&pose.scale);
    let [tx, ty, tz] = S::F8::load_three(&pose.translation);
    let (x2, y2, z2, one) = (x + x, y + y, z + z, S::F8::splat(1.0));
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (not_x, not_y) = (x.neg_mul_add(x2, one), y.neg_mul_add(y2, one));
    let upper = [z.neg_mul_add(z2, not_y) * a, w.neg_mul_add(z2, xy) * b, w.mul_add(y2, xz) * c, tx];
    let middle = [w.mul_add(z2, xy) * a, z.neg_mul_add(z2, not_x) * b, w.neg_mul_add(x2, yz) * c, ty];
    let lower = [w.neg_mul_add(y2, xz) * a, w.mul_add(x2, yz) * b, y.neg_mul_add(y2, not_x) * c, tz];
    S::F8::store_four(S::F8::transpose(upper), &mut local[0]);
    S::F8::store_four(S::F8::transpose(middle), &mut local[1]);
    S::F8::store_four(S::F8::transpose(lower), &mut local[2]);
}

/// Computes `to_root` of every bone, parents first.
#[inline(always)]
fn chain<S: Simd, P: MatrixIndex>(
    bones: usize,
    parents: &[[P; 8]],
    local: &[LocalMatrices],
    out: &mut [Matrix34],
) {
    // Cells, because a block is written while its own first bones are read as parents of the others.
    let out = Cell::from_mut(out).as_slice_of_cells();
    let (Some(first), Some(own)) = (out.first_chunk(), out.get(1..)) else { return };
    let mut left = bones;
    for ((parents, local), block) in parents.iter().zip(local).zip(own.as_chunks::<8>().0) {
        // Unrolled, so that every index is known at compile time.
        let link = BlockLinks { parents, local, first, out, block };
        if left < 8 {
            link.some::<S>(left);
            return;
        }
        link.bone::<S>(0);
        link.bone::<S>(1);
        link.bone::<S>(2);
        link.bone::<S>(3);
        link.bone::<S>(4);
        link.bone::<S>(5);
        link.bone::<S>(6);
        link.bone::<S>(7);
        left -= 8;
    }
}

/// The data needed for a block of bones.
struct BlockLinks<'a, P> {
    parents: &'a [P; 8],
    local: &'a LocalMatrices,
    first: &'a [Cell<Matrix34>; NARROW],
    out: &'a [Cell<Matrix34>],
    block: &'a [Cell<Matrix34>; 8],
}

impl<P: MatrixIndex> BlockLinks<'_, P> {
    /// Computes `to_root` of bone `at` of the block.
    #[inline(always)]
    fn bone<S: Simd>(&self, at: usize) {
        let Some(parent) = self.parents[at % 8].of(self.first, self.out) else { return };
        let [x, y, z] = [&self.local[0], &self.local[1], &self.local[2]];
        let (two, half) = (at % 4, at / 4 % 2);
        let rows = [
            S::F8::twice(&x[two].as_chunks::<4>().0[half]),
            S::F8::twice(&y[two].as_chunks::<4>().0[half]),
            S::F8::twice(&z[two].as_chunks::<4>().0[half]),
        ];
        let mut product = IDENTITY;
        MatrixRows::<S>::load(&parent.get()).times(rows).store(&mut product);
        self.block[at % 8].set(product);
    }

    /// Computes `to_root` of the first `count` bones of the block, fewer than eight.
    #[inline(always)]
    fn some<S: Simd>(&self, count: usize) {
        if count > 0 {
            self.bone::<S>(0);
        }
        if count > 1 {
            self.bone::<S>(1);
        }
        if count > 2 {
            self.bone::<S>(2);
        }
        if count > 3 {
            self.bone::<S>(3);
        }
        if count > 4 {
            self.bone::<S>(4);
        }
        if count > 5 {
            self.bone::<S>(5);
        }
        if count > 6 {
            self.bone::<S>(6);
        }
    }
}

/// Replaces the matrices of sheared bones in their rest pose by the exact rest matrices.
#[cold]
fn put_sheared(rig: &Rig, pose: &[PoseBlock], local: &mut [LocalMatrices]) {
    for sheared in &rig.sheared {
        let (block, at) = (sheared.bone / 8, sheared.bone % 8);
        let posed = pose.get(block).or(rig.rest().blocks().get(block));
        if posed.is_some_and(|posed| posed.get(at) == sheared.rest)
            && let Some(local) = local.get_mut(block)
        {
            for (row, from) in local.iter_mut().zip(matrix34(sheared.matrix).as_chunks::<4>().0) {
                row[at % 4].as_chunks_mut::<4>().0[at / 4] = *from;
            }
        }
    }
}

/// Returns whether all leaves are finite. A number that is not spreads along its row from parent to child, and so
/// reaches the leaves.
#[inline(always)]
fn leaves_are_finite<S: Simd, P: MatrixIndex>(leaves: &[P], matrices: &[Matrix34]) -> bool {
    let Some(first) = matrices.first_chunk() else { return false };
    let zero = S::F8::splat(0.0);
    let (mut upper, mut lower) = (zero, zero.low());
    for leaf in leaves {
        if let Some(leaf) = leaf.of(first, matrices) {
            // Stays zero while everything is finite.
            upper = S::F8::load(super::matrix::upper(leaf)).mul_add(zero, upper);
            lower = S::F4::load(super::matrix::lower(leaf)).mul_add(zero.low(), lower);
        }
    }
    // NaN is not less than anything.
    let mut four = [0.0; 4];
    lower.store(&mut four);
    (upper + S::F8::twice(&four)).less(S::F8::splat(1.0)).all()
}

/// Computes as the open path does, for poses whose products leave the range of f32.
#[cold]
fn carefully(rig: &Rig, pose: &[PoseBlock], out: &mut [Matrix34]) {
    for bone in 0..rig.bones {
        let block = pose.get(bone / 8).or(rig.rest().blocks().get(bone / 8));
        let transform = block.map_or_else(Default::default, |block| block.get(bone));
        let sheared = rig.sheared.iter().find(|sheared| sheared.bone == bone && sheared.rest == transform);
        let to_parent = sheared.map_or_else(|| transform.to_matrix(), |sheared| sheared.matrix);
        let parent = rig.parent(bone).map_or(Mat4::IDENTITY, |parent| mat4(&out[1 + parent]));
        let product = parent * to_parent;
        out[1 + bone] = matrix34(if product.is_finite() { product } else { parent });
    }
}
