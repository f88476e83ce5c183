//! Ranges of angles.

use std::f64::consts::{PI, TAU};

/// Angles from `min` to `max`, radians, not wrapped, so −3 to 4 is more than a full turn and allows every angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleRange {
    /// Smallest angle in radians.
    pub min: f32,
    /// Largest angle in radians, not less than `min`.
    pub max: f32,
}

impl AngleRange {
    /// Allows every angle.
    pub const FREE: Self = Self { min: f32::NEG_INFINITY, max: f32::INFINITY };

    /// Allows no angle but 0.
    pub const NONE: Self = Self { min: 0.0, max: 0.0 };

    /// Creates a range from `min` to `max`, radians.
    pub fn new(min: f32, max: f32) -> Self {
        Self { min, max }
    }

    /// Creates a range from `min` to `max`, degrees.
    pub fn degrees(min: f32, max: f32) -> Self {
        Self { min: min.to_radians(), max: max.to_radians() }
    }

    /// Creates a range from `-angle` to `angle`, radians.
    pub fn within(angle: f32) -> Self {
        Self { min: -angle, max: angle }
    }

    /// Returns the mirrored range: from −max to −min.
    pub fn reversed(self) -> Self {
        Self { min: -self.max, max: -self.min }
    }

    /// Returns the middle and half of the width; `None` where the range does not limit.
    fn middle(self) -> Option<(f64, f64)> {
        let (min, max) = (f64::from(self.min), f64::from(self.max));
        let half = 0.5 * (max - min);
        (min.is_finite() && max.is_finite() && half < PI).then(|| (0.5 * (min + max), half.max(0.0)))
    }

    /// Returns the nearest allowed angle on the circle. Exactly opposite the middle both ends are equally near, and the
    /// result is one of them.
    ///
    /// An allowed angle is returned unchanged; any other gives an end of the range, −π..=π.
    pub(super) fn clamp(self, angle: f64) -> f64 {
        let Some((middle, half)) = self.middle() else { return angle };
        // First the middle, which may be any number of turns away.
        let middle = from_minus_pi(middle);
        let off = from_minus_pi(angle - middle);
        if off.abs() <= half { angle } else { from_minus_pi(middle + off.clamp(-half, half)) }
    }

    /// Returns the nearest allowed angle within `-most..=most`, on the line instead of the circle: for angles that do
    /// not wrap.
    pub(super) fn clamp_within(self, most: f64, angle: f64) -> f64 {
        let (min, max) = match self.middle() {
            Some((middle, half)) => (middle - half, middle + half),
            None => (-most, most),
        };
        let (min, max) = (min.clamp(-most, most), max.clamp(-most, most));
        angle.clamp(min, max)
    }
}

/// Wraps an angle into −π..=π; half a turn keeps its sign.
fn from_minus_pi(angle: f64) -> f64 {
    if angle.abs() <= PI {
        return angle;
    }
    let inside = angle.rem_euclid(TAU);
    if inside > PI { inside - TAU } else { inside }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-6
    }

    #[test]
    fn an_angle_outside_the_range_is_clamped_to_the_end_that_is_nearer_on_the_circle() {
        let range = AngleRange::degrees(-10.0, 150.0);
        let clamp = |degrees: f64| range.clamp(degrees.to_radians()).to_degrees();
        for (angle, expected) in [(0.0, 0.0), (149.0, 149.0), (160.0, 150.0), (-20.0, -10.0), (-179.0, 150.0)]
        {
            // The ends are f32: accurate to a few millionths of a degree.
            assert!((clamp(angle) - expected).abs() < 1e-4, "{angle}: {}", clamp(angle));
        }
        // -110° is opposite the middle (70°).
        assert!(clamp(-109.0) < -9.9 && clamp(-111.0) > 149.9);
    }

    #[test]
    fn a_range_beyond_half_a_turn_contains_the_same_angles_counted_from_the_other_side() {
        let range = AngleRange::degrees(90.0, 270.0);
        assert_eq!(range.clamp(-3.0), -3.0, "-172° is 188°");
        assert!(near(range.clamp(0.1), 0.5 * PI) && near(range.clamp(-0.1), -0.5 * PI));
    }

    #[test]
    fn unlimited_and_reversed_ranges_have_defined_results() {
        for free in [AngleRange::FREE, AngleRange::new(f32::NAN, 1.0), AngleRange::new(-3.0, 4.0)] {
            assert_eq!(free.clamp(2.5), 2.5);
            assert_eq!(free.clamp_within(1.0, 2.5), 1.0);
        }
        let reversed = AngleRange::new(1.0, 0.5);
        assert!(near(reversed.clamp(0.0), 0.75) && near(reversed.clamp(1.0), 0.75));
        assert_eq!(AngleRange::new(2.0, 3.0).clamp_within(1.0, 0.0), 1.0);
    }
}
