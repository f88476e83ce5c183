//! Two rows of a block at once: two coordinates of eight bones each.

use super::vector::{Float8, LANES};
use std::fmt::Debug;
use std::ops::Mul;

/// Two rows of eight numbers.
pub trait RowPair: Copy + Debug + Mul<Output = Self> {
    /// One of the rows.
    type Row: Float8;

    /// Returns zeros.
    fn zero() -> Self;
    /// Loads each row from its own place.
    fn from_rows(first: &[f32; LANES], second: &[f32; LANES]) -> Self;
    /// Stores each row to its own place.
    fn store_rows(self, first: &mut [f32; LANES], second: &mut [f32; LANES]);
    /// Returns a pair of which both rows are `row`.
    fn both(row: Self::Row) -> Self;
    /// Returns `self * factor + addend`, rounded once where the level has fused multiply-add.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// Returns the sum of the two rows.
    fn sum(self) -> Self::Row;
    /// Returns `yes` in the lanes of both rows where `mask` is set, and `no` elsewhere.
    fn chosen(mask: Self::Row, yes: Self, no: Self) -> Self;
}

/// The two rows one by one.
#[derive(Clone, Copy, Debug)]
pub struct TwoRows<V: Float8>(V, V);

impl<V: Float8> Mul for TwoRows<V> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0, self.1 * other.1)
    }
}

impl<V: Float8> RowPair for TwoRows<V> {
    type Row = V;

    #[inline(always)]
    fn zero() -> Self {
        Self(V::splat(0.0), V::splat(0.0))
    }

    #[inline(always)]
    fn from_rows(first: &[f32; LANES], second: &[f32; LANES]) -> Self {
        Self(V::load(first), V::load(second))
    }

    #[inline(always)]
    fn store_rows(self, first: &mut [f32; LANES], second: &mut [f32; LANES]) {
        self.0.store(first);
        self.1.store(second);
    }

    #[inline(always)]
    fn both(row: V) -> Self {
        Self(row, row)
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(self.0.mul_add(factor.0, addend.0), self.1.mul_add(factor.1, addend.1))
    }

    #[inline(always)]
    fn sum(self) -> V {
        self.0 + self.1
    }

    #[inline(always)]
    fn chosen(mask: V, yes: Self, no: Self) -> Self {
        Self(mask.select(yes.0, no.0), mask.select(yes.1, no.1))
    }
}
