//! The surfaces over a point, one over the other.

use glam::DVec3;

/// Height over ground that a ceiling leaves at least, meters.
pub(super) const ROOM: f64 = 0.5;

/// Distance of heights, meters, up to which they count as the same.
pub(super) const TOUCH: f64 = 1e-4;

/// Number of surfaces over each other that count, from the top.
const MOST: usize = 32;

/// A surface over or under a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::stage) struct GroundSurface {
    /// Meters.
    pub(in crate::stage) height: f64,
    /// Unit length; points up, also of a surface that faces down.
    pub(in crate::stage) normal: DVec3,
    pub(super) faces_up: bool,
}

/// The surfaces over a point, from the top down. At the same height, what faces up is over what faces down.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroundColumn {
    surfaces: [GroundSurface; MOST],
    count: usize,
}

impl GroundColumn {
    pub(super) fn new() -> Self {
        let none = GroundSurface { height: 0.0, normal: DVec3::Y, faces_up: true };
        Self { surfaces: [none; MOST], count: 0 }
    }

    /// Adds a surface; of too many, the lowest is left out. Of those at the same height that face the same way, such as the triangles around the tip of
    /// a fan, the first by their order is there once. The result does not depend on the order in which they are added, unless many are that near to each
    /// other.
    pub(super) fn add(&mut self, surface: GroundSurface) {
        let is_over = |other: &GroundSurface| {
            let height = other.height.total_cmp(&surface.height);
            let normal = || other.normal.to_array().partial_cmp(&surface.normal.to_array());
            height
                .then(other.faces_up.cmp(&surface.faces_up))
                .then_with(|| normal().unwrap_or(std::cmp::Ordering::Equal))
                .is_ge()
        };
        let is_same = |other: &GroundSurface| {
            other.faces_up == surface.faces_up && (other.height - surface.height).abs() <= TOUCH
        };
        if let Some(same) = self.surfaces[..self.count].iter().position(is_same) {
            if is_over(&self.surfaces[same]) {
                return;
            }
            self.surfaces[same..self.count].rotate_left(1);
            self.count -= 1;
        }
        let at = self.surfaces[..self.count].partition_point(is_over);
        if at < MOST {
            self.count = (self.count + 1).min(MOST);
            self.surfaces[at..self.count].rotate_right(1);
            self.surfaces[at] = surface;
        }
    }

    /// Returns the surfaces that are ground, from the top down.
    pub(super) fn ground(&self) -> impl Iterator<Item = &GroundSurface> {
        let all = &self.surfaces[..self.count];
        let stands = |&(at, surface): &(usize, &GroundSurface)| {
            let over = at.checked_sub(1).and_then(|over| all.get(over));
            surface.faces_up && over.is_none_or(|over| !over.faces_up && over.height - surface.height >= ROOM)
        };
        all.iter().enumerate().filter(stands).map(|(_, surface)| surface)
    }
}
