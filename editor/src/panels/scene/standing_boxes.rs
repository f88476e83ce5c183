//! Free places on the ground: next to the things that are there, by the boxes around them.

use dragonfly_anim::bounds::AxisBox;
use glam::DVec3;

/// Distance between boxes that are put next to each other, meters.
const GAP: f64 = 0.1;

/// Part of a centimeter that is an error of rounding.
const ROUNDING: f64 = 1e-6;

/// Depth to which boxes may cut each other and count as next to each other, meters.
const TOLERANCE: f64 = 1e-4;

/// The boxes around things on the ground, scene space.
#[derive(Clone, Debug, Default)]
pub struct StandingBoxes(Vec<[DVec3; 2]>);

impl StandingBoxes {
    /// Adds a box; an empty one is left out.
    pub fn add(&mut self, around: AxisBox) {
        if !around.is_empty() {
            self.0.push([around.min.as_dvec3(), around.max.as_dvec3()]);
        }
    }

    /// Returns the free place that is nearest to `wanted`: `wanted` itself, or the first one along the axes of the ground, in either direction, to a
    /// centimeter. `own` is the box around the thing that is put there while it is at the origin.
    pub fn free_place(&self, own: AxisBox, wanted: DVec3) -> DVec3 {
        if own.is_empty() {
            return wanted;
        }
        let own = [own.min.as_dvec3(), own.max.as_dvec3()];
        let ways = [(DVec3::X, false), (DVec3::X, true), (DVec3::Z, false), (DVec3::Z, true)];
        let mut best: Option<(f64, DVec3)> = None;
        for (axis, is_back) in ways {
            let Some(place) = self.first_free(own, wanted, axis, is_back) else { continue };
            let distance = place.distance(wanted);
            if best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, place));
            }
        }
        best.map_or(wanted, |(_, place)| place)
    }

    /// Returns the first free place from `wanted` on along an axis, or against it.
    fn first_free(&self, own: [DVec3; 2], wanted: DVec3, axis: DVec3, is_back: bool) -> Option<DVec3> {
        let mut place = wanted;
        // The place moves in one direction, so that each box is passed at most once.
        for _ in 0..=self.0.len() {
            let Some([min, max]) = self.0.iter().find(|other| cuts(own, place, other)) else {
                return Some(place);
            };
            let along = match is_back {
                false => (((max - own[0]).dot(axis) + GAP) * 100.0 - ROUNDING).ceil(),
                true => (((min - own[1]).dot(axis) - GAP) * 100.0 + ROUNDING).floor(),
            };
            place = place - axis * place + axis * (along / 100.0 + 0.0);
        }
        None
    }
}

/// Returns whether a box at `place` cuts another one or is closer to it than the gap.
fn cuts(own: [DVec3; 2], place: DVec3, [min, max]: &[DVec3; 2]) -> bool {
    // A thing above it is not next to it.
    let gap = DVec3::new(GAP, 0.0, GAP) - TOLERANCE;
    (place + own[0]).cmplt(*max + gap).all() && (place + own[1]).cmpgt(*min - gap).all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn around(center: Vec3, half: Vec3) -> AxisBox {
        AxisBox { min: center - half, max: center + half }
    }

    #[test]
    fn the_nearest_of_the_four_directions_is_chosen_and_rows_are_passed() {
        let own = around(Vec3::Y, Vec3::new(0.5, 1.0, 0.25));
        let mut boxes = StandingBoxes::default();
        let wanted = DVec3::new(0.3, 0.0, 0.0);
        assert_eq!(boxes.free_place(own, wanted), wanted, "nothing is there");
        let half = Vec3::new(0.5, 1.0, 1.5);
        boxes.add(around(Vec3::Y, half));
        assert_eq!(boxes.free_place(own, wanted), DVec3::new(1.1, 0.0, 0.0));
        boxes.add(around(Vec3::new(1.5, 1.0, 0.0), half));
        assert_eq!(boxes.free_place(own, wanted), DVec3::new(-1.1, 0.0, 0.0));
        boxes.add(around(Vec3::new(-1.5, 1.0, 0.0), half));
        assert_eq!(boxes.free_place(own, wanted), DVec3::new(0.3, 0.0, 1.85));
        // A thing over it or under it is not in the way.
        let above = wanted + DVec3::Y * 2.0;
        assert_eq!(boxes.free_place(own, above), above);
        assert_eq!(boxes.free_place(AxisBox::EMPTY, wanted), wanted);
    }
}
