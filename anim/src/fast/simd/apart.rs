//! Items of a slice at equal distances.

/// Returns `N` items of `of`, from `at` on and `stride` apart; `None` if they are not all within the slice, or would be
/// the same.
#[inline(always)]
pub(super) fn apart<T, const N: usize>(of: &mut [T], at: usize, stride: usize) -> Option<[&mut T; N]> {
    let last = stride.checked_mul(N.saturating_sub(1))?.checked_add(at)?;
    if stride == 0 || last >= of.len() {
        return None;
    }
    let first = of.as_mut_ptr();
    // SAFETY: the largest index is within the slice, which is borrowed for as long as the references; and the indices
    // differ, as the stride is not 0 and the largest of them did not overflow.
    Some(std::array::from_fn(|item| unsafe { &mut *first.add(at + item * stride) }))
}

#[cfg(test)]
mod tests {
    use super::apart;

    #[test]
    fn items_are_given_only_if_all_are_within_and_differ() {
        let mut numbers = [0, 1, 2, 3, 4, 5, 6];
        assert_eq!(apart(&mut numbers, 0, 3), Some([&mut 0, &mut 3, &mut 6]));
        assert_eq!(apart(&mut numbers, 1, 2), Some([&mut 1, &mut 3, &mut 5]));
        assert_eq!(apart::<_, 3>(&mut numbers, 1, 3), None);
        assert_eq!(apart::<_, 2>(&mut numbers, 1, 0), None);
        assert_eq!(apart::<_, 3>(&mut numbers, 1, usize::MAX), None);
        assert_eq!(apart::<_, 2>(&mut numbers, usize::MAX, 1), None);
    }
}
