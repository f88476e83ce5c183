//! The weighted sums of the matrices of eight vertices.
//!
//! Where a matrix is one register: one vertex after the other, then the columns of four at once. Otherwise, one or two
//! influences: two vertices at once, in registers. More: one vertex after the other, two rows in one register.

use super::matrix::{IDENTITY, Matrix34, RootMatrix};
use super::simd::{Float8, LANES, Rows, Simd};
use crate::data::Influence;

/// Number of joints that a byte can index.
pub(super) const NARROW: usize = 256;

/// A matrix for each value of a byte, so that no index has to be checked.
pub(super) type MatrixTable = [RootMatrix; NARROW];

/// The `k`-th influence of eight vertices.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct InfluenceBlock {
    pub(super) joints: [u16; LANES],
    /// The same, four in each, the first in the lowest bits. Where many are used at once, compilers read `joints` as one
    /// vector and take it apart, which costs several times as much.
    fours: [u64; LANES / 4],
    pub(super) weights: [f32; LANES],
}

impl InfluenceBlock {
    /// No influence.
    pub(super) const NOTHING: Self =
        Self { joints: [0; LANES], fours: [0; LANES / 4], weights: [0.0; LANES] };

    /// Sets the influence of vertex `lane`, which has none yet.
    pub(super) fn set(&mut self, lane: usize, influence: Influence) {
        self.joints[lane % LANES] = influence.joint;
        self.fours[lane / 4 % 2] |= u64::from(influence.joint) << (lane % 4 * 16);
        self.weights[lane % LANES] = influence.weight;
    }

    /// Returns the joint of vertex `lane`, where many are used at once.
    #[inline(always)]
    fn joint(&self, lane: usize) -> u16 {
        (self.fours[lane / 4 % 2] >> (lane % 4 * 16)) as u16
    }
}

/// A list of final poses.
pub(super) trait Finals {
    /// Returns a matrix.
    fn matrix<S: Simd>(&self, joint: u16) -> S::Rows;
    /// Returns rows 0 and 1.
    fn upper<S: Simd>(&self, joint: u16) -> S::F8;
    /// Returns row 2, and four meaningless numbers.
    fn lower<S: Simd>(&self, joint: u16) -> S::F8;
    /// Returns row `row` of a matrix.
    fn row(&self, joint: u16, row: usize) -> &[f32; 4];
}

impl Finals for [Matrix34] {
    #[inline(always)]
    fn matrix<S: Simd>(&self, joint: u16) -> S::Rows {
        S::Rows::load_packed(self.get(usize::from(joint)).unwrap_or(&IDENTITY))
    }

    #[inline(always)]
    fn upper<S: Simd>(&self, joint: u16) -> S::F8 {
        let matrix = self.get(usize::from(joint)).unwrap_or(&IDENTITY);
        S::F8::load(matrix.first_chunk().unwrap_or(&[0.0; 8]))
    }

    #[inline(always)]
    fn lower<S: Simd>(&self, joint: u16) -> S::F8 {
        S::F8::twice(self.row(joint, 2))
    }

    #[inline(always)]
    fn row(&self, joint: u16, row: usize) -> &[f32; 4] {
        &self.get(usize::from(joint)).unwrap_or(&IDENTITY).as_chunks().0[row % 3]
    }
}

impl Finals for MatrixTable {
    #[inline(always)]
    fn matrix<S: Simd>(&self, joint: u16) -> S::Rows {
        S::Rows::load(&self[usize::from(joint as u8)].rows)
    }

    #[inline(always)]
    fn upper<S: Simd>(&self, joint: u16) -> S::F8 {
        S::F8::load(&self[usize::from(joint as u8)].rows.as_flattened().as_chunks().0[0])
    }

    #[inline(always)]
    fn lower<S: Simd>(&self, joint: u16) -> S::F8 {
        S::F8::load(&self[usize::from(joint as u8)].rows.as_flattened().as_chunks().0[1])
    }

    #[inline(always)]
    fn row(&self, joint: u16, row: usize) -> &[f32; 4] {
        &self[usize::from(joint as u8)].rows[row % 3]
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
    let [low, high] = [influence.joint(LANE % 4), influence.joint(LANE % 4 + 4)];
    S::F8::from_halves(finals.row(low, ROW), finals.row(high, ROW))
}

/// The columns of the weighted sums of the matrices of eight vertices: of the first four, and of the others.
pub(super) type WeighedColumns<S> = [[<S as Simd>::Rows; 4]; 2];

/// Computes the sums of any number of influences, four vertices at once.
#[inline(always)]
pub(super) fn weigh<S: Simd, const N: usize>(
    influences: [&InfluenceBlock; N],
    finals: &(impl Finals + ?Sized),
) -> WeighedColumns<S> {
    [
        S::Rows::turned([
            weigh_one::<S, N, 0>(influences, finals),
            weigh_one::<S, N, 1>(influences, finals),
            weigh_one::<S, N, 2>(influences, finals),
            weigh_one::<S, N, 3>(influences, finals),
        ]),
        S::Rows::turned([
            weigh_one::<S, N, 4>(influences, finals),
            weigh_one::<S, N, 5>(influences, finals),
            weigh_one::<S, N, 6>(influences, finals),
            weigh_one::<S, N, 7>(influences, finals),
        ]),
    ]
}

/// Computes the sum of vertex `LANE`.
#[inline(always)]
fn weigh_one<S: Simd, const N: usize, const LANE: usize>(
    influences: [&InfluenceBlock; N],
    finals: &(impl Finals + ?Sized),
) -> S::Rows {
    let matrix = finals.matrix::<S>(influences[0].joint(LANE));
    let mut sum = matrix.scaled(influences[0].weights[LANE % LANES]);
    for influence in &influences[1..] {
        let matrix = finals.matrix::<S>(influence.joint(LANE));
        sum = matrix.scaled_add(influence.weights[LANE % LANES], sum);
    }
    sum
}

/// Computes the weighted sum of the matrices of each of eight vertices, for the block's number of influences.
#[inline(always)]
pub(super) fn weigh_in_memory<S: Simd>(
    influences: &[InfluenceBlock],
    finals: &(impl Finals + ?Sized),
    out: &mut [RootMatrix; LANES],
) {
    match influences {
        [a] => put::<S, 1>([a], finals, out),
        [a, b] => put::<S, 2>([a, b], finals, out),
        [a, b, c, d] => put::<S, 4>([a, b, c, d], finals, out),
        [a, b, c, d, e, f, g, h] => put::<S, 8>([a, b, c, d, e, f, g, h], finals, out),
        _ => {}
    }
}

/// Computes the sums with the number of influences known at compile time.
#[inline(always)]
fn put<S: Simd, const N: usize>(
    influences: [&InfluenceBlock; N],
    finals: &(impl Finals + ?Sized),
    out: &mut [RootMatrix; LANES],
) {
    // Unrolled, so that every index is known at compile time.
    put_one::<S, N>(influences, finals, out, 0);
    put_one::<S, N>(influences, finals, out, 1);
    put_one::<S, N>(influences, finals, out, 2);
    put_one::<S, N>(influences, finals, out, 3);
    put_one::<S, N>(influences, finals, out, 4);
    put_one::<S, N>(influences, finals, out, 5);
    put_one::<S, N>(influences, finals, out, 6);
    put_one::<S, N>(influences, finals, out, 7);
}

#[inline(always)]
fn put_one<S: Simd, const N: usize>(
    influences: [&InfluenceBlock; N],
    finals: &(impl Finals + ?Sized),
    out: &mut [RootMatrix; LANES],
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
    if let [upper, lower] = out[lane].rows.as_flattened_mut().as_chunks_mut().0 {
        two.store(upper);
        one.store(lower);
    }
}

/// Returns row `row` of eight matrices: four vectors, one per column.
#[inline(always)]
pub(super) fn columns<S: Simd>(matrices: &[RootMatrix; LANES], row: usize) -> [S::F8; 4] {
    let [a, b, c, d, e, f, g, h] = matrices;
    let [a, b, c, d] = [a, b, c, d].map(|matrix| &matrix.rows[row]);
    let [e, f, g, h] = [e, f, g, h].map(|matrix| &matrix.rows[row]);
    S::F8::transpose([
        S::F8::from_halves(a, e),
        S::F8::from_halves(b, f),
        S::F8::from_halves(c, g),
        S::F8::from_halves(d, h),
    ])
}

/// Computes the weighted sum of the matrices of each of eight vertices, one number at a time.
#[cold]
pub(super) fn weigh_carefully(influences: &[InfluenceBlock], finals: &[Matrix34]) -> [RootMatrix; LANES] {
    let mut out = [RootMatrix { rows: [[0.0; 4]; 4] }; LANES];
    for influence in influences {
        for (lane, sum) in out.iter_mut().enumerate() {
            let matrix = finals.get(usize::from(influence.joints[lane])).unwrap_or(&IDENTITY);
            for (sum, number) in sum.rows.as_flattened_mut().iter_mut().zip(matrix) {
                *sum += number * influence.weights[lane];
            }
        }
    }
    out
}
