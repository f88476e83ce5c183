//! Whole numbers of a JSON text, however they are written: `1`, `1.0` and `10e-1` are the same number.

/// Smallest number from which on a double does not represent every whole number.
const EXACT: f64 = (1_u64 << 53) as f64;

/// Returns the value of a JSON number if it is whole and not negative.
pub(super) fn whole(token: &str) -> Option<u64> {
    if let Ok(number) = token.parse() {
        return Some(number);
    }
    let number: f64 = token.parse().ok()?;
    ((0.0..EXACT).contains(&number) && number.fract() == 0.0).then_some(number as u64)
}

#[cfg(test)]
mod tests {
    use super::whole;

    #[test]
    fn a_whole_number_may_be_written_with_a_fraction_or_an_exponent() {
        let whole = |tokens: &[&str]| tokens.iter().map(|token| whole(token)).collect::<Vec<_>>();
        assert_eq!(whole(&["1", "1.0", "10e-1", "0.1E1", "-0.0", "1e3"]), [1, 1, 1, 1, 0, 1_000].map(Some));
        assert_eq!(whole(&["1.5", "-1", "-1.0", "1e300", "9007199254740992.0", "1e-1"]), [None; 6]);
        assert_eq!(whole(&["18446744073709551615"]), [Some(u64::MAX)]);
    }
}
