//! Numbers in texts.
//!
//! Nearly all numbers of a file are decimals of few digits. They are read eight digits at a time: in a word of eight
//! characters the ones that are not digits are found at once, and three multiplications make a number of those before.
//! All others are read by the standard library.

/// Powers of ten that double precision represents exactly.
const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Powers of ten by the number of digits that are read at once.
const SHIFTS: [u64; 9] = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];

/// Returns the number that a text represents, rounded correctly; infinite or NaN for such a text and for one that is too
/// large, `None` where it is no number.
#[inline]
pub(super) fn parse_number(text: &[u8]) -> Option<f64> {
    match short_decimal(text) {
        Some((number, length)) if length == text.len() => Some(number),
        Some(_) | None => parse_slowly(text),
    }
}

#[cold]
fn parse_slowly(text: &[u8]) -> Option<f64> {
    std::str::from_utf8(text).ok()?.parse().ok()
}

/// Returns the number at the start of a text, rounded correctly, and its length in bytes; `None` where there is none,
/// and for one with too many digits. What follows may belong to it too: an exponent.
#[inline]
pub(super) fn short_decimal(text: &[u8]) -> Option<(f64, usize)> {
    let is_negative = text.first() == Some(&b'-');
    let start = usize::from(is_negative || text.first() == Some(&b'+'));
    let (whole, mut end) = digits(text, start, 0)?;
    let (mut mantissa, mut count, mut decimals) = (whole, end - start, 0);
    if text.get(end) == Some(&b'.') {
        let point = end;
        (mantissa, end) = digits(text, point + 1, whole)?;
        decimals = end - point - 1;
        count += decimals;
    }
    // Both operands and so the quotient are exact up to one rounding.
    if count == 0 || mantissa > 1 << 53 {
        return None;
    }
    let number = mantissa as i64 as f64 / POWERS_OF_TEN.get(decimals)?;
    Some((if is_negative { -number } else { number }, end))
}

/// Appends the digits from `at` on to those of `before`. Returns the number and the end of the digits; `None` where the
/// number is too large.
#[inline]
fn digits(text: &[u8], mut at: usize, before: u64) -> Option<(u64, usize)> {
    let mut number = before;
    loop {
        let (value, count) = eight_digits(text, at);
        at += count;
        if count == 0 {
            return Some((number, at));
        }
        number = number.checked_mul(SHIFTS[count % SHIFTS.len()])?.checked_add(value)?;
        if count < 8 {
            return Some((number, at));
        }
    }
}

/// Returns the value of the digits from `at` on, at most eight, and their number.
#[inline]
pub(super) fn eight_digits(text: &[u8], at: usize) -> (u64, usize) {
    match text.get(at..).and_then(|rest| rest.first_chunk::<8>()) {
        Some(word) => digits_of(u64::from_le_bytes(*word)),
        None => last_digits(text.get(at..).unwrap_or_default()),
    }
}

/// Returns the value of the digits at the start of eight characters, of which the first is in the lowest byte, and their
/// number.
#[inline]
fn digits_of(word: u64) -> (u64, usize) {
    let values = word ^ 0x3030_3030_3030_3030;
    // The highest bit of a byte is set if its value is more than 9. A carry only reaches bytes after such a one.
    let others = (values.wrapping_add(0x7676_7676_7676_7676) | values) & 0x8080_8080_8080_8080;
    let count = others.trailing_zeros() as usize / 8;
    if count == 0 {
        return (0, 0);
    }
    // Zeros before the digits instead of others after them; then pairs of digits, fours, and all eight.
    let values = values << (64 - 8 * count);
    let pairs = values.wrapping_mul(10).wrapping_add(values >> 8);
    let first = (pairs & 0x0000_00ff_0000_00ff).wrapping_mul(100 + (1_000_000 << 32));
    let second = (pairs >> 16 & 0x0000_00ff_0000_00ff).wrapping_mul(1 + (10_000 << 32));
    (first.wrapping_add(second) >> 32, count)
}

/// As [`digits_of`], for fewer than eight characters at the end of a text.
#[cold]
fn last_digits(text: &[u8]) -> (u64, usize) {
    let digits = text.iter().take_while(|byte| byte.is_ascii_digit());
    digits.fold((0, 0), |(value, count), byte| (value * 10 + u64::from(byte - b'0'), count + 1))
}

/// Returns the number that a text represents in single precision, rounded correctly; `number` is the same in double
/// precision.
#[inline]
pub(super) fn single(number: f64, text: &[u8]) -> f32 {
    // A number that is exactly between two singles may have been rounded to be there.
    const BELOW: u64 = (1 << 29) - 1;
    let is_between = number.to_bits() & BELOW == 1 << 28;
    let is_tiny = number != 0.0 && number.abs() < f64::from(f32::MIN_POSITIVE);
    if is_between || is_tiny { single_slowly(number, text) } else { number as f32 }
}

#[cold]
fn single_slowly(number: f64, text: &[u8]) -> f32 {
    std::str::from_utf8(text).ok().and_then(|text| text.parse().ok()).unwrap_or(number as f32)
}

/// Returns the whole number that a text represents; `None` where it is none, or does not fit.
pub(super) fn parse_whole(text: &[u8]) -> Option<u64> {
    let digits = text.strip_prefix(b"+").unwrap_or(text);
    if digits.is_empty() {
        return None;
    }
    digits.iter().try_fold(0_u64, |number, byte| {
        let digit = byte.is_ascii_digit().then(|| u64::from(byte - b'0'))?;
        number.checked_mul(10)?.checked_add(digit)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::random::{Random, seed};

    #[test]
    fn numbers_are_rounded_as_the_standard_library_rounds_them() {
        let texts = [
            "0",
            "-0",
            "1",
            "-1.5",
            ".5",
            "5.",
            "+3",
            "0.1",
            "-43.1892",
            "1e5",
            "1E-7",
            "-5.551115E-17",
            "123456789012345678",
            "9007199254740993",
            "0.000000000000000000000001",
            "3.4028235e38",
            "00012.50",
            "18446744073709551616",
            "1e400",
            "0.30000000000000004",
            "7.0000000000000000000000000000001",
            "nan",
            "-inf",
        ];
        for text in texts {
            let number = parse_number(text.as_bytes()).unwrap();
            assert_eq!(number.to_bits(), text.parse::<f64>().unwrap().to_bits(), "{text}");
        }
        for text in ["", "-", ".", "1,5", "1.2.3", "0x10", "1e", "--1", "1f", "\u{661}"] {
            assert_eq!(parse_number(text.as_bytes()), None, "{text}");
        }
        assert_eq!(parse_whole(b"+42"), Some(42));
        for text in ["", "-1", "1.0", "18446744073709551616", "x"] {
            assert_eq!(parse_whole(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn decimals_of_any_length_and_what_follows_them_are_read_as_by_the_standard_library() {
        let mut random = Random::new(seed(29));
        let mut below = |end| random.below(end);
        for _ in 0..100_000 {
            let sign = ["", "-", "+"][below(3)];
            let (whole, decimals) = (below(14), below(14));
            let mut text: String = (0..whole).map(|_| char::from(b'0' + below(10) as u8)).collect();
            if below(4) > 0 {
                text.push('.');
                text.extend((0..decimals).map(|_| char::from(b'0' + below(10) as u8)));
            }
            let text = format!("{sign}{text}");
            let expected: Option<f64> = text.parse().ok();
            let bits = |number: Option<f64>| number.map(f64::to_bits);
            assert_eq!(bits(parse_number(text.as_bytes())), bits(expected), "{text}");
            let after = ["", " ", ";", "e5", "/", ":", "\u{e9}", " 1234567890", ".5"][below(9)];
            if let (Some((number, length)), Some(expected)) =
                (short_decimal(format!("{text}{after}").as_bytes()), expected)
            {
                let is_longer = after == ".5" && !text.contains('.');
                assert!(is_longer || (number, length) == (expected, text.len()), "{text}{after}");
            }
            if let Some(number) = expected {
                let expected: f32 = text.parse().unwrap();
                assert_eq!(single(number, text.as_bytes()).to_bits(), expected.to_bits(), "{text}");
            }
        }
    }

    #[test]
    fn single_precision_is_not_rounded_twice() {
        // Next to the middle between two singles, where double precision has nothing but the middle.
        for text in [
            "1.00000017881393432617187499",
            "1.00000017881393432617187501",
            "7.0064923216240853e-46",
            "1e-50",
        ] {
            let number = parse_number(text.as_bytes()).unwrap();
            assert_eq!(
                single(number, text.as_bytes()).to_bits(),
                text.parse::<f32>().unwrap().to_bits(),
                "{text}"
            );
        }
    }
}
