//! Points of lines: added on a line without changing its form, and removed.

use super::fit::position;
use glam::DVec3;

/// Returns the place on a curve of a line at a share from 0 to 1; `None` where there is no such curve.
pub fn line_place(control: &[DVec3], curve: usize, share: f64) -> Option<DVec3> {
    Some(position(curve_of(control, curve)?, share))
}

/// Returns the control points of a line with another point on one of its curves, at a share from 0 to 1. The line keeps its form. `None` where there is no
/// such curve.
pub fn with_line_point(control: &[DVec3], curve: usize, share: f64) -> Option<Vec<DVec3>> {
    let &[a, b, c, d] = curve_of(control, curve)?;
    let [ab, bc, cd] = [(a, b), (b, c), (c, d)].map(|(from, to)| from.lerp(to, share));
    let [left, right] = [(ab, bc), (bc, cd)].map(|(from, to)| from.lerp(to, share));
    let mut points = control.to_vec();
    points.splice(3 * curve + 1..3 * curve + 3, [ab, left, left.lerp(right, share), right, cd]);
    Some(points)
}

/// Returns the control points of a line without one of its points: the curves on both sides become one. `index` is that of the point or of one that gives
/// the curve its direction there. `None` where only one curve is left, and where there is no such point.
pub fn without_line_point(control: &[DVec3], index: usize) -> Option<Vec<DVec3>> {
    let (count, point) = (control.len(), (index + 1) / 3 * 3);
    if index >= count || count < 7 {
        return None;
    }
    let mut points = control.to_vec();
    match point {
        0 => points.drain(..3),
        point if point + 1 >= count => points.drain(count - 3..),
        point => points.drain(point - 1..point + 2),
    };
    Some(points)
}

fn curve_of(control: &[DVec3], curve: usize) -> Option<&[DVec3; 4]> {
    control.get(curve.checked_mul(3)?..)?.first_chunk()
}
