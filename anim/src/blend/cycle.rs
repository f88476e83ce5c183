//! Repeating takes and their phases.

use crate::data::Take;

/// A take that repeats: its start, its length, and its marked times.
///
/// The *phase* is the fraction of a cycle that has passed, 0..1. With marks (times that correspond, such as the foot
/// touching the ground) it counts from mark to mark, so equal phases are corresponding moments:
///
/// ```text
/// phase = (k + f) / n      n marks; mark k was the last one, f is the fraction of the way to mark k + 1
/// ```
///
/// Without marks the start of the cycle is the only one, and the phase is `(time - start) / length`.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycle {
    /// Seconds, finite.
    start: f32,
    /// Seconds, finite, 0 or more.
    length: f32,
    /// Seconds after `start`, ascending, in `0..length`; never empty.
    marks: Vec<f32>,
}

impl Cycle {
    /// Creates a cycle of `length` seconds from `start`, without marks.
    ///
    /// A start that is not finite counts as 0; a length that is not finite or negative as 0, which is a still pose.
    pub fn new(start: f32, length: f32) -> Self {
        let (start, length) = usable_span(start, length);
        Self { start, length, marks: vec![0.0] }
    }

    /// Creates a cycle of a complete take.
    pub fn of(take: &Take) -> Self {
        Self::new(take.start, take.length)
    }

    /// Returns the cycle with marks at `times` (seconds, in the time of the take's keys).
    ///
    /// The marks are sorted. Marks outside the cycle are left out, and so is a second mark at the same time; a mark at
    /// the end is the same as a mark at the start. If no mark is left, the start is the only mark.
    pub fn with_marks(mut self, times: impl IntoIterator<Item = f32>) -> Self {
        let length = self.length;
        let inside = times.into_iter().map(|time| time - self.start);
        let inside = inside.filter(|mark| (0.0..=length).contains(mark));
        self.marks = inside.map(|mark| if mark < length { mark + 0.0 } else { 0.0 }).collect();
        self.marks.sort_by(f32::total_cmp);
        self.marks.dedup();
        if self.marks.is_empty() {
            self.marks.push(0.0);
        }
        self
    }

    /// Returns the cycle without marks.
    pub fn without_marks(mut self) -> Self {
        self.marks.clear();
        self.marks.push(0.0);
        self
    }

    /// Returns the length of one cycle in seconds.
    pub fn length(&self) -> f32 {
        self.length
    }

    /// Returns the number of marks; 1 for a cycle without marks, whose only mark is its start.
    pub fn marks(&self) -> usize {
        self.marks.len()
    }

    /// Returns the time inside the take that belongs to a phase: `start ..= start + length`.
    ///
    /// A phase outside 0..1 wraps around; one that is not finite counts as 0.
    pub fn time_at(&self, phase: f64) -> f32 {
        let (mark, fraction) = self.split(phase);
        let inside = f64::from(self.marks[mark]) + fraction * self.seconds_after(mark);
        let length = f64::from(self.length);
        let inside = if inside > length { inside - length } else { inside };
        // The sum is rounded once, from f64, and clamped after that.
        let time = (f64::from(self.start) + inside) as f32;
        time.clamp(self.start, (self.start + self.length).min(f32::MAX))
    }

    /// Returns the phase at a time of the take: 0 or more, less than 1.
    ///
    /// Times outside the cycle wrap around; one that is not finite counts as the start, and a cycle without length
    /// always has phase 0.
    pub fn phase_at(&self, time: f32) -> f64 {
        let length = f64::from(self.length);
        let inside = (f64::from(time) - f64::from(self.start)).rem_euclid(length);
        if !inside.is_finite() {
            return 0.0;
        }
        // A time before the first mark comes after the last mark of the previous cycle.
        let passed = self.marks.partition_point(|&mark| f64::from(mark) <= inside);
        let (mark, since) = match passed.checked_sub(1) {
            Some(mark) => (mark, inside - f64::from(self.marks[mark])),
            None => {
                let last = self.marks.len() - 1;
                (last, inside + length - f64::from(self.marks[last]))
            }
        };
        let fraction = since / self.seconds_after(mark);
        let fraction = if fraction.is_finite() { fraction } else { 0.0 };
        wrapped((mark as f64 + fraction) / self.marks.len() as f64)
    }

    /// Returns the seconds from mark number `mark` to the next mark; the last mark is followed by the first mark of the
    /// next cycle.
    pub(super) fn seconds_after(&self, mark: usize) -> f64 {
        let at = |mark: usize| self.marks.get(mark).copied().map(f64::from);
        let here = at(mark).unwrap_or(0.0);
        at(mark + 1).unwrap_or(f64::from(self.marks[0]) + f64::from(self.length)) - here
    }

    /// Returns the mark before a phase, and the fraction of the way to the next.
    pub(super) fn split(&self, phase: f64) -> (usize, f64) {
        let position = wrapped(phase) * self.marks.len() as f64;
        let mark = (position as usize).min(self.marks.len() - 1);
        (mark, position - mark as f64)
    }
}

/// Returns usable values for start and length: finite, the length 0 or more.
pub(super) fn usable_span(start: f32, length: f32) -> (f32, f32) {
    let start = if start.is_finite() { start } else { 0.0 };
    let length = if length.is_finite() { length.max(0.0) } else { 0.0 };
    (start, length)
}

/// Wraps a phase into 0..1; 0 where it is not finite.
pub(super) fn wrapped(phase: f64) -> f64 {
    let inside = phase.rem_euclid(1.0);
    // A tiny negative number wraps to 1 by rounding.
    if inside < 1.0 { inside } else { 0.0 }
}

/// Returns the common length, in seconds, of cycles of several lengths that run in step: their weighted mean.
///
/// ```text
/// Σ weight * length / Σ weight
/// ```
///
/// `cycles` are pairs of (length in seconds, weight). Negative and NaN count as 0, infinite as the largest `f32`; the
/// result is 0 without any weight. Play each at `length / common` times its own speed.
pub fn common_length(cycles: impl IntoIterator<Item = (f32, f32)>) -> f32 {
    let (mut seconds, mut weights) = (0.0_f64, 0.0_f64);
    for (length, weight) in cycles {
        let weight = f64::from(super::weight_or_zero(weight));
        seconds += weight * f64::from(super::weight_or_zero(length));
        weights += weight;
    }
    if weights > 0.0 { (seconds / weights) as f32 } else { 0.0 }
}
