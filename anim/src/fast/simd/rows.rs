//! Matrices of three rows in registers: affine transforms without their last row, which is always 0 0 0 1.

use super::vector::{Float4, Float8};
use std::fmt::Debug;

/// Three rows of four numbers. In memory they may be followed by four numbers without a meaning, so that a matrix is as
/// wide as the widest register.
pub trait Rows: Copy + Debug {
    /// Whether a matrix is one register, so that many are left.
    const IS_ONE_REGISTER: bool;
    /// One number of each of eight matrices.
    type Column: Float8;
    /// The left matrix of a product.
    type Columns: Copy + Debug;

    /// Returns zeros.
    fn zero() -> Self;
    /// Loads from memory.
    fn load(from: &[[f32; 4]; 4]) -> Self;
    /// Stores to memory. What the last four numbers become is not specified.
    fn store(self, to: &mut [[f32; 4]; 4]);
    /// Stores only the three rows.
    fn store_packed(self, to: &mut [f32; 12]);
    /// Returns `self * other`: see [`Self::product`].
    #[inline(always)]
    fn times(self, other: &[[f32; 4]; 3]) -> Self {
        Self::product(self.columns(), other)
    }
    /// Returns the matrix as [`Self::product`] needs it, for several products.
    fn columns(self) -> Self::Columns;
    /// Returns `matrix * other`:
    ///
    /// ```text
    /// row_i = matrix_i0 * other_0 + matrix_i1 * other_1 + matrix_i2 * other_2 + (0 0 0 matrix_i3)
    /// ```
    fn product(matrix: Self::Columns, other: &[[f32; 4]; 3]) -> Self;
    /// Returns `sum` if all numbers are finite, and NaN in some places otherwise.
    fn checked(self, sum: Self) -> Self;
    /// Returns whether no number is NaN.
    fn is_number(self) -> bool;
    /// Stores eight matrices; `columns[row][column]` has one number of each.
    fn store_eight(columns: [[Self::Column; 4]; 3], to: [&mut [[f32; 4]; 4]; 8]);
}

/// Rows 0 and 1 in one vector of eight, row 2 in one of four.
#[derive(Clone, Copy, Debug)]
pub struct TwoVectors<V: Float8>(V, V::Half);

impl<V: Float8> Rows for TwoVectors<V> {
    const IS_ONE_REGISTER: bool = false;
    type Column = V;
    /// There are too few registers to keep the columns one by one.
    type Columns = Self;

    #[inline(always)]
    fn zero() -> Self {
        let zero = V::splat(0.0);
        Self(zero, zero.low())
    }

    #[inline(always)]
    fn load(from: &[[f32; 4]; 4]) -> Self {
        let upper = from.as_flattened().first_chunk().unwrap_or(&[0.0; 8]);
        Self(V::load(upper), V::Half::load(&from[2]))
    }

    #[inline(always)]
    fn store(self, to: &mut [[f32; 4]; 4]) {
        if let Some(rows) = to.as_flattened_mut().first_chunk_mut() {
            self.store_packed(rows);
        }
    }

    #[inline(always)]
    fn store_packed(self, to: &mut [f32; 12]) {
        if let Some(upper) = to.first_chunk_mut() {
            self.0.store(upper);
        }
        if let Some(lower) = to.last_chunk_mut() {
            self.1.store(lower);
        }
    }

    #[inline(always)]
    fn columns(self) -> Self {
        self
    }

    #[inline(always)]
    fn product(Self(two, one): Self, [x, y, z]: &[[f32; 4]; 3]) -> Self {
        // Each row of the other matrix in both halves of a vector.
        let [x, y, z] = [V::twice(x), V::twice(y), V::twice(z)];
        let upper = two.spread::<0>().mul_add(x, two.keep_last());
        let lower = one.spread::<0>().mul_add(x.low(), one.keep_last());
        let upper = two.spread::<1>().mul_add(y, upper);
        let lower = one.spread::<1>().mul_add(y.low(), lower);
        Self(two.spread::<2>().mul_add(z, upper), one.spread::<2>().mul_add(z.low(), lower))
    }

    #[inline(always)]
    fn checked(self, sum: Self) -> Self {
        let zero = Self::zero();
        Self(self.0.mul_add(zero.0, sum.0), self.1.mul_add(zero.1, sum.1))
    }

    #[inline(always)]
    fn is_number(self) -> bool {
        let mut lower = [0.0; 4];
        self.1.store(&mut lower);
        // NaN is not less than anything.
        (self.0 + V::twice(&lower)).less(V::splat(f32::INFINITY)).all()
    }

    #[inline(always)]
    fn store_eight([upper, middle, lower]: [[V; 4]; 3], [a, b, c, d, e, f, g, h]: [&mut [[f32; 4]; 4]; 8]) {
        let [x, y, z, w] = V::transpose(upper);
        x.store_halves(&mut a[0], &mut e[0]);
        y.store_halves(&mut b[0], &mut f[0]);
        z.store_halves(&mut c[0], &mut g[0]);
        w.store_halves(&mut d[0], &mut h[0]);
        let [x, y, z, w] = V::transpose(middle);
        x.store_halves(&mut a[1], &mut e[1]);
        y.store_halves(&mut b[1], &mut f[1]);
        z.store_halves(&mut c[1], &mut g[1]);
        w.store_halves(&mut d[1], &mut h[1]);
        let [x, y, z, w] = V::transpose(lower);
        x.store_halves(&mut a[2], &mut e[2]);
        y.store_halves(&mut b[2], &mut f[2]);
        z.store_halves(&mut c[2], &mut g[2]);
        w.store_halves(&mut d[2], &mut h[2]);
    }
}
