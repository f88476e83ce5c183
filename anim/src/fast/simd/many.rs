//! The widest vectors of a level: one number of each of several characters.

use super::arithmetic::Arithmetic;
use super::vector::{Float8, LANES};
use std::fmt::Debug;

/// The largest number of lanes of [`Many`].
pub const MOST_LANES: usize = 16;

/// The `f32` of the widest register.
pub trait Many: Arithmetic {
    /// The same numbers in memory.
    type Numbers: Copy + Debug;
    /// How many numbers, at most [`MOST_LANES`].
    const COUNT: usize;

    /// Zeros in memory.
    const ZEROS: Self::Numbers;
    /// Returns memory as numbers of these vectors; what is left at the end is not used.
    fn numbers_of(memory: &mut [f32]) -> &mut [Self::Numbers];
    /// Loads from memory, lane by lane.
    fn get(from: &Self::Numbers) -> Self;
    /// Stores to memory, lane by lane.
    fn put(self, to: &mut Self::Numbers);
    /// Returns whether no number is NaN.
    fn is_number(self) -> bool;
    /// Transposes `rows`, of which the first [`Self::COUNT`] are used: number `k` of row `i` becomes number `i` of
    /// `to[k]`.
    fn turn(rows: &[&[f32; LANES]; MOST_LANES], to: &mut [Self::Numbers; LANES]);
    /// Stores one matrix of each lane; `columns[row][column]` has one number of each. The matrix of lane `i` goes to
    /// `to[at + i * stride]`. Returns false, with nothing stored, if they are not all within `to`, or would overlap.
    fn store_matrices(columns: &[[Self; 4]; 3], to: &mut [[f32; 12]], at: usize, stride: usize) -> bool;
}

/// Levels without wider registers use vectors of eight.
impl<V: Float8> Many for V {
    type Numbers = [f32; LANES];
    const COUNT: usize = LANES;

    const ZEROS: Self::Numbers = [0.0; LANES];

    #[inline(always)]
    fn numbers_of(memory: &mut [f32]) -> &mut [[f32; LANES]] {
        memory.as_chunks_mut().0
    }

    #[inline(always)]
    fn get(from: &[f32; LANES]) -> Self {
        V::load(from)
    }

    #[inline(always)]
    fn put(self, to: &mut [f32; LANES]) {
        self.store(to);
    }

    #[inline(always)]
    fn is_number(self) -> bool {
        // NaN is not less than anything.
        self.less(V::splat(f32::INFINITY)).all()
    }

    #[inline(always)]
    fn turn(rows: &[&[f32; LANES]; MOST_LANES], to: &mut [[f32; LANES]; LANES]) {
        let [a, b, c, d, e, f, g, h, ..] = rows;
        let low = V::transpose([
            V::from_halves(low(a), low(e)),
            V::from_halves(low(b), low(f)),
            V::from_halves(low(c), low(g)),
            V::from_halves(low(d), low(h)),
        ]);
        let high = V::transpose([
            V::from_halves(high(a), high(e)),
            V::from_halves(high(b), high(f)),
            V::from_halves(high(c), high(g)),
            V::from_halves(high(d), high(h)),
        ]);
        let (first, last) = to.split_at_mut(4);
        if let (Some(first), Some(last)) = (first.first_chunk_mut(), last.first_chunk_mut()) {
            V::store_four(low, first);
            V::store_four(high, last);
        }
    }

    #[inline(always)]
    fn store_matrices(columns: &[[Self; 4]; 3], to: &mut [[f32; 12]], at: usize, stride: usize) -> bool {
        let Some([a, b, c, d, e, f, g, h]) = super::apart::apart(to, at, stride) else { return false };
        store_row::<V, 0>(columns, [a, b, c, d], [e, f, g, h]);
        store_row::<V, 1>(columns, [a, b, c, d], [e, f, g, h]);
        store_row::<V, 2>(columns, [a, b, c, d], [e, f, g, h]);
        true
    }
}

/// Stores row `ROW` of eight matrices.
#[inline(always)]
fn store_row<V: Float8, const ROW: usize>(
    columns: &[[V; 4]; 3],
    [a, b, c, d]: [&mut [f32; 12]; 4],
    [e, f, g, h]: [&mut [f32; 12]; 4],
) {
    let [ae, bf, cg, dh] = V::transpose(columns[ROW % 3]);
    ae.store_halves(row::<ROW>(a), row::<ROW>(e));
    bf.store_halves(row::<ROW>(b), row::<ROW>(f));
    cg.store_halves(row::<ROW>(c), row::<ROW>(g));
    dh.store_halves(row::<ROW>(d), row::<ROW>(h));
}

/// Returns row `ROW`.
#[inline(always)]
pub(super) fn row<const ROW: usize>(matrix: &mut [f32; 12]) -> &mut [f32; 4] {
    &mut matrix.as_chunks_mut().0[ROW % 3]
}

/// Returns the first four numbers.
#[inline(always)]
pub(in crate::fast) fn low(lanes: &[f32; LANES]) -> &[f32; 4] {
    lanes.first_chunk().unwrap_or(&[0.0; 4])
}

/// Returns the last four numbers.
#[inline(always)]
pub(in crate::fast) fn high(lanes: &[f32; LANES]) -> &[f32; 4] {
    lanes.last_chunk().unwrap_or(&[0.0; 4])
}
