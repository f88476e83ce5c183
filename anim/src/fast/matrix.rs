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

/// A [`Matrix34`] in memory of 64 bytes: the width of a cache line, and of the widest registers.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct RootMatrix {
    /// Three rows, and four numbers without a meaning.
    pub(super) rows: [[f32; 4]; 4],
}

impl RootMatrix {
    /// The identity.
    pub(super) const IDENTITY: Self =
        Self { rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0; 4]] };

    /// Returns the three rows.
    pub fn packed(&self) -> &Matrix34 {
        self.rows.as_flattened().first_chunk().unwrap_or(&IDENTITY)
    }

    /// Returns the three rows one by one.
    #[inline(always)]
    pub(super) fn three_rows(&self) -> &[[f32; 4]; 3] {
        self.rows.first_chunk().unwrap_or(&[[0.0; 4]; 3])
    }

    /// Sets the three rows.
    pub(super) fn set(&mut self, matrix: &Matrix34) {
        for (row, from) in self.rows.iter_mut().zip(matrix.as_chunks().0) {
            *row = *from;
        }
    }
}
