//! The weighted sums of the matrices of eight vertices.
//!
//! One or two influences: two vertices at once, in registers. More: one vertex after the other, two rows in one register.

use super::matrix::{IDENTITY, Matrix34, lower, upper};
use super::simd::{Float8, LANES, Simd};

/// Number of joints that a byte can index.
pub(super) const NARROW: usize = 256;

/// A matrix aligned to its size, so that a shifted index is its offset.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct PaddedMatrix(pub(super) [f32; 16]);

/// A matrix for each value of a byte, so that no index has to be checked.
pub(super) type MatrixTable = [PaddedMatrix; NARROW];

/// The identity, and padding.
pub(super) const PADDED_IDENTITY: PaddedMatrix =
    PaddedMatrix([1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 0.]);

/// The `k`-th influence of eight vertices.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct InfluenceBlock {
    pub(super) joints: [u16; LANES],
    pub(super) weights: [f32; LANES],
}

/// A list of final poses.
pub(super) trait Finals {
    /// Returns rows 0 and 1.
    fn upper<S: Simd>(&self, joint: u16) -> S::F8;
    /// Returns row 2, and four meaningless numbers.
    fn lower<S: Simd>(&self, joint: u16) -> S::F8;
    /// Returns row `row`.
    fn row(&self, joint: u16, row: usize) -> &[f32; 4];
}

impl Finals for [Matrix34] {
    #[inline(always)]
    fn upper<S: Simd>(&self, joint: u16) -> S::F8 {
        S::F8::load(upper(self.get(usize::from(joint)).unwrap_or(&IDENTITY)))
    }

    #[inline(always)]
    fn lower<S: Simd>(&self, joint: u16) -> S::F8 {
        S::F8::twice(lower(self.get(usize::from(joint)).unwrap_or(&IDENTITY)))
    }

    #[inline(always)]
    fn row(&self, joint: u16, row: usize) -> &[f32; 4] {
        &self.get(usize::from(joint)).unwrap_or(&IDENTITY).as_chunks().0[row % 3]
    }
}

impl Finals for MatrixTable {
    #[inline(always)]
    fn upper<S: Simd>(&self, joint: u16) -> S::F8 {
        S::F8::load(&self[usize::from(joint as u8)].0.as_chunks().0[0])
    }

    #[inline(always)]
    fn lower<S: Simd>(&self, joint: u16) -> S::F8 {
        S::F8::load(&self[usize::from(joint as u8)].0.as_chunks().0[1])
    }

    #[inline(always)]
    fn row(&self, joint: u16, row: usize) -> &[f32; 4] {
        &self[usize::from(joint as u8)].0.as_chunks().0[row % 3]
    }
}

/// The weighted sums of the matrices of eight vertices: the columns of each row.
pub(super) type Sums<S> = [[<S as Simd>::F8; 4]; 3];

/// Computes the sums of one or two influences, two vertices at once.
#[inline(always)]
pub(super) fn few<S: Simd, const N: usize>(
    influences: [&InfluenceBlock; N],
    finals: &(impl Finals + ?Sized),
) -> Sums<S> {
    [
        few_columns::<S, N, 0>(influences, finals),
        few_columns::<S, N, 1>(influences, finals),
        few_columns::<S, N, 2>(influences, finals),
    ]
}

#[inline(always)]
fn few_columns<S: Simd, const N: usize, const ROW: usize>(
    influences: [&InfluenceBlock; N],
    finals: &(impl Finals + ?Sized),
) -> [S::F8; 4] {
    S::F8::transpose([
        few_row::<S, N, ROW, 0>(influences, finals),
        few_row::<S, N, ROW, 1>(influences, finals),
        few_row::<S, N, ROW, 2>(influences, finals),
        few_row::<S, N, ROW, 3>(influences, finals),
    ])
}

/// Computes row `ROW` of vertex `LANE` (0..=3) in the low half, and of vertex `LANE + 4` in the high half.
#[inline(always)]
fn few_row<S: Simd, const N: usize, const ROW: usize, const LANE: usize>(
    influences: [&InfluenceBlock; N],
    finals: &(impl Finals + ?Sized),
) -> S::F8 {
    let mut sum = two_rows::<S, ROW, LANE>(influences[0], finals)
        * S::F8::load(&influences[0].weights).spread::<LANE>();
    for influence in &influences[1..] {
        let weight = S::F8::load(&influence.weights).spread::<LANE>();
        sum = two_rows::<S, ROW, LANE>(influence, finals).mul_add(weight, sum);
    }
    sum
}

#[inline(always)]
fn two_rows<S: Simd, const ROW: usize, const LANE: usize>(
    influence: &InfluenceBlock,
    finals: &(impl Finals + ?Sized),
) -> S::F8 {
    let [low, high] = [influence.joints[LANE % 4], influence.joints[LANE % 4 + 4]];
    S::F8::from_halves(finals.row(low, ROW), finals.row(high, ROW))
}

/// Computes the weighted sum of the matrices of each of eight vertices, for the block's number of influences.
#[inline(always)]
pub(super) fn weigh_block<S: Simd>(
    influences: &[InfluenceBlock],
    finals: &(impl Finals + ?Sized),
    out: &mut [PaddedMatrix; LANES],
) {
    match influences {
        [a] => weigh::<S, 1>([a], finals, out),
        [a, b] => weigh::<S, 2>([a, b], finals, out),
        [a, b, c, d] => weigh::<S, 4>([a, b, c, d], finals, out),
        [a, b, c, d, e, f, g, h] => weigh::<S, 8>([a, b, c, d, e, f, g, h], finals, out),
        _ => {}
    }
}

/// Computes the sums with the number of influences known at compile time.
#[inline(always)]
fn weigh<S: Simd, const N: usize>(
    influences: [&InfluenceBlock; N],
    finals: &(impl Finals + ?Sized),
    out: &mut [PaddedMatrix; LANES],
) {
    // Unrolled, so that every index is known at compile time.
    weigh_one::<S, N>(influences, finals, out, 0);
    weigh_one::<S, N>(influences, finals, out, 1);
    weigh_one::<S, N>(influences, finals, out, 2);
    weigh_one::<S, N>(influences, finals, out, 3);
    weigh_one::<S, N>(influences, finals, out, 4);
    weigh_one::<S, N>(influences, finals, out, 5);
    weigh_one::<S, N>(influences, finals, out, 6);
    weigh_one::<S, N>(influences, finals, out, 7);
}

#[inline(always)]
fn weigh_one<S: Simd, const N: usize>(
    influences: [&InfluenceBlock; N],
    finals: &(impl Finals + ?Sized),
    out: &mut [PaddedMatrix; LANES],
    lane: usize,
) {
    let joint = influences[0].joints[lane];
    let weight = S::F8::splat(influences[0].weights[lane]);
    // Row 2 has only four numbers, but is computed in a register of eight too, because a register of four would need
    // the weight broadcast once more.
    let (mut two, mut one) = (finals.upper::<S>(joint) * weight, finals.lower::<S>(joint) * weight);
    for influence in &influences[1..] {
        let (joint, weight) = (influence.joints[lane], S::F8::splat(influence.weights[lane]));
        two = finals.upper::<S>(joint).mul_add(weight, two);
        one = finals.lower::<S>(joint).mul_add(weight, one);
    }
    if let [upper, lower] = out[lane].0.as_chunks_mut().0 {
        two.store(upper);
        one.store(lower);
    }
}

/// Returns row `row` of eight matrices: four vectors, one per column.
#[inline(always)]
pub(super) fn columns<S: Simd>(matrices: &[PaddedMatrix; LANES], row: usize) -> [S::F8; 4] {
    let [a, b, c, d, e, f, g, h] = matrices;
    let [a, b, c, d] = [a, b, c, d].map(|matrix| &matrix.0.as_chunks::<4>().0[row]);
    let [e, f, g, h] = [e, f, g, h].map(|matrix| &matrix.0.as_chunks::<4>().0[row]);
    S::F8::transpose([
        S::F8::from_halves(a, e),
        S::F8::from_halves(b, f),
        S::F8::from_halves(c, g),
        S::F8::from_halves(d, h),
    ])
}

/// Computes the weighted sum of the matrices of each of eight vertices, one number at a time.
#[cold]
pub(super) fn weigh_carefully(influences: &[InfluenceBlock], finals: &[Matrix34]) -> [PaddedMatrix; LANES] {
    let mut out = [PaddedMatrix([0.0; 16]); LANES];
    for influence in influences {
        for (lane, sum) in out.iter_mut().enumerate() {
            let matrix = finals.get(usize::from(influence.joints[lane])).unwrap_or(&IDENTITY);
            for (sum, number) in sum.0.iter_mut().zip(matrix) {
                *sum += number * influence.weights[lane];
            }
        }
    }
    out
}
