//! One take by itself: where it is.

use super::cycle::usable_span;
use crate::data::Take;

/// Where a take is that plays at its own speed, over and over or once.
///
/// ```text
/// time = start + passed mod length        repeating
/// time = start + min(passed, length)      once: at its end it stands still
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    /// Seconds, finite.
    start: f32,
    /// Seconds, finite, 0 or more.
    length: f32,
    repeats: bool,
    /// Seconds after `start`: 0..=length.
    passed: f64,
}

impl Playback {
    /// The whole of a take, over and over, from its start.
    pub fn repeating(take: &Take) -> Self {
        Self::new(take.start, take.length, true)
    }

    /// The whole of a take, once, from its start.
    pub fn once(take: &Take) -> Self {
        Self::new(take.start, take.length, false)
    }

    /// `length` seconds from `start`, at the start.
    ///
    /// A start that is not finite counts as 0; a length that is not finite or negative as 0, which is a pose that stands.
    pub fn new(start: f32, length: f32, repeats: bool) -> Self {
        let (start, length) = usable_span(start, length);
        Self { start, length, repeats, passed: 0.0 }
    }

    /// The same at `time` seconds (as keys of the take are): brought into the take as [`Self::advance`] would, except that
    /// before the start of a take that plays once is its start. Not finite: the start.
    pub fn starting_at(mut self, time: f32) -> Self {
        let passed = f64::from(time) - f64::from(self.start);
        self.passed = if passed.is_finite() { self.inside(passed) } else { 0.0 };
        self
    }

    /// Lets `dt` seconds pass; then as [`Self::time`]. Negative and NaN count as 0, infinite as the largest `f32`.
    pub fn advance(&mut self, dt: f32) -> f32 {
        self.passed = self.inside(self.passed + f64::from(super::weight_or_zero(dt)));
        self.time()
    }

    /// Seconds inside the take: `start ..= start + length`.
    pub fn time(&self) -> f32 {
        let time = (f64::from(self.start) + self.passed) as f32;
        time.clamp(self.start, (self.start + self.length).min(f32::MAX))
    }

    /// Seconds until the end, of a take that repeats until its next start.
    pub fn left(&self) -> f32 {
        (f64::from(self.length) - self.passed) as f32
    }

    /// Seconds from start to end.
    pub fn length(&self) -> f32 {
        self.length
    }

    /// Is it at its end for good? Never, where it repeats.
    pub fn has_ended(&self) -> bool {
        !self.repeats && self.passed >= f64::from(self.length)
    }

    /// The same, once.
    pub(super) fn to_play_once(self) -> Self {
        Self { repeats: false, ..self }
    }

    /// Seconds after the start: 0..=length.
    pub(super) fn passed(&self) -> f64 {
        self.passed
    }

    fn inside(&self, passed: f64) -> f64 {
        let length = f64::from(self.length);
        if !self.repeats {
            return passed.clamp(0.0, length);
        }
        let inside = passed.rem_euclid(length);
        // NaN without a length; the length itself, by rounding, a hair before the start.
        if inside < length { inside } else { 0.0 }
    }
}
