//! A line as the few points of a path that follows it.

use super::samples::LineSamples;
use crate::stage::path::StagePath;
use glam::DVec3;

/// Most points of a path.
const MOST: usize = 64;

/// Number of places at which a path is compared with its line.
const COMPARED: usize = 128;

/// Returns points, meters, of a chain of cubic Bézier curves with these control points: so few that the smooth path through them ([`StagePath`])
/// stays within `tolerance` meters of the line, but 64 at most. They are dense where the line bends: each one is added where the path so far is
/// farthest from the line.
///
/// Empty for a line without points or length.
pub fn path_points(control: &[DVec3], tolerance: f64) -> Vec<DVec3> {
    let samples = LineSamples::new(control, false);
    if samples.length() <= 0.0 {
        return Vec::new();
    }
    let line: Vec<DVec3> = (0..=COMPARED).filter_map(|at| along(&samples, at, COMPARED)).collect();
    let mut chosen = vec![0, line.len() - 1];
    let mut points: Vec<DVec3> = chosen.iter().map(|&at| line[at]).collect();
    while points.len() < MOST.min(line.len()) {
        let path = StagePath::new(&points, true);
        let course: Vec<DVec3> = (0..=COMPARED * 2)
            .map(|at| path.at(path.length() * at as f64 / (COMPARED * 2) as f64).position)
            .collect();
        // The place of the line that is farthest from the path, in order along both.
        let mut near = 0;
        let mut farthest = (0.0, 0);
        for (at, place) in line.iter().enumerate() {
            let ahead = course[near..].iter().map(|on| on.distance(*place)).enumerate();
            let (step, distance) =
                ahead.take(WINDOW).min_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or((0, f64::MAX));
            near += step;
            if distance > farthest.0 && !chosen.contains(&at) {
                farthest = (distance, at);
            }
        }
        if farthest.0 <= tolerance {
            break;
        }
        let place = chosen.partition_point(|&at| at < farthest.1);
        chosen.insert(place, farthest.1);
        keep_even(&mut chosen);
        points = chosen.iter().map(|&at| line[at]).collect();
    }
    points
}

/// Adds places between others until no distance is much larger than the one before or after it: a smooth path would overshoot there.
fn keep_even(chosen: &mut Vec<usize>) {
    while let Some(place) = (1..chosen.len().saturating_sub(1)).find_map(|at| {
        let [before, after] = [chosen[at] - chosen[at - 1], chosen[at + 1] - chosen[at]];
        let is_uneven = before.max(after) > 2 * before.min(after) + 1;
        is_uneven.then_some(if before > after { at } else { at + 1 })
    }) {
        chosen.insert(place, (chosen[place - 1] + chosen[place]) / 2);
    }
}

/// Number of places ahead on a path among which the nearest one is looked for, so that a line that crosses itself is followed in order.
const WINDOW: usize = 24;

fn along(samples: &LineSamples, at: usize, of: usize) -> Option<DVec3> {
    samples.at(samples.length() * at as f64 / of as f64)
}
