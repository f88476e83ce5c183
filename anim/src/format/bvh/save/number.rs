//! Spelling of numbers: with the decimals of the number that is replaced, and at least those that the value needs.

/// Number of significant digits that are kept: five after the first.
const DIGITS: i32 = 5;

/// Largest number of decimals.
const DECIMALS_MAX: usize = 17;

/// Returns `number` as a text that replaces `old`, or is next to it.
pub(in super::super) fn spelled(number: f64, old: &[u8]) -> String {
    let usual = decimals(old).min(DECIMALS_MAX);
    // Numbers below 1 need no more decimals than 1: angles are in degrees, and positions are within a figure.
    let exponent = libm::floor(libm::log10(number.abs().max(1.0))) as i32;
    let needed = usize::try_from(DIGITS - exponent).unwrap_or(0);
    let mut text = format!("{number:.*}", usual.max(needed));
    // Decimals that are added, but not needed, are removed again.
    if needed > usual && text.contains('.') {
        let end = text.find('.').unwrap_or(0) + usual + usize::from(usual > 0);
        while text.len() > end && text.ends_with('0') {
            text.pop();
        }
        if text.ends_with('.') {
            text.pop();
        }
    }
    match text.strip_prefix('-') {
        Some(zero) if zero.bytes().all(|byte| matches!(byte, b'0' | b'.')) => zero.to_owned(),
        _ => text,
    }
}

/// Returns the number of digits after the point.
fn decimals(text: &[u8]) -> usize {
    let after = text.iter().position(|&byte| byte == b'.').map_or(&[][..], |point| &text[point + 1..]);
    after.iter().take_while(|byte| byte.is_ascii_digit()).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_as_many_decimals_as_the_one_that_it_replaces_and_enough() {
        for (number, old, text) in [
            (1.5, "0.0000", "1.5000"),
            (-17.25, "0.123456", "-17.250000"),
            (3.5, "0", "3.5"),
            (12.345_678_9, "0", "12.3457"),
            (12.345_678_9, "1.5", "12.3457"),
            (40.0, "0", "40"),
            (40.0, "1.50", "40.00"),
            (123_456.75, "1", "123457"),
            (-1e-9, "0.00", "0.00"),
            (-1e-9, "-5", "0"),
            (0.1, "1e-5", "0.1"),
            (7.0, ".123456789012345678901234567890", "7.00000000000000000"),
        ] {
            assert_eq!(spelled(number, old.as_bytes()), text, "{number} for {old}");
        }
    }
}
