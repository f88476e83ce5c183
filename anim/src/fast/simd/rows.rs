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

    /// Loads only the three rows.
    fn load_packed(from: &[f32; 12]) -> Self;
    /// Returns `self * factor`.
    fn scaled(self, factor: f32) -> Self;
    /// Returns `self * factor + sum`.
    fn scaled_add(self, factor: f32, sum: Self) -> Self;
    /// Returns the columns of four matrices: row `r` of column `k` has number `k` of row `r` of each.
    fn turned(matrices: [Self; 4]) -> [Self; 4];
    /// Moves four points by the four matrices with these columns: row `r` of the result has coordinate `r` of each.
    fn moved(columns: [Self; 4], points: [&[f32; 4]; 3]) -> Self;
    /// As [`Self::moved`], for directions: the last column is left out.
    fn directed(columns: [Self; 4], directions: [&[f32; 4]; 3]) -> Self;
    /// Stores two times four points, of which row `r` has coordinate `r`, as eight points: x y z x y z …
    fn store_points(points: [Self; 2], to: &mut [f32; 24]);
    /// Returns each row of two matrices in one vector, the numbers of the first in the low half.
    fn joined(two: [Self; 2]) -> [Self::Column; 3];
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

    #[inline(always)]
    fn load_packed(from: &[f32; 12]) -> Self {
        let lower = from.last_chunk().unwrap_or(&[0.0; 4]);
        Self(V::load(from.first_chunk().unwrap_or(&[0.0; 8])), V::Half::load(lower))
    }

    #[inline(always)]
    fn scaled(self, factor: f32) -> Self {
        let factor = V::splat(factor);
        Self(self.0 * factor, self.1 * factor.low())
    }

    #[inline(always)]
    fn scaled_add(self, factor: f32, sum: Self) -> Self {
        let factor = V::splat(factor);
        Self(self.0.mul_add(factor, sum.0), self.1.mul_add(factor.low(), sum.1))
    }

    #[inline(always)]
    fn turned([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        let [x, y, z, w] = V::transpose([a.0, b.0, c.0, d.0]);
        let [p, q, r, s] = V::Half::transpose([a.1, b.1, c.1, d.1]);
        [Self(x, p), Self(y, q), Self(z, r), Self(w, s)]
    }

    #[inline(always)]
    fn moved([a, b, c, t]: [Self; 4], [x, y, z]: [&[f32; 4]; 3]) -> Self {
        let [x, y, z] = [V::twice(x), V::twice(y), V::twice(z)];
        let lower = a.1.mul_add(x.low(), b.1.mul_add(y.low(), c.1.mul_add(z.low(), t.1)));
        Self(a.0.mul_add(x, b.0.mul_add(y, c.0.mul_add(z, t.0))), lower)
    }

    #[inline(always)]
    fn directed([a, b, c, _]: [Self; 4], [x, y, z]: [&[f32; 4]; 3]) -> Self {
        let [x, y, z] = [V::twice(x), V::twice(y), V::twice(z)];
        let lower = a.1.mul_add(x.low(), b.1.mul_add(y.low(), c.1 * z.low()));
        Self(a.0.mul_add(x, b.0.mul_add(y, c.0 * z)), lower)
    }

    #[inline(always)]
    fn store_points(points: [Self; 2], to: &mut [f32; 24]) {
        V::store_points(Self::joined(points), to);
    }

    #[inline(always)]
    fn joined([a, b]: [Self; 2]) -> [V; 3] {
        [V::joined(a.0.low(), b.0.low()), V::joined(a.0.high(), b.0.high()), V::joined(a.1, b.1)]
    }
}
