//! Arithmetic on any number of lanes.

use super::vector::Float8;
use std::fmt::Debug;
use std::ops::{Add, Mul};

/// The operations that vectors of any width have.
pub trait Arithmetic: Copy + Debug + Add<Output = Self> + Mul<Output = Self> {
    /// Returns the same number in all lanes.
    fn all(value: f32) -> Self;
    /// Returns `self * factor + addend`, rounded once where the level has fused multiply-add.
    fn times_plus(self, factor: Self, addend: Self) -> Self;
    /// Returns `minuend - self * factor`, rounded once where the level has fused multiply-add.
    fn times_from(self, factor: Self, minuend: Self) -> Self;
    /// Returns the square root, correctly rounded; NaN for numbers below zero.
    fn root(self) -> Self;
    /// Returns the larger; `other` where either is NaN.
    fn larger(self, other: Self) -> Self;
    /// Returns whether any number is less than that of `other`; NaN is not.
    fn any_less(self, other: Self) -> bool;
}

impl<V: Float8> Arithmetic for V {
    #[inline(always)]
    fn all(value: f32) -> Self {
        V::splat(value)
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, addend: Self) -> Self {
        self.mul_add(factor, addend)
    }

    #[inline(always)]
    fn times_from(self, factor: Self, minuend: Self) -> Self {
        self.neg_mul_add(factor, minuend)
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.max(other)
    }

    #[inline(always)]
    fn any_less(self, other: Self) -> bool {
        self.less(other).any()
    }
}
