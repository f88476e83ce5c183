//! Kinds of values of attributes: what is expected, how it is checked, and its pattern in the schema.

use crate::stage::moment::{MomentText, is_moment_name, is_name};
use crate::stage::time::{Decimal, StageRate, StageTime, parse_time};

/// A kind of value.
#[derive(Clone, Copy, Debug)]
pub struct ValueRow {
    /// The expected value, for messages and help, such as "a time such as 1.5, 250ms or 36f".
    pub expected: &'static str,
    /// The regular expression of XML Schema that the schema has for it; empty for any text.
    pub pattern: &'static str,
    /// The possible values; empty where there is no list.
    pub choices: &'static [&'static str],
    /// Returns whether a text is such a value, at the frame rate of the script.
    pub is_valid: fn(&str, StageRate) -> bool,
}

/// Values that are a fixed count of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlainNumbers {
    /// Number of numbers.
    pub count: usize,
    /// The least one of them may be.
    pub least: f64,
    /// The most one of them may be.
    pub most: f64,
}

impl ValueRow {
    const fn new(
        expected: &'static str,
        pattern: &'static str,
        is_valid: fn(&str, StageRate) -> bool,
    ) -> Self {
        Self { expected, pattern, choices: &[], is_valid }
    }

    /// Creates a kind with a list of possible values.
    pub(super) const fn choice(choices: &'static [&'static str]) -> Self {
        Self { expected: "one of the listed words", pattern: "", choices, is_valid: |_, _| true }
    }

    /// Returns whether such a value is a time or a moment, which may be written in frames.
    pub fn has_frames(&self) -> bool {
        [TIME_PATTERN, MOMENT_PATTERN].contains(&self.pattern)
    }

    /// Returns how many numbers such a value is, and between which bounds; `None` for values that are no plain numbers.
    pub fn plain_numbers(&self) -> Option<PlainNumbers> {
        const MOST: f64 = 1e6;
        let rows = [
            (&VECTOR, 3, -MOST, MOST),
            (&TILT, 2, -MOST, MOST),
            (&POINT_2D, 2, 0.0, 1.0),
            (&NUMBER, 1, -MOST, MOST),
            (&POSITIVE, 1, 1e-4, MOST),
            (&AMOUNT, 1, 0.0, MOST),
            (&SHARE, 1, 0.0, 1.0),
        ];
        let (_, count, least, most) = rows.into_iter().find(|(row, ..)| row.expected == self.expected)?;
        Some(PlainNumbers { count, least, most })
    }

    /// Returns whether `text` is such a value.
    pub fn accepts(&self, text: &str, rate: StageRate) -> bool {
        (self.choices.is_empty() || self.choices.contains(&text)) && (self.is_valid)(text, rate)
    }
}

const NAME_PATTERN: &str = "[A-Za-z_][A-Za-z0-9_]*(-[A-Za-z0-9_]+)*";
const POINT_PATTERN: &str = "[A-Za-z_][A-Za-z0-9_]*(-[A-Za-z][A-Za-z0-9_]*)*";
const TIME_PATTERN: &str = "([0-9]+\\.?[0-9]*|\\.[0-9]+)(ms|s|f)?|[0-9]+:[0-9]{2}(\\.[0-9]*)?";
const MOMENT_PATTERN: &str = concat!(
    "-?(([0-9]+\\.?[0-9]*|\\.[0-9]+)(ms|s|f)?|[0-9]+:[0-9]{2}(\\.[0-9]*)?)|",
    "[A-Za-z_][A-Za-z0-9_]*(-[A-Za-z0-9_]+)*\\.[A-Za-z_][A-Za-z0-9_]*(-[A-Za-z][A-Za-z0-9_]*)*",
    "([+\\-](([0-9]+\\.?[0-9]*|\\.[0-9]+)(ms|s|f)?|[0-9]+:[0-9]{2}(\\.[0-9]*)?))?"
);
const NUMBER_PATTERN: &str = "[+\\-]?[0-9]*\\.?[0-9]+|[+\\-]?[0-9]+\\.";
const VECTOR_PATTERN: &str = "\\s*[+\\-]?[0-9.]+(\\s+[+\\-]?[0-9.]+){2}\\s*";

pub(super) const NAME: ValueRow =
    ValueRow::new("a name of letters, digits, `_` and `-`", NAME_PATTERN, |text, _| is_name(text));
pub(super) const MOMENT_NAME: ValueRow =
    ValueRow::new("a name of letters, digits, `_`, and `-` before a letter", POINT_PATTERN, |text, _| {
        is_moment_name(text) && !matches!(text, "begin" | "end")
    });
pub(super) const TEXT: ValueRow = ValueRow::new("a text", "", |_, _| true);
pub(super) const SOURCE: ValueRow =
    ValueRow::new("a relative path with `/`, below the folder of the script", "[^/\\\\].*", |text, _| {
        let parts = || text.split('/');
        !text.is_empty()
            && !text.contains(['\\', ':', '\0'])
            && parts().all(|part| !part.is_empty() && part != "..")
    });
pub(super) const HASH: ValueRow =
    ValueRow::new("the hash of a file, such as 0123456789abcdef", "[0-9a-f]{16}", |text, _| {
        text.len() == 16 && text.bytes().all(|byte| byte.is_ascii_digit() || matches!(byte, b'a'..=b'f'))
    });
pub(super) const WHOLE: ValueRow =
    ValueRow::new("a whole number from 0 to 65535", "[0-9]{1,5}", |text, _| text.parse::<u16>().is_ok());
pub(super) const LENGTH: ValueRow =
    ValueRow::new("a number from 0.1 to 100", "[0-9]*\\.?[0-9]+|[0-9]+\\.", |text, _| {
        Decimal::parse(text).is_some_and(|number| (0.1..=100.0).contains(&number.to_f64()))
    });
pub(super) const TIME: ValueRow =
    ValueRow::new("a time of 0 or more, such as 1.5, 250ms, 36f or 1:05.5", TIME_PATTERN, |text, rate| {
        parse_time(text, rate).is_some_and(|time| time >= StageTime::ZERO)
    });
pub(super) const MOMENT: ValueRow = ValueRow::new(
    "a time such as 1.5 or 36f, or a moment such as walk.end-0.5, prev.begin or grab.touch+6f",
    MOMENT_PATTERN,
    |text, rate| MomentText::parse(text, rate).is_some(),
);
pub(super) const NUMBER: ValueRow =
    ValueRow::new("a number", NUMBER_PATTERN, |text, _| Decimal::parse(text).is_some());
pub(super) const POSITIVE: ValueRow =
    ValueRow::new("a number above 0", "[+]?[0-9]*\\.?[0-9]+|[+]?[0-9]+\\.", |text, _| {
        Decimal::parse(text).is_some_and(|number| !number.is_negative() && !number.is_zero())
    });
pub(super) const AMOUNT: ValueRow =
    ValueRow::new("a number of 0 or more", "[+]?[0-9]*\\.?[0-9]+|[+]?[0-9]+\\.", |text, _| {
        Decimal::parse(text).is_some_and(|number| !number.is_negative())
    });
pub(super) const SPEED: ValueRow =
    ValueRow::new("a number other than 0; below 0 plays backwards", NUMBER_PATTERN, |text, _| {
        Decimal::parse(text).is_some_and(|number| !number.is_zero())
    });
pub(super) const SHARE: ValueRow =
    ValueRow::new("a number from 0 to 1", "0|1|0?\\.[0-9]+|0\\.|1\\.0*", |text, _| {
        Decimal::parse(text).is_some_and(|number| (0.0..=1.0).contains(&number.to_f64()))
    });
pub(super) const REPEAT: ValueRow =
    ValueRow::new("a number above 0, or `fill`", "fill|[0-9]*\\.?[0-9]+|[0-9]+\\.", |text, _| {
        text == "fill"
            || Decimal::parse(text).is_some_and(|number| !number.is_negative() && !number.is_zero())
    });
pub(super) const VECTOR: ValueRow =
    ValueRow::new("three numbers, x y z", VECTOR_PATTERN, |text, _| vector(text).is_some());
pub(super) const POINT_2D: ValueRow =
    ValueRow::new("two numbers, x y, each from 0 to 1", "\\s*[0-9.]+\\s+[0-9.]+\\s*", |text, _| {
        numbers(text).is_some_and(|all| all.len() == 2 && all.iter().all(|part| (0.0..=1.0).contains(part)))
    });
pub(super) const TILT: ValueRow = ValueRow::new(
    "two numbers of degrees, pitch and roll",
    "\\s*[+\\-]?[0-9.]+\\s+[+\\-]?[0-9.]+\\s*",
    |text, _| numbers(text).is_some_and(|all| all.len() == 2),
);
pub(super) const POINTS: ValueRow = ValueRow::new(
    "two or more points of three numbers each, such as 0 0 0  1 0 0",
    "\\s*[+\\-]?[0-9.]+(\\s+[+\\-]?[0-9.]+)+\\s*",
    |text, _| points(text).is_some_and(|points| points.len() >= 2),
);
pub(super) const SPOT: ValueRow =
    ValueRow::new("a name such as anna, a bone such as anna.Head, or a point x y z", "", |text, _| {
        vector(text).is_some() || is_name(text.split_once('.').map_or(text, |(name, _)| name))
    });
pub(super) const DIRECTION: ValueRow =
    ValueRow::new("a name, a point x y z, or degrees", "", |text, rate| {
        Decimal::parse(text).is_some() || (SPOT.is_valid)(text, rate)
    });
pub(super) const COLOR: ValueRow = ValueRow::new("a color such as #ffcc00", "#[0-9A-Fa-f]{6}", |text, _| {
    text.strip_prefix('#')
        .is_some_and(|hex| hex.len() == 6 && hex.bytes().all(|byte| byte.is_ascii_hexdigit()))
});
pub(super) const LENS: ValueRow = ValueRow::new(
    "a focal length in millimeters such as 35mm, from 1 to 5000",
    "[0-9]*\\.?[0-9]+(mm)?",
    |text, _| {
        let number = Decimal::parse(text.strip_suffix("mm").unwrap_or(text));
        number.is_some_and(|number| (1.0..=5000.0).contains(&number.to_f64()))
    },
);
pub(super) const FOCUS: ValueRow = ValueRow::new(
    "a distance in meters, a name, a bone such as anna.Head, or a point x y z",
    "",
    |text, rate| {
        Decimal::parse(text).is_some_and(|number| !number.is_negative()) || (SPOT.is_valid)(text, rate)
    },
);
pub(super) const HEADING: ValueRow =
    ValueRow::new("`along`, `keep`, or degrees", "along|keep|[+\\-]?[0-9]*\\.?[0-9]+", |text, _| {
        matches!(text, "along" | "keep") || Decimal::parse(text).is_some()
    });
pub(super) const NAMES: ValueRow = ValueRow::new("names with commas between them", "", |text, _| {
    text.split(',').all(|name| !name.trim().is_empty())
});
pub(super) const SIZE: ValueRow =
    ValueRow::new("a width and a height such as 1280x720, up to 16384", "[0-9]+x[0-9]+", |text, _| {
        size(text).is_some()
    });
pub(super) const RATE: ValueRow = ValueRow::new(
    "frames per second such as 24, 23.976 or 30000/1001, from 1 to 1000",
    "[0-9]+(\\.[0-9]{1,3})?|[0-9]+/[0-9]+",
    |text, _| StageRate::parse(text).is_some(),
);
pub(super) const SEED: ValueRow =
    ValueRow::new("a whole number from 0 to 4294967295", "[0-9]+", |text, _| text.parse::<u32>().is_ok());
pub(super) const VERSION: ValueRow = ValueRow::choice(&["1"]);
pub(super) const YES_NO: ValueRow = ValueRow::choice(&["yes", "no"]);
pub(super) const EASE: ValueRow = ValueRow::choice(&["linear", "in", "out", "in-out"]);
pub(super) const FILL: ValueRow = ValueRow::choice(&["hold", "release"]);
/// A value whose kind depends on the property that it is for; checked where the property is known.
pub(super) const PROPERTY_VALUE: ValueRow =
    ValueRow::new("a number or a color such as #ffcc00", "", |text, rate| {
        Decimal::parse(text).is_some() || (COLOR.is_valid)(text, rate)
    });

/// Reads numbers with blanks between them.
pub(in crate::stage) fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split_ascii_whitespace().map(|number| Decimal::parse(number).map(Decimal::to_f64)).collect()
}

/// Reads three numbers.
pub fn vector(text: &str) -> Option<glam::DVec3> {
    let numbers: [f64; 3] = numbers(text)?.try_into().ok()?;
    Some(numbers.into())
}

/// Reads points of three numbers each.
pub(in crate::stage) fn points(text: &str) -> Option<Vec<glam::DVec3>> {
    let numbers = numbers(text)?;
    let (points, rest) = numbers.as_chunks::<3>();
    rest.is_empty().then(|| points.iter().map(|&point| point.into()).collect())
}

/// Reads a width and a height in pixels.
pub(in crate::stage) fn size(text: &str) -> Option<[u32; 2]> {
    let (width, height) = text.split_once('x')?;
    let side = |text: &str| text.parse::<u32>().ok().filter(|side| (1..=16_384).contains(side));
    Some([side(width)?, side(height)?])
}
