//! Two rows of eight numbers at once: two coordinates of the bones of a block, or one coordinate of the bones of two.

use super::arithmetic::Arithmetic;
use super::vector::{Float8, LANES, Word8};
use std::fmt::Debug;
use std::ops::{Add, Mul};

/// Two rows of eight numbers.
pub trait RowPair: Arithmetic {
    /// One of the rows.
    type Row: Float8;
    /// Two rows of eight words of 32 bits.
    type Words: Copy + Debug;

    /// Loads each row from its own place.
    fn from_rows(first: &[f32; LANES], second: &[f32; LANES]) -> Self;
    /// Loads rows that are next to each other.
    fn load(rows: &[[f32; LANES]; 2]) -> Self;
    /// Loads numbers of which only the highest 16 bits are stored; the others are zero.
    fn from_high_bits(rows: &[[u16; LANES]; 2]) -> Self;
    /// Stores each row to its own place.
    fn store_rows(self, first: &mut [f32; LANES], second: &mut [f32; LANES]);
    /// Returns a pair of two rows.
    fn of(rows: [Self::Row; 2]) -> Self;
    /// Returns a pair of which both rows are `row`.
    #[inline(always)]
    fn both(row: Self::Row) -> Self {
        Self::of([row; 2])
    }
    /// Returns the two rows.
    fn rows(self) -> [Self::Row; 2];
    /// Returns the sum of the two rows.
    #[inline(always)]
    fn sum(self) -> Self::Row {
        let [first, second] = self.rows();
        first + second
    }
    /// Returns `yes` in the lanes of both rows where `mask` is set, and `no` elsewhere.
    fn chosen(mask: Self::Row, yes: Self, no: Self) -> Self;
    /// Loads four bytes into each lane, as [`Word8::near`] does: each row with its own `at`, `second` and `lanes`.
    fn near(bytes: &[u8], at: [usize; 2], second: [u8; 2], lanes: &[[u8; LANES]; 2]) -> Self::Words;
    /// Returns the bits of `words` that are also set in `masks`, as numbers: exact below 2²⁴, rounded below 2³¹.
    fn masked(words: Self::Words, masks: &[[u32; LANES]; 2]) -> Self;
}

/// The two rows one by one.
#[derive(Clone, Copy, Debug)]
pub struct TwoRows<V: Float8>(V, V);

impl<V: Float8> Add for TwoRows<V> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl<V: Float8> Mul for TwoRows<V> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0, self.1 * other.1)
    }
}

impl<V: Float8> Arithmetic for TwoRows<V> {
    #[inline(always)]
    fn all(value: f32) -> Self {
        Self(V::splat(value), V::splat(value))
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        Self(self.0.mul_add(factor.0, addend.0), self.1.mul_add(factor.1, addend.1))
    }

    #[inline(always)]
    fn times_from(self, factor: Self, minuend: Self) -> Self {
        Self(self.0.neg_mul_add(factor.0, minuend.0), self.1.neg_mul_add(factor.1, minuend.1))
    }

    #[inline(always)]
    fn root(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1.max(other.1))
    }

    #[inline(always)]
    fn any_less(self, other: Self) -> bool {
        self.0.less(other.0).any() || self.1.less(other.1).any()
    }
}

impl<V: Float8> RowPair for TwoRows<V> {
    type Row = V;
    type Words = [V::Word; 2];

    #[inline(always)]
    fn from_rows(first: &[f32; LANES], second: &[f32; LANES]) -> Self {
        Self(V::load(first), V::load(second))
    }

    #[inline(always)]
    fn load(rows: &[[f32; LANES]; 2]) -> Self {
        Self(V::load(&rows[0]), V::load(&rows[1]))
    }

    #[inline(always)]
    fn from_high_bits(rows: &[[u16; LANES]; 2]) -> Self {
        let sixteen = V::Word::splat(16);
        let [first, second] = [V::Word::from_u16(&rows[0]), V::Word::from_u16(&rows[1])];
        Self(first.shifted_left(sixteen).as_float(), second.shifted_left(sixteen).as_float())
    }

    #[inline(always)]
    fn store_rows(self, first: &mut [f32; LANES], second: &mut [f32; LANES]) {
        self.0.store(first);
        self.1.store(second);
    }

    #[inline(always)]
    fn of([first, second]: [V; 2]) -> Self {
        Self(first, second)
    }

    #[inline(always)]
    fn rows(self) -> [V; 2] {
        [self.0, self.1]
    }

    #[inline(always)]
    fn chosen(mask: V, yes: Self, no: Self) -> Self {
        Self(mask.select(yes.0, no.0), mask.select(yes.1, no.1))
    }

    #[inline(always)]
    fn near(bytes: &[u8], at: [usize; 2], second: [u8; 2], lanes: &[[u8; LANES]; 2]) -> [V::Word; 2] {
        [V::Word::near(bytes, at[0], second[0], &lanes[0]), V::Word::near(bytes, at[1], second[1], &lanes[1])]
    }

    #[inline(always)]
    fn masked([first, second]: [V::Word; 2], masks: &[[u32; LANES]; 2]) -> Self {
        let [first, second] = [first & V::Word::load(&masks[0]), second & V::Word::load(&masks[1])];
        Self(first.to_float(), second.to_float())
    }
}
