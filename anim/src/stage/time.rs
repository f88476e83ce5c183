//! Exact times: whole ticks of 1/705,600,000 second.
//!
//! The frames of 12, 15, 24, 25, 30, 48, 50, 60, 90, 100 and 120 per second, those of 24000/1001, 30000/1001 and 60000/1001, the samples of
//! 44.1 and 48 kHz, milliseconds, and decimals of five digits are whole numbers of ticks. So sums and comparisons of times are exact, cannot
//! grow in length as fractions do, and are the same on every system. What is no whole number of ticks (the length of a curve divided by a
//! speed) is rounded once, to the nearest tick. The unit is the flick of Meta's library of that name.

use std::fmt;
use std::ops::{Add, Neg, Sub};

/// Number of ticks in a second.
pub const TICKS_PER_SECOND: i64 = 705_600_000;

/// A thousandth of a second: times are written in whole ones unless their unit is another.
pub(in crate::stage) const MILLISECOND: StageTime = StageTime(TICKS_PER_SECOND / 1000);

/// Longest time that a script may contain, in either direction: 24 hours.
pub const LONGEST: StageTime = StageTime(86_400 * TICKS_PER_SECOND);

/// A time of a script, or a difference of two. Sums saturate far beyond [`LONGEST`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StageTime(i64);

impl StageTime {
    /// The start of the script.
    pub const ZERO: Self = Self(0);

    /// Creates a time from ticks.
    pub const fn from_ticks(ticks: i64) -> Self {
        Self(ticks)
    }

    /// Returns the nearest time to `seconds`; NaN counts as 0, and times beyond ±[`LONGEST`] as that.
    pub fn from_seconds(seconds: f64) -> Self {
        let ticks = (seconds * TICKS_PER_SECOND as f64).round();
        let most = LONGEST.0 as f64;
        Self(if ticks.is_nan() { 0 } else { ticks.clamp(-most, most) as i64 })
    }

    /// Returns the number of ticks.
    pub const fn ticks(self) -> i64 {
        self.0
    }

    /// Returns the time in seconds, rounded to the nearest `f64`.
    pub fn seconds(self) -> f64 {
        self.0 as f64 / TICKS_PER_SECOND as f64
    }

    /// Returns the time multiplied by `factor`, rounded to the nearest tick and limited to ±[`LONGEST`].
    pub fn times(self, factor: Decimal) -> Self {
        Self::divided(i128::from(self.0) * i128::from(factor.digits), Decimal::power(factor.scale))
    }

    /// Returns the time divided by the magnitude of `divisor`, rounded and limited as [`Self::times`]; zero for the divisor 0.
    pub fn over(self, divisor: Decimal) -> Self {
        let by = i128::from(divisor.digits).abs();
        if by == 0 {
            Self::ZERO
        } else {
            Self::divided(i128::from(self.0) * Decimal::power(divisor.scale), by)
        }
    }

    /// Returns `numerator / denominator` ticks, rounded half away from zero; the denominator is positive.
    fn divided(numerator: i128, denominator: i128) -> Self {
        let half = denominator / 2;
        let rounded = if numerator < 0 { numerator - half } else { numerator + half } / denominator;
        Self(rounded.clamp(-i128::from(LONGEST.0), i128::from(LONGEST.0)) as i64)
    }
}

impl Add for StageTime {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}

impl Sub for StageTime {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0))
    }
}

impl Neg for StageTime {
    type Output = Self;

    fn neg(self) -> Self {
        Self(self.0.saturating_neg())
    }
}

/// A number as it is written: `digits / 10^scale`, exact up to nine decimals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Decimal {
    digits: i64,
    scale: u32,
}

impl Decimal {
    /// The number 1.
    pub const ONE: Self = Self { digits: 1, scale: 0 };

    /// Number of digits after the point that are read.
    const MOST_SCALE: u32 = 9;

    /// Reads digits with at most one point and a sign, such as `-1.25`. More than nine decimals are rounded to nine, half away from zero.
    /// Returns `None` for anything else, and where the magnitude is a thousand million or more.
    pub fn parse(text: &str) -> Option<Self> {
        let (sign, unsigned) = match text.strip_prefix('-') {
            Some(rest) => (-1, rest),
            None => (1, text.strip_prefix('+').unwrap_or(text)),
        };
        let (whole, part) = unsigned.split_once('.').unwrap_or((unsigned, ""));
        let is_number = |digits: &str| digits.bytes().all(|digit| digit.is_ascii_digit());
        let has_digits = unsigned.bytes().any(|byte| byte.is_ascii_digit());
        if !(has_digits && is_number(whole) && is_number(part)) {
            return None;
        }
        let (part, rest) = part.split_at_checked(Self::MOST_SCALE as usize).unwrap_or((part, ""));
        let is_rounded_up = rest.bytes().next().is_some_and(|digit| digit >= b'5');
        let whole = whole.trim_start_matches('0');
        if whole.len() > 9 {
            return None;
        }
        let mut digits = format!("0{whole}{part}").parse::<i64>().ok()? + i64::from(is_rounded_up);
        let mut scale = part.len() as u32;
        // One number has one form: what is equal is the same.
        while scale > 0 && digits % 10 == 0 {
            (digits, scale) = (digits / 10, scale - 1);
        }
        Some(Self { digits: sign * digits, scale })
    }

    /// Returns whether the number is 0.
    pub fn is_zero(self) -> bool {
        self.digits == 0
    }

    /// Returns whether the number is below 0.
    pub fn is_negative(self) -> bool {
        self.digits < 0
    }

    /// Returns the nearest `f64`.
    pub fn to_f64(self) -> f64 {
        self.digits as f64 / Self::power(self.scale) as f64
    }

    fn power(scale: u32) -> i128 {
        10_i128.pow(scale)
    }
}

/// Frames per second, as a fraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct StageRate {
    frames: u32,
    seconds: u32,
}

impl Default for StageRate {
    /// Returns 24 frames per second.
    fn default() -> Self {
        Self { frames: 24, seconds: 1 }
    }
}

/// Writes the rate as [`StageRate::parse`] reads it: `24`, `30000/1001`.
impl fmt::Display for StageRate {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.seconds {
            1 => write!(out, "{}", self.frames),
            seconds => write!(out, "{}/{seconds}", self.frames),
        }
    }
}

impl StageRate {
    /// Creates a rate of `frames` in `seconds`; `None` where one of them is 0 or the rate is above 1,000 per second or below 1.
    pub fn new(frames: u32, seconds: u32) -> Option<Self> {
        let fits = seconds > 0 && frames >= seconds && u64::from(frames) <= 1000 * u64::from(seconds);
        fits.then_some(Self { frames, seconds })
    }

    /// Reads a whole number, a decimal of at most three digits, or a fraction such as `30000/1001`.
    pub fn parse(text: &str) -> Option<Self> {
        if let Some((frames, seconds)) = text.split_once('/') {
            return Self::new(frames.parse().ok()?, seconds.parse().ok()?);
        }
        let rate = Decimal::parse(text).filter(|rate| !rate.is_negative() && rate.scale <= 3)?;
        Self::new(u32::try_from(rate.digits).ok()?, u32::try_from(Decimal::power(rate.scale)).ok()?)
    }

    /// Returns the time of frame `frame`, rounded to the nearest tick; frame 0 is at zero.
    pub fn frame(self, frame: i64) -> StageTime {
        self.frames(Decimal { digits: frame, scale: 0 })
    }

    /// Returns the duration of `count` frames, which need not be a whole number.
    pub fn frames(self, count: Decimal) -> StageTime {
        let ticks = i128::from(count.digits) * i128::from(self.seconds) * i128::from(TICKS_PER_SECOND);
        StageTime::divided(ticks, i128::from(self.frames) * Decimal::power(count.scale))
    }

    /// Returns the frame nearest to `time`; half-way between two frames the one that is farther from zero.
    pub fn nearest_frame(self, time: StageTime) -> i64 {
        let (frames, second) = (i128::from(self.frames), i128::from(TICKS_PER_SECOND));
        let by = i128::from(self.seconds) * second;
        let twice = 2 * i128::from(time.0) * frames;
        // Rounded without a fraction; the result is below 1,000 frames for each of the seconds of a time.
        ((twice + by * twice.signum()) / (2 * by)) as i64
    }

    /// Returns the time that a clock of single precision means by `seconds`: within its precision near a frame that frame, exactly, and near
    /// a whole number of milliseconds that number.
    pub fn time_of(self, seconds: f64) -> StageTime {
        let time = StageTime::from_seconds(seconds);
        let frame = self.frame(self.nearest_frame(time));
        let (ticks, thousandth) = (time.ticks(), MILLISECOND.ticks());
        let round = StageTime::from_ticks((ticks + thousandth / 2).div_euclid(thousandth) * thousandth);
        let precision = f64::from(f32::EPSILON) * seconds.abs().max(1.0);
        let is_near = |other: &StageTime| (other.seconds() - seconds).abs() <= precision;
        [frame, round].into_iter().find(is_near).unwrap_or(time)
    }

    /// Returns the rate as a fraction in lowest terms: the number of frames, and the seconds that they take.
    pub fn fraction(self) -> (u32, u32) {
        let (mut divisor, mut rest) = (self.frames, self.seconds);
        while rest > 0 {
            (divisor, rest) = (rest, divisor % rest);
        }
        (self.frames / divisor, self.seconds / divisor)
    }

    /// Returns the frames per second, rounded to the nearest `f64`.
    pub fn per_second(self) -> f64 {
        f64::from(self.frames) / f64::from(self.seconds)
    }
}

/// Reads a time: `1.5`, `1.5s`, `250ms`, `36f` (frames of `rate`), `1:05.5` (minutes and seconds), each with or without a minus.
///
/// Returns `None` for anything else, and beyond ±[`LONGEST`].
pub fn parse_time(text: &str, rate: StageRate) -> Option<StageTime> {
    let second = StageTime(TICKS_PER_SECOND);
    let time = if let Some((minutes, seconds)) = text.split_once(':') {
        let negative = minutes.starts_with('-');
        let minutes: u32 = minutes.trim_start_matches('-').parse().ok().filter(|&minutes| minutes <= 1440)?;
        let digits = seconds.split('.').next().unwrap_or(seconds);
        let seconds = Decimal::parse(seconds).filter(|_| digits.len() == 2 && digits < "60")?;
        let time = StageTime(i64::from(minutes) * 60 * TICKS_PER_SECOND) + second.times(seconds);
        if negative { -time } else { time }
    } else if let Some(number) = text.strip_suffix("ms") {
        MILLISECOND.times(Decimal::parse(number)?)
    } else if let Some(number) = text.strip_suffix('f') {
        rate.frames(Decimal::parse(number)?)
    } else {
        second.times(Decimal::parse(text.strip_suffix('s').unwrap_or(text))?)
    };
    (time < LONGEST && time > -LONGEST).then_some(time)
}
