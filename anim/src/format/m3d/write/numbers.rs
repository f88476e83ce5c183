//! Rows of numbers, and matrices that are the same except for rounding.

use crate::format::key_rows::number;
use glam::Mat4;

/// Returns numbers with blanks between them.
pub(super) fn row(numbers: &[f32]) -> String {
    numbers.iter().map(|&value| number(value)).collect::<Vec<_>>().join(" ")
}

/// Returns whether two matrices are the same except for rounding.
pub(super) fn is_near(a: Mat4, b: Mat4) -> bool {
    let largest = a.to_cols_array().into_iter().fold(1e-6_f32, |largest, number| largest.max(number.abs()));
    a.abs_diff_eq(b, 1e-4 * largest)
}
