//! Matrices of three rows: an affine transform without its last row, which is always 0 0 0 1.
//!
//! ```text
//! m[0] m[1] m[2]  m[3]       x axis x, y axis x, z axis x, translation x
//! m[4] m[5] m[6]  m[7]       … y
//! m[8] m[9] m[10] m[11]      … z
//! ```
//!
//! 48 bytes where a [`Mat4`] has 64, and correspondingly fewer operations. A list of them is a list of floats for the
//! GPU without a copy: `matrices.as_flattened()`; in a shader three rows per matrix, `position' = row · (position, 1)`.

use super::simd::{Float4, Float8, Simd};
use glam::{Mat4, Vec3};

/// Three rows of four numbers, for column vectors.
pub type Matrix34 = [f32; 12];

/// The identity.
pub const IDENTITY: Matrix34 = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];

/// Returns the first three rows of `matrix`.
pub fn matrix34(matrix: Mat4) -> Matrix34 {
    let [x, y, z, w] = matrix.to_cols_array_2d();
    [x[0], y[0], z[0], w[0], x[1], y[1], z[1], w[1], x[2], y[2], z[2], w[2]]
}

/// Returns `matrix` with its last row.
pub fn mat4(matrix: &Matrix34) -> Mat4 {
    let [a, b, c, d, e, f, g, h, i, j, k, l] = *matrix;
    Mat4::from_cols_array(&[a, e, i, 0.0, b, f, j, 0.0, c, g, k, 0.0, d, h, l, 1.0])
}

/// Returns `matrix * (point, 1)`.
pub fn transform_point(matrix: &Matrix34, point: Vec3) -> Vec3 {
    let row = |at: usize| Vec3::new(matrix[at], matrix[at + 1], matrix[at + 2]).dot(point) + matrix[at + 3];
    Vec3::new(row(0), row(4), row(8))
}

/// Returns rows 0 and 1.
#[inline(always)]
pub(super) fn upper(matrix: &Matrix34) -> &[f32; 8] {
    matrix.first_chunk().unwrap_or(&[0.0; 8])
}

/// Returns row 2.
#[inline(always)]
pub(super) fn lower(matrix: &Matrix34) -> &[f32; 4] {
    matrix.last_chunk().unwrap_or(&[0.0; 4])
}

/// Returns row `ROW`.
#[inline(always)]
pub(super) fn row<const ROW: usize>(matrix: &mut Matrix34) -> &mut [f32; 4] {
    &mut matrix.as_chunks_mut().0[ROW % 3]
}

/// Rows of a matrix in registers: 0 and 1, and 2.
#[derive(Clone, Copy)]
pub(super) struct MatrixRows<S: Simd>(pub(super) S::F8, pub(super) S::F4);

impl<S: Simd> MatrixRows<S> {
    #[inline(always)]
    pub(super) fn load(matrix: &Matrix34) -> Self {
        Self(S::F8::load(upper(matrix)), S::F4::load(lower(matrix)))
    }

    #[inline(always)]
    pub(super) fn store(self, matrix: &mut Matrix34) {
        if let Some(upper) = matrix.first_chunk_mut() {
            self.0.store(upper);
        }
        if let Some(lower) = matrix.last_chunk_mut() {
            self.1.store(lower);
        }
    }

    /// Returns `self * other`, with each row of `other` in both halves of its register:
    ///
    /// ```text
    /// row_i = self_i0 * other_0 + self_i1 * other_1 + self_i2 * other_2 + (0 0 0 self_i3)
    /// ```
    #[inline(always)]
    pub(super) fn times(self, [x, y, z]: [S::F8; 3]) -> Self {
        let Self(two, one) = self;
        let upper = two.spread::<0>().mul_add(x, two.keep_last());
        let lower = one.spread::<0>().mul_add(x.low(), one.keep_last());
        let upper = two.spread::<1>().mul_add(y, upper);
        let lower = one.spread::<1>().mul_add(y.low(), lower);
        Self(two.spread::<2>().mul_add(z, upper), one.spread::<2>().mul_add(z.low(), lower))
    }
}

/// Returns the rows of a matrix, each in both halves of a register.
#[inline(always)]
pub(super) fn doubled<S: Simd>(matrix: &Matrix34) -> [S::F8; 3] {
    let rows = matrix.as_chunks::<4>().0;
    [S::F8::twice(&rows[0]), S::F8::twice(&rows[1]), S::F8::twice(&rows[2])]
}
