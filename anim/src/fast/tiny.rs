//! Flushing of insignificant numbers to zero, once, when the data of the fast path is built.
//!
//! Real files contain them: inverse bind matrices with 1e-39 where a zero was meant, translations that went through
//! half floats. Processors compute with numbers below 1.2e-38 many times slower, and products of much larger numbers
//! fall there.

/// Relative threshold below which a number is flushed to zero; far below the precision of `f32`.
const RELATIVE_THRESHOLD: f32 = 1e-12;

/// Returns the largest magnitude of `values`; 0 without any.
pub(super) fn largest(values: impl IntoIterator<Item = f32>) -> f32 {
    values.into_iter().map(f32::abs).fold(0.0, f32::max)
}

/// Returns `value`; zero where it is insignificant relative to `largest`, or subnormal.
pub(super) fn flushed(value: f32, largest: f32) -> f32 {
    if value.abs() < largest * RELATIVE_THRESHOLD || value.is_subnormal() { 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_insignificant_numbers_are_flushed_to_zero() {
        assert_eq!(flushed(1e-13, 1.0), 0.0);
        assert_eq!(flushed(-1e-11, 1.0), -1e-11);
        assert_eq!(flushed(1e-30, 1e-29), 1e-30, "a tiny model is not lost");
        assert_eq!(flushed(1e-40, 1e-39), 0.0);
        assert_eq!(largest([1.0, -3.0, 2.0]), 3.0);
    }
}
