//! Points along a line, by length.

use super::fit::position;
use glam::DVec3;

/// Number of straight pieces of a curve.
const PIECES: usize = 128;

/// Smallest number of pieces of a curve, for a line of very many.
const FEWEST_PIECES: usize = 8;

/// Number of pieces of a line above which its curves have fewer of them.
const MOST_PIECES: usize = 1 << 16;

/// Points along a line, dense enough to measure it: 128 pieces a curve, and fewer for lines of more than 512 curves, but 8 at least.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineSamples {
    points: Vec<DVec3>,
    /// Length from the start to each point.
    lengths: Vec<f64>,
}

impl LineSamples {
    /// Samples a chain of cubic Bézier curves with these control points, 3 n + 1 of them; others are left out at the end. A closed line ends
    /// where it starts.
    pub fn new(control: &[DVec3], is_closed: bool) -> Self {
        let mut points: Vec<DVec3> = control.first().copied().into_iter().collect();
        let pieces = (MOST_PIECES / (control.len() / 3).max(1)).clamp(FEWEST_PIECES, PIECES);
        for curve in control.windows(4).step_by(3) {
            let Ok(curve) = <&[DVec3; 4]>::try_from(curve) else { continue };
            points.extend((1..=pieces).map(|piece| position(curve, piece as f64 / pieces as f64)));
        }
        if is_closed {
            points.extend(points.first().copied());
        }
        points.dedup();
        let mut length = 0.0;
        let mut lengths: Vec<f64> = points.first().map(|_| 0.0).into_iter().collect();
        for pair in points.windows(2) {
            length += pair[0].distance(pair[1]);
            lengths.push(length);
        }
        Self { points, lengths }
    }

    /// Returns the points, meters.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Returns the length, meters; 0 without points.
    pub fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// Returns the position after `along` meters, clamped to the line; `None` without points.
    pub fn at(&self, along: f64) -> Option<DVec3> {
        let next = self.lengths.partition_point(|&length| length < along);
        let (Some(before), Some(after)) = (next.checked_sub(1), self.points.get(next)) else {
            return self.points.get(next.min(self.points.len().checked_sub(1)?)).copied();
        };
        let [from, to] = [before, next].map(|index| self.lengths[index]);
        Some(self.points[before].lerp(*after, (along - from) / (to - from)))
    }
}
