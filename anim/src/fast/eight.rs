//! Eight characters of one rig at once: from their poses to their final matrices, one character in each lane.
//!
//! ```text
//! poses of eight characters       eight bones of one character in a register
//! to_parent, to_root, final_pose  one bone of eight characters in a register
//! ```
//!
//! No product waits for another lane, and none needs its numbers moved within a register, so a bone costs half as much
//! as one of a single character. Each number is the result of the same operations as there, in the same order.

use super::final_poses::SkinBinding;
use super::matrix::{IDENTITY, Matrix34, row};
use super::pose::{Pose, PoseBlock};
use super::rig::Rig;
use super::simd::{Float8, LANES, Simd};
use super::to_root::local_rows;
use std::array::from_fn;

/// One number of each character.
type EightNumbers = [f32; LANES];

/// A matrix of each character, number by number.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct EightMatrices([EightNumbers; 12]);

/// The numbers of eight bones of the eight characters: x, y, z, w of the rotation, then the translation and the scale,
/// each with one entry per bone.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
struct EightPoses([[EightNumbers; LANES]; 10]);

/// Memory for eight characters.
#[derive(Clone, Debug)]
pub(super) struct Eight {
    poses: [Pose; LANES],
    /// The identity, as the parent of roots; then `to_root` of each bone.
    matrices: Vec<EightMatrices>,
}

/// The final matrices of eight characters.
pub(super) type EightOuts<'a> = [&'a mut [Matrix34]; LANES];

impl Eight {
    /// Allocates memory for characters of `rig`.
    pub(super) fn new(rig: &Rig) -> Self {
        Self {
            poses: from_fn(|_| rig.rest().clone()),
            matrices: vec![EightMatrices(IDENTITY.map(|number| [number; LANES])); 1 + rig.bones()],
        }
    }

    /// Returns the poses, to be written.
    #[inline(always)]
    pub(super) fn poses(&mut self) -> &mut [Pose; LANES] {
        &mut self.poses
    }

    /// Computes the final matrices from the poses. Returns whether all are finite; otherwise the characters have to be
    /// computed one by one.
    #[inline(always)]
    pub(super) fn finals<S: Simd>(&mut self, rig: &Rig, binding: &SkinBinding, outs: EightOuts) -> bool {
        self.pose_bones::<S>(rig);
        finals::<S>(&self.matrices, binding, outs)
    }

    /// Computes `to_root` of every bone of each character.
    #[inline(always)]
    fn pose_bones<S: Simd>(&mut self, rig: &Rig) {
        let Self { poses, matrices } = self;
        let blocks = from_fn(|at| poses[at].blocks());
        let mut bones = EightPoses::default();
        for (block, parents) in rig.parents().chunks(LANES).enumerate() {
            turn::<S>(&blocks, block, &mut bones);
            for (lane, &parent) in parents.iter().enumerate() {
                let own = 1 + block * LANES + lane;
                // A parent comes before its children.
                let Some((before, [own, ..])) = matrices.split_at_mut_checked(own) else { return };
                let Some(parent) = before.get(parent as usize) else { return };
                bone::<S>(&bones, lane, parent, own);
            }
        }
    }
}

/// Turns the poses of eight bones of each character, so that those of one bone are in one register.
#[inline(always)]
fn turn<S: Simd>(poses: &[&[PoseBlock]; LANES], block: usize, out: &mut EightPoses) {
    const NONE: &PoseBlock = &PoseBlock::IDENTITY;
    let [a, b, c, d, e, f, g, h] = poses;
    let blocks = [
        a.get(block).unwrap_or(NONE),
        b.get(block).unwrap_or(NONE),
        c.get(block).unwrap_or(NONE),
        d.get(block).unwrap_or(NONE),
        e.get(block).unwrap_or(NONE),
        f.get(block).unwrap_or(NONE),
        g.get(block).unwrap_or(NONE),
        h.get(block).unwrap_or(NONE),
    ];
    let [x, y, z, w, tx, ty, tz, sx, sy, sz] = &mut out.0;
    for (at, out) in [x, y, z, w].into_iter().enumerate() {
        turn_one::<S>(blocks.map(|block| &block.rotation[at]), out);
    }
    for (at, out) in [tx, ty, tz].into_iter().enumerate() {
        turn_one::<S>(blocks.map(|block| &block.translation[at]), out);
    }
    for (at, out) in [sx, sy, sz].into_iter().enumerate() {
        turn_one::<S>(blocks.map(|block| &block.scale[at]), out);
    }
}

/// Transposes eight rows of eight numbers.
#[inline(always)]
fn turn_one<S: Simd>(rows: [&EightNumbers; LANES], out: &mut [EightNumbers; LANES]) {
    let ([a, b, c, d, e, f, g, h], [i, j, k, l, m, n, o, p]) = (rows.map(low), rows.map(high));
    let (first, last) = out.split_at_mut(4);
    let first_rows = [
        S::F8::from_halves(a, e),
        S::F8::from_halves(b, f),
        S::F8::from_halves(c, g),
        S::F8::from_halves(d, h),
    ];
    if let Some(first) = first.first_chunk_mut() {
        S::F8::store_four(S::F8::transpose(first_rows), first);
    }
    let last_rows = [
        S::F8::from_halves(i, m),
        S::F8::from_halves(j, n),
        S::F8::from_halves(k, o),
        S::F8::from_halves(l, p),
    ];
    if let Some(last) = last.first_chunk_mut() {
        S::F8::store_four(S::F8::transpose(last_rows), last);
    }
}

#[inline(always)]
fn low(lanes: &EightNumbers) -> &[f32; 4] {
    lanes.first_chunk().unwrap_or(&[0.0; 4])
}

#[inline(always)]
fn high(lanes: &EightNumbers) -> &[f32; 4] {
    lanes.last_chunk().unwrap_or(&[0.0; 4])
}

/// Computes `to_root` of bone `lane` of the eight bones in `bones`.
#[inline(always)]
fn bone<S: Simd>(bones: &EightPoses, lane: usize, parent: &EightMatrices, own: &mut EightMatrices) {
    let lane = lane % LANES;
    let [x, y, z, w, tx, ty, tz, a, b, c] = &bones.0;
    let local = local_rows::<S>(
        S::F8::load_four(&[x[lane], y[lane], z[lane], w[lane]]),
        S::F8::load_three(&[tx[lane], ty[lane], tz[lane]]),
        S::F8::load_three(&[a[lane], b[lane], c[lane]]),
    );
    product_row::<S, 0>(parent, &local, own);
    product_row::<S, 1>(parent, &local, own);
    product_row::<S, 2>(parent, &local, own);
}

/// Computes row `ROW` of `parent * local`.
#[inline(always)]
fn product_row<S: Simd, const ROW: usize>(
    parent: &EightMatrices,
    [[l00, l01, l02, l03], [l10, l11, l12, l13], [l20, l21, l22, l23]]: &[[S::F8; 4]; 3],
    out: &mut EightMatrices,
) {
    let at = ROW % 3 * 4;
    let (a, b) = (S::F8::load(&parent.0[at]), S::F8::load(&parent.0[at + 1]));
    let (c, d) = (S::F8::load(&parent.0[at + 2]), S::F8::load(&parent.0[at + 3]));
    c.mul_add(*l20, b.mul_add(*l10, a * *l00)).store(&mut out.0[at]);
    c.mul_add(*l21, b.mul_add(*l11, a * *l01)).store(&mut out.0[at + 1]);
    c.mul_add(*l22, b.mul_add(*l12, a * *l02)).store(&mut out.0[at + 2]);
    c.mul_add(*l23, b.mul_add(*l13, a.mul_add(*l03, d))).store(&mut out.0[at + 3]);
}

/// Computes `final_pose` of every joint of each character, and returns whether all are finite.
#[inline(always)]
fn finals<S: Simd>(matrices: &[EightMatrices], binding: &SkinBinding, outs: EightOuts) -> bool {
    let zero = S::F8::splat(0.0);
    let mut checks = [zero; 3];
    let [a, b, c, d, e, f, g, h] = outs;
    let (abcd, efgh) = (a.iter_mut().zip(b).zip(c).zip(d), e.iter_mut().zip(f).zip(g).zip(h));
    for (joint, ((((a, b), c), d), (((e, f), g), h))) in binding.list().iter().zip(abcd.zip(efgh)) {
        let Some(to_root) = matrices.get(joint.slot as usize) else { return false };
        let mut out = [a, b, c, d, e, f, g, h];
        checks[0] = final_row::<S, 0>(to_root, &joint.offset, &mut out, checks[0]);
        checks[1] = final_row::<S, 1>(to_root, &joint.offset, &mut out, checks[1]);
        checks[2] = final_row::<S, 2>(to_root, &joint.offset, &mut out, checks[2]);
    }
    // NaN is not less than anything.
    (checks[0] + checks[1] + checks[2]).less(S::F8::splat(1.0)).all()
}

/// Computes row `ROW` of `to_root * offset` and adds to `check`, which stays zero while everything is finite.
#[inline(always)]
fn final_row<S: Simd, const ROW: usize>(
    to_root: &EightMatrices,
    offset: &Matrix34,
    [a, b, c, d, e, f, g, h]: &mut [&mut Matrix34; LANES],
    check: S::F8,
) -> S::F8 {
    let at = ROW % 3 * 4;
    let (x, y) = (S::F8::load(&to_root.0[at]), S::F8::load(&to_root.0[at + 1]));
    let (z, t) = (S::F8::load(&to_root.0[at + 2]), S::F8::load(&to_root.0[at + 3]));
    let columns = [
        z.mul_add(S::F8::splat(offset[8]), y.mul_add(S::F8::splat(offset[4]), x * S::F8::splat(offset[0]))),
        z.mul_add(S::F8::splat(offset[9]), y.mul_add(S::F8::splat(offset[5]), x * S::F8::splat(offset[1]))),
        z.mul_add(S::F8::splat(offset[10]), y.mul_add(S::F8::splat(offset[6]), x * S::F8::splat(offset[2]))),
        z.mul_add(
            S::F8::splat(offset[11]),
            y.mul_add(S::F8::splat(offset[7]), x.mul_add(S::F8::splat(offset[3]), t)),
        ),
    ];
    let sum = (columns[0] + columns[1]) + (columns[2] + columns[3]);
    let check = sum.mul_add(S::F8::splat(0.0), check);
    let [ae, bf, cg, dh] = S::F8::transpose(columns);
    ae.store_halves(row::<ROW>(a), row::<ROW>(e));
    bf.store_halves(row::<ROW>(b), row::<ROW>(f));
    cg.store_halves(row::<ROW>(c), row::<ROW>(g));
    dh.store_halves(row::<ROW>(d), row::<ROW>(h));
    check
}
