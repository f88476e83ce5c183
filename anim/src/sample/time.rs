//! From the time of a running clock to a time inside a take.

use crate::data::Take;

/// Behavior when the clock is outside a take.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum PlayMode {
    /// The first or last pose is kept.
    Clamp,
    /// The take is repeated.
    #[default]
    Loop,
}

impl PlayMode {
    /// Returns the time inside `take` that belongs to `time` seconds of a clock.
    pub fn map(self, take: &Take, time: f32) -> f32 {
        match self {
            Self::Clamp => clamp_time(time, take.start, take.length),
            Self::Loop => loop_time(time, take.start, take.length),
        }
    }
}

/// Clamps `time` seconds to `start ..= start + length`; NaN gives `start`.
///
/// A length that is negative or not finite counts as zero, a start that is not finite as 0, and an end that exceeds the
/// range of f32 is the largest f32.
#[allow(clippy::neg_cmp_op_on_partial_ord, reason = "the negation is how NaN is caught")]
pub fn clamp_time(time: f32, start: f32, length: f32) -> f32 {
    let (start, length) = checked(start, length);
    let end = (start + length).min(f32::MAX);
    if !(time > start) {
        start
    } else if time < end {
        time
    } else {
        end
    }
}

/// Wraps `time` seconds into `start ..= start + length`; a time past the end continues at the start, one before the
/// start at the end.
///
/// Inside the take, both ends included, the time is returned unchanged. A take without length, NaN and infinite times
/// give `start`; otherwise as [`clamp_time`].
pub fn loop_time(time: f32, start: f32, length: f32) -> f32 {
    let (start, length) = checked(start, length);
    let inside = time - start;
    if (0.0..=length).contains(&inside) {
        return time;
    }
    let wrapped = inside.rem_euclid(length);
    clamp_time(if wrapped.is_finite() { start + wrapped } else { start }, start, length)
}

/// Returns both finite, the length not negative.
fn checked(start: f32, length: f32) -> (f32, f32) {
    let start = if start.is_finite() { start } else { 0.0 };
    let length = if length.is_finite() && length > 0.0 { length } else { 0.0 };
    (start, length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamped_time_stays_inside() {
        assert_eq!(clamp_time(0.5, 1.0, 2.0), 1.0);
        assert_eq!(clamp_time(1.5, 1.0, 2.0), 1.5);
        assert_eq!(clamp_time(9.0, 1.0, 2.0), 3.0);
        assert_eq!(clamp_time(f32::NAN, 1.0, 2.0), 1.0);
        assert_eq!(clamp_time(f32::INFINITY, 1.0, 2.0), 3.0);
        assert_eq!(clamp_time(5.0, 1.0, f32::NAN), 1.0);
        assert_eq!(clamp_time(5.0, 1.0, -1.0), 1.0);
    }

    #[test]
    fn looped_time_begins_anew_after_the_end() {
        assert_eq!(loop_time(1.5, 1.0, 2.0), 1.5);
        assert_eq!(loop_time(3.0, 1.0, 2.0), 3.0, "the last pose belongs to the take");
        assert_eq!(loop_time(3.5, 1.0, 2.0), 1.5);
        assert_eq!(loop_time(7.5, 1.0, 2.0), 1.5);
        assert_eq!(loop_time(0.5, 1.0, 2.0), 2.5);
    }

    #[test]
    fn a_take_without_length_stays_at_its_start() {
        for time in [0.0, 2.0, -3.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(loop_time(time, 2.0, 0.0), 2.0, "{time}");
        }
        assert_eq!(loop_time(f32::INFINITY, 1.0, 2.0), 1.0);
        assert_eq!(loop_time(f32::NAN, 1.0, 2.0), 1.0);
        assert_eq!(loop_time(f32::NAN, f32::NAN, 2.0), 0.0);
        let hostile = [f32::NAN, f32::INFINITY, f32::MAX, f32::MIN, 1e-45, -0.0, 1.0];
        for time in hostile {
            for start in hostile {
                for length in hostile {
                    assert!(loop_time(time, start, length).is_finite(), "{time} {start} {length}");
                    assert!(clamp_time(time, start, length).is_finite(), "{time} {start} {length}");
                }
            }
        }
    }
}
