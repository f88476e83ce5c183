//! A chain of cubic Bézier curves along the points of a stroke.
//!
//! Source: P. J. Schneider, "An Algorithm for Automatically Fitting Digitized Curves", Graphics Gems, 1990.

use glam::DVec3;

/// Rounds in which the parameters of the points are moved to the curve.
const ROUNDS: usize = 24;

/// Multiple of the tolerance, squared, above which moving the parameters cannot help any more.
const HOPELESS: f64 = 400.0;

/// Part of a stroke that is to be fitted.
struct StrokePart {
    first: usize,
    last: usize,
    /// Directions of the curve at its ends, pointing inwards.
    tangents: [DVec3; 2],
}

/// Returns the control points of cubic Bézier curves, 3 n + 1 of them, that are within `tolerance` of every point, in the unit of the
/// points. The first and the last point are on it.
///
/// Points that are not finite are left out, and neighbors at the same place count once. Empty for no points; for one point, a curve that
/// stays there. A tolerance that is not above 0 counts as a millionth of the length.
pub fn fit(points: &[DVec3], tolerance: f64) -> Vec<DVec3> {
    let mut points: Vec<DVec3> = points.iter().copied().filter(|point| point.is_finite()).collect();
    points.dedup();
    match points[..] {
        [] => return Vec::new(),
        [only] => return vec![only; 4],
        _ => {}
    }
    let length: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let tolerance = if tolerance > 0.0 && tolerance.is_finite() { tolerance } else { length * 1e-6 };
    let last = points.len() - 1;
    let tangents = [direction(&points, 0, 1), direction(&points, last, last - 1)];
    let mut control = vec![points[0]];
    // The stack is our own, so that no stroke overflows that of the thread. The last entry is the next one.
    let mut open = vec![StrokePart { first: 0, last, tangents }];
    while let Some(part) = open.pop() {
        match fitted(&points[part.first..=part.last], part.tangents, tolerance) {
            Ok(curve) => control.extend(&curve[1..]),
            Err(split) => {
                let middle = part.first + split;
                let center = (points[middle - 1] - points[middle + 1]).normalize_or(part.tangents[1]);
                let second =
                    StrokePart { first: middle, last: part.last, tangents: [-center, part.tangents[1]] };
                open.push(second);
                open.push(StrokePart {
                    first: part.first,
                    last: middle,
                    tangents: [part.tangents[0], center],
                });
            }
        }
    }
    control
}

fn direction(points: &[DVec3], from: usize, to: usize) -> DVec3 {
    (points[to] - points[from]).normalize_or_zero()
}

/// Returns the curve along `points`; where none is near enough, the inner point at which to split.
fn fitted(points: &[DVec3], tangents: [DVec3; 2], tolerance: f64) -> Result<[DVec3; 4], usize> {
    let last = points.len() - 1;
    if last == 1 {
        let third = points[0].distance(points[1]) / 3.0;
        return Ok([points[0], points[0] + tangents[0] * third, points[1] + tangents[1] * third, points[1]]);
    }
    let mut parameters = chord_parameters(points);
    let mut curve = least_squares(points, &parameters, tangents);
    let (mut error, mut split) = largest_error(points, &parameters, &curve);
    let allowed = tolerance * tolerance;
    if error > allowed && error < allowed * HOPELESS {
        for _ in 0..ROUNDS {
            for (parameter, &point) in parameters.iter_mut().zip(points) {
                *parameter = nearer(&curve, point, *parameter);
            }
            // Neighbors in another order would make the curve turn back.
            if parameters.windows(2).any(|pair| pair[0] > pair[1]) {
                break;
            }
            curve = least_squares(points, &parameters, tangents);
            (error, split) = largest_error(points, &parameters, &curve);
            if error <= allowed {
                break;
            }
        }
    }
    if error <= allowed { Ok(curve) } else { Err(split) }
}

/// Returns for each point its share of the length of the stroke.
fn chord_parameters(points: &[DVec3]) -> Vec<f64> {
    let mut parameters = vec![0.0];
    let mut length = 0.0;
    for pair in points.windows(2) {
        length += pair[0].distance(pair[1]);
        parameters.push(length);
    }
    // Neighbors differ, so there is a length.
    parameters.iter_mut().for_each(|parameter| *parameter /= length);
    parameters
}

/// Returns the curve with these tangents whose points at the parameters are nearest to the points: the lengths of its tangents solve two
/// linear equations.
fn least_squares(points: &[DVec3], parameters: &[f64], tangents: [DVec3; 2]) -> [DVec3; 4] {
    let (start, end) = (points[0], points[points.len() - 1]);
    let (mut c, mut x) = ([[0.0; 2]; 2], [0.0; 2]);
    for (&point, &t) in points.iter().zip(parameters) {
        let weights = weights(t);
        let a = [tangents[0] * weights[1], tangents[1] * weights[2]];
        let rest = point - (start * (weights[0] + weights[1]) + end * (weights[2] + weights[3]));
        for row in 0..2 {
            for column in 0..2 {
                c[row][column] += a[row].dot(a[column]);
            }
            x[row] += a[row].dot(rest);
        }
    }
    let determinant = c[0][0] * c[1][1] - c[0][1] * c[1][0];
    let chord = start.distance(end);
    let lengths =
        [x[0] * c[1][1] - x[1] * c[0][1], c[0][0] * x[1] - c[1][0] * x[0]].map(|one| one / determinant);
    // Without a solution, or with tangents that point backwards, a third of the chord is the usual guess.
    let is_good = |length: f64| length.is_finite() && length > chord * 1e-6;
    let lengths = if lengths.iter().all(|&one| is_good(one)) { lengths } else { [chord / 3.0; 2] };
    [start, start + tangents[0] * lengths[0], end + tangents[1] * lengths[1], end]
}

/// Returns the largest square of a distance between a point and the curve at its parameter, and which inner point that is.
fn largest_error(points: &[DVec3], parameters: &[f64], curve: &[DVec3; 4]) -> (f64, usize) {
    let mut found = (0.0, points.len() / 2);
    for at in 1..points.len() - 1 {
        let error = position(curve, parameters[at]).distance_squared(points[at]);
        if error > found.0 {
            found = (error, at);
        }
    }
    found
}

/// Returns a parameter whose point on the curve is nearer to `point`: one step of Newton's method.
fn nearer(curve: &[DVec3; 4], point: DVec3, t: f64) -> f64 {
    let away = position(curve, t) - point;
    let [a, b, c, d] = *curve;
    let s = 1.0 - t;
    let first = ((b - a) * (s * s) + (c - b) * (2.0 * s * t) + (d - c) * (t * t)) * 3.0;
    let second = ((c - b * 2.0 + a) * s + (d - c * 2.0 + b) * t) * 6.0;
    let slope = first.dot(first) + away.dot(second);
    let next = t - away.dot(first) / slope;
    if next.is_finite() { next.clamp(0.0, 1.0) } else { t }
}

fn weights(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Returns the point of a cubic Bézier curve at a parameter from 0 to 1.
pub(super) fn position(curve: &[DVec3; 4], t: f64) -> DVec3 {
    let weights = weights(t);
    curve[0] * weights[0] + curve[1] * weights[1] + curve[2] * weights[2] + curve[3] * weights[3]
}
