//! Playback of a single take.

use super::cycle::usable_span;
use crate::data::Take;

/// The playback time of a take that plays at its own speed, repeatedly or once.
///
/// ```text
/// time = start + passed mod length        repeating
/// time = start + min(passed, length)      once: stops at the end
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
    /// Plays a complete take repeatedly, from its start.
    pub fn repeating(take: &Take) -> Self {
        Self::new(take.start, take.length, true)
    }

    /// Plays a complete take once, from its start.
    pub fn once(take: &Take) -> Self {
        Self::new(take.start, take.length, false)
    }

    /// Plays `length` seconds from `start`, beginning at the start.
    ///
    /// A start that is not finite counts as 0; a length that is not finite or negative as 0, which is a still pose.
    pub fn new(start: f32, length: f32, repeats: bool) -> Self {
        let (start, length) = usable_span(start, length);
        Self { start, length, repeats, passed: 0.0 }
    }

    /// Returns the playback at `time` seconds (in the time of the take's keys), wrapped or clamped into the take as
    /// [`Self::advance`] does; a time before the start of a take that plays once is clamped to the start. A time that
    /// is not finite counts as the start.
    pub fn starting_at(mut self, time: f32) -> Self {
        let passed = f64::from(time) - f64::from(self.start);
        self.passed = if passed.is_finite() { self.inside(passed) } else { 0.0 };
        self
    }

    /// Advances by `dt` seconds and returns [`Self::time`]. Negative and NaN count as 0, infinite as the largest `f32`.
    pub fn advance(&mut self, dt: f32) -> f32 {
        self.passed = self.inside(self.passed + f64::from(super::weight_or_zero(dt)));
        self.time()
    }

    /// Returns the time inside the take in seconds: `start ..= start + length`.
    pub fn time(&self) -> f32 {
        let time = (f64::from(self.start) + self.passed) as f32;
        time.clamp(self.start, (self.start + self.length).min(f32::MAX))
    }

    /// Returns the seconds until the end; for a take that repeats, until its next start.
    pub fn left(&self) -> f32 {
        (f64::from(self.length) - self.passed) as f32
    }

    /// Returns the seconds from start to end.
    pub fn length(&self) -> f32 {
        self.length
    }

    /// Returns whether the take has ended; never true for a take that repeats.
    pub fn has_ended(&self) -> bool {
        !self.repeats && self.passed >= f64::from(self.length)
    }

    /// Returns the same playback, to play once.
    pub(super) fn to_play_once(self) -> Self {
        Self { repeats: false, ..self }
    }

    /// Returns the seconds after the start: 0..=length.
    pub(super) fn passed(&self) -> f64 {
        self.passed
    }

    fn inside(&self, passed: f64) -> f64 {
        let length = f64::from(self.length);
        if !self.repeats {
            return passed.clamp(0.0, length);
        }
        let inside = passed.rem_euclid(length);
        // `inside` is NaN if the length is 0. For times just before the start, rounding can make it equal to the
        // length.
        if inside < length { inside } else { 0.0 }
    }
}
