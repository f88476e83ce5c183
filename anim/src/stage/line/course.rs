//! A line as the few points of a path that follows it.

use super::samples::LineSamples;
use crate::stage::path::StagePath;
use glam::DVec3;

/// Numbers of points that are tried.
const COUNTS: [usize; 12] = [2, 3, 4, 5, 6, 8, 12, 16, 24, 32, 48, 64];

/// Number of places at which a path is compared with its line.
const COMPARED: usize = 128;

/// Returns points, meters, at equal distances along a chain of cubic Bézier curves with these control points: so few that the smooth path
/// through them ([`StagePath`]) stays within `tolerance` meters of the line after the same share of the length, but 64 at most.
///
/// Empty for a line without points or length.
pub fn path_points(control: &[DVec3], tolerance: f64) -> Vec<DVec3> {
    let samples = LineSamples::new(control, false);
    if samples.length() <= 0.0 {
        return Vec::new();
    }
    let mut points = Vec::new();
    for count in COUNTS {
        points.clear();
        points.extend((0..count).filter_map(|at| along(&samples, at, count - 1)));
        let path = StagePath::new(&points, true);
        let is_near = (0..=COMPARED).all(|at| {
            let on_path = path.at(path.length() * at as f64 / COMPARED as f64).position;
            along(&samples, at, COMPARED).is_none_or(|place| place.distance(on_path) <= tolerance)
        });
        if is_near {
            break;
        }
    }
    points
}

fn along(samples: &LineSamples, at: usize, of: usize) -> Option<DVec3> {
    samples.at(samples.length() * at as f64 / of as f64)
}
