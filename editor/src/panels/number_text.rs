//! Formats numbers: short for reading, and exact for editing in a field.

/// Number of digits after the decimal point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Digits {
    /// Enough decimals for about seven characters: small numbers keep their decimals, large ones lose them.
    Fitting,
    /// Always this number of decimals, so that a column of numbers stays aligned.
    Fixed(usize),
}

impl Digits {
    /// Returns the number as it is shown; a number smaller than `grain`, the rounding error, is shown as 0.
    pub fn text_from(self, grain: f64, value: f64) -> String {
        self.text(if value.abs() < grain { 0.0 } else { value })
    }

    /// Returns the number as it is shown.
    pub fn text(self, value: f64) -> String {
        let size = value.abs();
        tidy(match self {
            _ if !value.is_finite() => "–".to_owned(),
            _ if size >= 1e5 || (self == Self::Fitting && size > 0.0 && size < 1e-4) => {
                format!("{value:.1e}")
            }
            Self::Fixed(digits) => format!("{value:.digits$}"),
            Self::Fitting if size >= 1000.0 => format!("{value:.0}"),
            Self::Fitting if size >= 100.0 => format!("{value:.1}"),
            Self::Fitting if size >= 10.0 => format!("{value:.2}"),
            Self::Fitting if size > 0.0 && size < 0.01 => format!("{value:.5}"),
            Self::Fitting => format!("{value:.3}"),
        })
    }
}

/// Returns the shortest decimal number that differs from `value` by at most `grain`, the rounding error.
pub fn exact(value: f64, grain: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    let large = value.abs() >= 1e15;
    let near = |text: &String| text.parse::<f64>().is_ok_and(|read| (read - value).abs() <= grain);
    let shortest = (0..=12).map(|digits| format!("{value:.digits$}")).find(near).filter(|_| !large);
    plus_zero(shortest.unwrap_or_else(|| format!("{value:e}")))
}

/// Removes the minus from a negative zero, and writes any other minus as a minus sign instead of a hyphen.
pub(super) fn tidy(text: String) -> String {
    plus_zero(text).replacen('-', "\u{2212}", 1)
}

fn plus_zero(text: String) -> String {
    let nothing = text.chars().all(|letter| matches!(letter, '-' | '0' | '.'));
    if nothing { text.replacen('-', "", 1) } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_errors_are_not_shown() {
        assert_eq!(exact(29.999_999_6, 1e-5), "30");
        assert_eq!(exact(-0.000_000_1, 1e-6), "0");
        assert_eq!(exact(0.1_f32.into(), 1e-7), "0.1");
        assert_eq!(exact(1e-9, 0.0), "0.000000001");
        assert_eq!(exact(1e-20, 0.0), "1e-20");
        assert_eq!(exact(f64::NAN, 0.0), "");
        assert_eq!(exact(f64::from(f32::MAX), 0.0).parse::<f64>(), Ok(f64::from(f32::MAX)));
    }

    #[test]
    fn a_shown_number_has_at_most_nine_characters() {
        for value in
            [0.0, -0.0, 1e-7, 0.5, -12.345_678, 123.456, 1234.5, 98_765.4, -1e9, 3.4e38, f64::INFINITY]
        {
            for digits in [Digits::Fitting, Digits::Fixed(2)] {
                assert!(digits.text(value).chars().count() <= 9, "{value}: {}", digits.text(value));
            }
        }
        assert_eq!(Digits::Fixed(2).text(-0.001), "0.00");
        assert_eq!(Digits::Fitting.text_from(1e-6, -2e-31), "0.000");
        assert_eq!(Digits::Fitting.text_from(1e-9, 2e-6), "2.0e-6".replace('-', "\u{2212}"));
        assert_eq!(Digits::Fixed(1).text(-30.0), "\u{2212}30.0");
    }
}
