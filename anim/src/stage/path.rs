//! Paths by length: position and direction after a distance in meters.
//!
//! A smooth path is a Catmull-Rom spline through its points: between two of them a cubic whose slope at each is half the difference of
//! its neighbors. Its length is summed over 64 straight pieces of each part, fewer where there are very many parts;
//! within a piece the speed of the parameter changes evenly.

use glam::DVec3;

/// Number of pieces of a curved part.
const PIECES: usize = 64;

/// Smallest number of pieces of a curved part, for a path of very many points, which are close together.
const FEWEST_PIECES: usize = 4;

/// Number of pieces of a path above which its parts have fewer of them.
const MOST_PIECES: usize = 1 << 18;

/// A path through the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct StagePath {
    points: Vec<DVec3>,
    is_smooth: bool,
    /// Length from the start to each piece, ascending; the last one is the whole.
    lengths: Vec<f64>,
}

/// A point of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSpot {
    /// Position, meters.
    pub position: DVec3,
    /// Direction, unit length; zero where the path has no length.
    pub direction: DVec3,
}

impl StagePath {
    /// Creates a path through `points`; neighbors at the same position count once. Without points it is at the origin.
    pub fn new(points: &[DVec3], is_smooth: bool) -> Self {
        let mut own: Vec<DVec3> = points.to_vec();
        own.dedup();
        if own.is_empty() {
            own.push(DVec3::ZERO);
        }
        let mut path = Self { is_smooth: is_smooth && own.len() > 2, points: own, lengths: vec![0.0] };
        let pieces = (path.points.len() - 1) * path.pieces();
        for piece in 0..pieces {
            let [a, b] = [piece, piece + 1].map(|at| path.point(at / path.pieces(), path.share(at)));
            let last = path.lengths.last().copied().unwrap_or(0.0);
            path.lengths.push(last + a.distance(b));
        }
        path
    }

    /// Returns the length in meters.
    pub fn length(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// Returns the point after `distance` meters, clamped to the path.
    pub fn at(&self, distance: f64) -> PathSpot {
        if self.points.len() < 2 {
            return PathSpot {
                position: self.points.first().copied().unwrap_or(DVec3::ZERO),
                direction: DVec3::ZERO,
            };
        }
        let distance = distance.clamp(0.0, self.length());
        let last = self.lengths.len() - 2;
        let piece = self.lengths.partition_point(|&length| length <= distance).saturating_sub(1).min(last);
        let span = self.lengths[piece + 1] - self.lengths[piece];
        let within = if span > 0.0 { (distance - self.lengths[piece]) / span } else { 0.0 };
        let (part, pieces) = (piece / self.pieces(), self.pieces() as f64);
        let first = (piece % self.pieces()) as f64;
        let ends = [first, first + 1.0].map(|at| self.slope(part, at / pieces).length());
        let share = (first + evened(ends, within)) / pieces;
        PathSpot { position: self.point(part, share), direction: self.slope(part, share).normalize_or_zero() }
    }

    /// Returns the part of the path that is there after `distance` meters: the number of points before it, less one. Points at the same position as
    /// the one before do not count.
    pub fn part_at(&self, distance: f64) -> usize {
        let last = self.lengths.len().saturating_sub(2);
        let piece = self.lengths.partition_point(|&length| length <= distance).saturating_sub(1).min(last);
        piece / self.pieces()
    }

    /// Returns the radius of the circle through the places after `distance` meters and `span` meters before and after that; infinite where
    /// they are on a line, and near the ends. At a corner it is in proportion to `span`, and 0 where the path turns back.
    pub fn radius(&self, distance: f64, span: f64) -> f64 {
        if !(span > 0.0 && distance >= span && distance + span <= self.length()) {
            return f64::INFINITY;
        }
        let [before, here, after] =
            [distance - span, distance, distance + span].map(|at| self.at(at).position);
        let sides = [here - before, after - here, after - before];
        let double_area = sides[0].cross(sides[2]).length();
        if sides[2].length() == 0.0 {
            return 0.0;
        }
        if double_area > 0.0 {
            sides.iter().map(|side| side.length()).product::<f64>() / (2.0 * double_area)
        } else if sides[0].dot(sides[1]) < 0.0 {
            0.0
        } else {
            f64::INFINITY
        }
    }

    fn pieces(&self) -> usize {
        if self.is_smooth { (MOST_PIECES / self.points.len()).clamp(FEWEST_PIECES, PIECES) } else { 1 }
    }

    fn share(&self, piece: usize) -> f64 {
        (piece % self.pieces()) as f64 / self.pieces() as f64
    }

    /// Returns the point at the share `x` of a part; the last point past the end.
    fn point(&self, part: usize, x: f64) -> DVec3 {
        let Some(&[a, b]) = self.points.get(part..).and_then(<[DVec3]>::first_chunk) else {
            return self.points.last().copied().unwrap_or(DVec3::ZERO);
        };
        if !self.is_smooth {
            return a + (b - a) * x;
        }
        let (leave, arrive) = self.slopes(part);
        let (x2, x3) = (x * x, x * x * x);
        a * (2.0 * x3 - 3.0 * x2 + 1.0)
            + leave * (x3 - 2.0 * x2 + x)
            + b * (3.0 * x2 - 2.0 * x3)
            + arrive * (x3 - x2)
    }

    fn slope(&self, part: usize, x: f64) -> DVec3 {
        let Some(&[a, b]) = self.points.get(part..).and_then(<[DVec3]>::first_chunk) else {
            return DVec3::ZERO;
        };
        if !self.is_smooth {
            return b - a;
        }
        let (leave, arrive) = self.slopes(part);
        (b - a) * (6.0 * x * (1.0 - x))
            + leave * (3.0 * x * x - 4.0 * x + 1.0)
            + arrive * (3.0 * x * x - 2.0 * x)
    }

    /// Returns the slopes at both ends of a part.
    fn slopes(&self, part: usize) -> (DVec3, DVec3) {
        let last = self.points.len() - 1;
        let at = |index: usize| self.points[index.min(last)];
        let slope = |index: usize| match index {
            0 => at(1) - at(0),
            index if index >= last => at(last) - at(last - 1),
            index => (at(index + 1) - at(index - 1)) * 0.5,
        };
        (slope(part), slope(part + 1))
    }
}

/// Returns the share of a parameter at the share `way` of the way, where the speed changes evenly from `before` to `after`: the root of
/// `before u + (after - before) u² / 2 = way (before + after) / 2`.
fn evened([before, after]: [f64; 2], way: f64) -> f64 {
    let whole = 0.5 * way * (before + after);
    let root = (before * before + 2.0 * (after - before) * whole).max(0.0).sqrt();
    if before + root > 0.0 { (2.0 * whole / (before + root)).clamp(0.0, 1.0) } else { way }
}
