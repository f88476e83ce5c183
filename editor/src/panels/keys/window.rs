//! The part of time that the timeline and the curves show, and the position of each time.

use crate::panels::ruler::Ruler;
use dragonfly_picture::between;

/// The part of time that is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeWindow {
    /// Time at the left end, seconds.
    pub start: f64,
    /// Duration from the left to the right end, seconds.
    pub length: f64,
}

/// The shortest and the longest part of time that can be shown, seconds.
const SHORTEST: f64 = 0.01;
const LONGEST: f64 = 1e6;
/// Duration that can be shown of any take, however short it is, seconds.
const GROWS: f64 = 15.0;

/// Part of a window in which the time before a scene is shown.
const BEFORE: f64 = 0.1;

impl TimeWindow {
    /// Returns the window of a whole take; one second for a single pose.
    pub fn whole(start: f32, length: f32) -> Self {
        let length = if length > 0.0 { f64::from(length) } else { 1.0 };
        Self { start: f64::from(start), length }.sanitized()
    }

    /// Returns the window with finite numbers, neither too short nor too long.
    pub fn sanitized(self) -> Self {
        let start = if self.start.is_finite() { self.start.clamp(-LONGEST, LONGEST) } else { 0.0 };
        let length = if self.length.is_finite() { self.length.clamp(SHORTEST, LONGEST) } else { 1.0 };
        Self { start, length }
    }

    /// Returns a window `factor` times as long; the time `about` keeps its position.
    pub fn zoomed(self, about: f64, factor: f64) -> Self {
        let length = (self.length * factor).clamp(SHORTEST, LONGEST);
        let part = (about - self.start) / self.length;
        Self { start: about - part * length, length }.sanitized()
    }

    /// Returns a window of the same length, `by` seconds later.
    pub fn panned(self, by: f64) -> Self {
        Self { start: self.start + by, ..self }.sanitized()
    }

    /// Returns the window moved so that a time is in sight, a tenth of its length from the edge; `None` where it is in sight.
    pub fn showing(self, at: f64) -> Option<Self> {
        let end = self.start + self.length;
        // The slack allows for rounding to single precision.
        let slack = self.length * 1e-3;
        if (self.start - slack..=end + slack).contains(&at) {
            return None;
        }
        let margin = self.length * 0.1;
        Some(self.panned(if at > end { at - end + margin } else { at - self.start - margin }))
    }

    /// Returns the window limited to twice a scene from 0 to `end`, or to what a short one may grow to, and moved so that it does not begin far before 0,
    /// and a part of the scene is in sight.
    pub fn within(self, end: f64) -> Self {
        let length = self.length.min((end * 2.0).max(GROWS)).max(SHORTEST);
        let first = -length * BEFORE;
        let start = between(self.start, first, (end - length * 0.1).max(first));
        Self { start, length }.sanitized()
    }

    /// Returns the window moved so that at least a part of `first..=last` is in sight, and limited to three times that length, or
    /// to what a short take may grow to.
    pub fn near(self, first: f64, last: f64) -> Self {
        let length = self.length.min(((last - first) * 3.0).max(GROWS)).max(SHORTEST);
        let start = between(self.start, first - length * 0.9, last - length * 0.1);
        Self { start, length }.sanitized()
    }
}

/// The position of each time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeScale {
    /// Position of the left end of the window, points.
    pub left: f32,
    /// Width of the window, points; more than zero.
    pub width: f32,
    /// The part of time that is shown.
    pub window: TimeWindow,
}

impl TimeScale {
    /// Returns the number of points per second.
    pub fn per_second(&self) -> f64 {
        f64::from(self.width.max(1.0)) / self.window.length
    }

    /// Returns the position of `time`, points; limited to large finite numbers.
    pub fn x_of(&self, time: f32) -> f32 {
        let x = f64::from(self.left) + (f64::from(time) - self.window.start) * self.per_second();
        x.clamp(-1e6, 1e6) as f32
    }

    /// Returns the time at `x` points, also outside of the window, seconds.
    pub fn time_at(&self, x: f32) -> f32 {
        (self.window.start + f64::from(x - self.left) / self.per_second()) as f32
    }

    /// Returns the duration of a distance of `points`, seconds.
    pub fn seconds(&self, points: f32) -> f32 {
        (f64::from(points) / self.per_second()) as f32
    }

    /// Returns the ruler for lines and labels.
    pub fn ruler(&self) -> Ruler {
        Ruler {
            left: self.left,
            width: self.width,
            start: self.window.start as f32,
            length: self.window.length as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zooming_keeps_the_time_under_the_pointer() {
        let scale = |window| TimeScale { left: 50.0, width: 600.0, window };
        let before = TimeWindow { start: 1.0, length: 4.0 };
        let time = scale(before).time_at(200.0);
        for factor in [0.5, 0.9, 1.3, 7.0] {
            let after = before.zoomed(f64::from(time), factor);
            assert!((scale(after).x_of(time) - 200.0).abs() < 0.01, "{factor}");
        }
    }

    #[test]
    fn a_window_of_a_scene_is_limited_to_twice_its_length_and_begins_little_before_it() {
        for (start, length) in [(-1e5, 1e6), (-3.0, 10.0), (0.0, 5.0), (90.0, 1.0), (1e5, 400.0)] {
            let window = TimeWindow { start, length }.within(100.0);
            assert!(window.length <= 200.0 && window.start >= -0.1 * window.length, "{window:?}");
            assert!(window.start < 100.0 && window.start + window.length > 0.0, "{window:?}");
        }
        let inside = TimeWindow { start: 0.0, length: 5.0 };
        assert_eq!(inside.within(100.0), inside);
    }

    #[test]
    fn a_window_from_any_numbers_is_finite_and_not_empty() {
        for start in [f64::NAN, f64::INFINITY, -1e300, 0.0] {
            for length in [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e300] {
                let window = TimeWindow { start, length }.sanitized().near(0.0, 3.0);
                assert!(window.start.is_finite() && window.length >= SHORTEST, "{window:?}");
            }
        }
    }
}
