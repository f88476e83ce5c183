//! Guess of the unit of length, which BVH files do not contain, from the size of the figure.
//!
//! Nearly every file is a motion capture of a human. The height is estimated from the longest way through the skeleton,
//! such as from a toe to the fingers of a hand, which is the same in every pose and however the rest pose is turned.

use super::hierarchy::JointTable;
use super::motion::MotionRows;
use crate::model_unit::longest_way;
use glam::DVec3;
use std::ops::RangeInclusive;

/// The longest way through the skeleton of a human, divided by the height.
const WAY_PER_HEIGHT: f64 = 1.45;

/// A usual unit in meters, and the heights in meters for which it is assumed.
type UsualUnit = (f32, RangeInclusive<f64>);

/// The usual units; the first one that gives a possible height is assumed.
const UNITS: [UsualUnit; 5] = [
    // Meters: anything from a hamster to an elephant.
    (1.0, 0.1..=6.0),
    (0.01, 1.0..=2.6),
    (0.001, 1.0..=2.6),
    (0.0254, 1.4..=2.2),
    // The unit of the CMU motion capture database: an inch divided by 0.45.
    (0.056_444, 1.4..=2.2),
];

/// Height in meters of a figure for which no usual unit is possible.
const USUAL_HEIGHT: f64 = 1.7;

/// Returns the guessed number of meters per unit.
pub(super) fn meters_per_unit(hierarchy: &JointTable, rows: &MotionRows) -> f32 {
    let way = way_of(hierarchy, &[]);
    if way > 0.0 {
        return guess(way);
    }
    // Every offset is zero: the positions of the first frame replace them.
    guess(way_of(hierarchy, rows.numbers.get(..hierarchy.channels).unwrap_or(&[])))
}

/// Returns the guessed number of meters per unit of a figure whose longest way has this length in units.
pub(super) fn guess(way: f64) -> f32 {
    let height = way / WAY_PER_HEIGHT;
    let usual = UNITS.iter().find(|(unit, heights)| heights.contains(&(height * f64::from(*unit))));
    match usual {
        Some((unit, _)) => *unit,
        None if height > 0.0 => {
            // Two digits: the height is only an estimate.
            let unit = USUAL_HEIGHT / height;
            let digits = libm::pow(10.0, 1.0 - libm::floor(libm::log10(unit)));
            let rounded = ((unit * digits).round() / digits) as f32;
            if rounded.is_normal() { rounded } else { 1.0 }
        }
        None => 1.0,
    }
}

/// Returns the length of the longest way between two joints of a file along the bones; `row` replaces offsets.
fn way_of(hierarchy: &JointTable, row: &[f64]) -> f64 {
    longest_way(hierarchy.joints.iter().map(|joint| {
        let own = row.get(joint.first..joint.first + joint.channels.len()).unwrap_or(&[]);
        (joint.parent, joint.channels.translation(joint.offset, own).length())
    }))
}

/// Returns whether the up axis of the figure seems to be z: at rest it is flat along y, as a human with spread arms is along the
/// horizontal axis from back to front, and the root is further along z than along y.
pub(super) fn seems_z_up(hierarchy: &JointTable, rows: &MotionRows) -> bool {
    let mut origins: Vec<DVec3> = Vec::with_capacity(hierarchy.joints.len());
    for joint in &hierarchy.joints {
        let parent = joint.parent.map_or(DVec3::ZERO, |parent| origins[parent] + joint.offset);
        origins.push(parent);
    }
    let [low, high] =
        [DVec3::min, DVec3::max].map(|of| origins.iter().copied().reduce(of).unwrap_or_default());
    let extent = high - low;
    let is_flat = extent.y < FLAT * extent.x.min(extent.z);
    let Some((root, first)) = hierarchy.joints.first().zip(rows.numbers.get(..hierarchy.channels)) else {
        return false;
    };
    let position = root.channels.translation(root.offset, &first[..root.channels.len()]);
    is_flat && position.z > 2.0 * position.y.abs() && position.z > FLAT * extent.z
}

/// Depth of a human with spread arms, divided by the height and the span.
const FLAT: f64 = 0.35;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_that_makes_a_figure_as_tall_as_a_human_is_guessed() {
        let guesses = [
            (1.75, 1.0),
            (0.4, 1.0),
            (175.0, 0.01),
            (120.0, 0.01),
            (1750.0, 0.001),
            (68.9, 0.0254),
            (28.6, 0.056_444),
            (44.3, 0.038),
            (0.01, 170.0),
            (0.0, 1.0),
            (1e300, 1.0),
        ];
        for (height, unit) in guesses {
            assert_eq!(guess(height * WAY_PER_HEIGHT), unit, "{height}");
        }
    }
}
