//! The picture as the gizmo sees it: points of the screen and places of the scene, in `f64`, so that a drag keeps its digits
//! far from the origin.

use crate::camera::{Camera, Projection};
use glam::{DVec2, DVec3, Vec2};

/// A camera and the size of the picture. Points are counted from the top left of the picture, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GizmoView {
    /// The direction to the right of the viewport, scene space, unit length.
    pub right: DVec3,
    /// The direction up in the viewport, scene space, unit length.
    pub up: DVec3,
    /// The direction towards the viewer, scene space, unit length.
    pub back: DVec3,
    eye: DVec3,
    target: DVec3,
    perspective: bool,
    /// Scene units a point covers: at distance 1 with perspective, everywhere without.
    unit: f64,
    /// The size of the viewport, logical points.
    pub size: DVec2,
}

impl GizmoView {
    /// A picture of `size` points.
    pub fn new(camera: &Camera, size: Vec2) -> Self {
        let size = size.as_dvec2().max(DVec2::ONE);
        let (sin_yaw, cos_yaw) = f64::from(camera.yaw).sin_cos();
        let (sin_pitch, cos_pitch) = f64::from(camera.pitch).sin_cos();
        let right = DVec3::new(cos_yaw, 0.0, -sin_yaw);
        let back = DVec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch);
        let target = camera.target.as_dvec3();
        let distance = f64::from(camera.distance);
        let perspective = camera.projection == Projection::Perspective;
        let unit = f64::from(camera.height_at_target()) / size.y;
        Self {
            right,
            up: back.cross(right),
            back,
            eye: target + back * distance,
            target,
            perspective,
            unit: if perspective { unit / distance } else { unit },
            size,
        }
    }

    /// A picture of so many pixels, on a screen with so many pixels a point.
    pub fn of_pixels(camera: &Camera, pixels: Vec2, pixels_per_point: f32) -> Self {
        let scale = if pixels_per_point > 0.0 { pixels_per_point } else { 1.0 };
        Self::new(camera, pixels / scale)
    }

    /// Distance before the eye, along the line of sight. Without perspective there is none: always 1.
    pub fn depth(&self, place: DVec3) -> f64 {
        if self.perspective { (self.eye - place).dot(self.back) } else { 1.0 }
    }

    /// Scene units that a point of the screen covers at a place; `None` behind the eye.
    pub fn units_per_point(&self, place: DVec3) -> Option<f64> {
        let unit = self.unit * self.depth(place);
        (unit > 0.0 && unit.is_finite()).then_some(unit)
    }

    /// Where a place of the scene appears; `None` behind the eye.
    pub fn to_screen(&self, place: DVec3) -> Option<DVec2> {
        let unit = self.units_per_point(place)?;
        let from = place - if self.perspective { self.eye } else { self.target };
        let at = DVec2::new(from.dot(self.right), -from.dot(self.up)) / unit + self.size / 2.0;
        at.is_finite().then_some(at)
    }

    /// The line of sight through a point: a place on it, and its unit direction away from the viewer.
    pub fn ray(&self, at: DVec2) -> (DVec3, DVec3) {
        let from_middle = at - self.size / 2.0;
        let aside = (self.right * from_middle.x - self.up * from_middle.y) * self.unit;
        if self.perspective {
            (self.eye, (aside - self.back).normalize())
        } else {
            (self.target + aside, -self.back)
        }
    }

    /// How a place of the scene moves with the pointer, at its own distance from the eye: by so many points of the screen.
    /// `None` behind the eye.
    pub fn move_by(&self, place: DVec3, by: DVec2) -> Option<DVec3> {
        Some((self.right * by.x - self.up * by.y) * self.units_per_point(place)?)
    }

    /// Unit vector from a place to the viewer.
    pub fn towards(&self, place: DVec3) -> DVec3 {
        if self.perspective { (self.eye - place).normalize_or(self.back) } else { self.back }
    }

    /// What a direction of the scene is on the screen, y down, without perspective.
    pub fn flat(&self, direction: DVec3) -> DVec2 {
        DVec2::new(direction.dot(self.right), -direction.dot(self.up))
    }

    /// How the point of a line through `place` runs over the screen: `s(t) - s(0) = t·g / (1 - t·b)`, as `(g, b)`. For
    /// parallel rays b is 0.
    pub fn run(&self, place: DVec3, direction: DVec3) -> Option<(DVec2, f64)> {
        let unit = self.units_per_point(place)?;
        let depth = self.depth(place);
        let b = if self.perspective { direction.dot(self.back) / depth } else { 0.0 };
        let from = place - self.eye;
        let g = (self.flat(direction) + self.flat(from) * b) / unit;
        (g.is_finite() && b.is_finite()).then_some((g, b))
    }

    /// Where the line of sight through a point meets the plane through `place` with this unit normal. Where it does not, or
    /// beyond the horizon: what is far away in that direction, straight above the plane, brought down onto it. So the answer
    /// runs on smoothly whatever the pointer does.
    pub fn on_plane(&self, at: DVec2, place: DVec3, normal: DVec3) -> DVec3 {
        let (origin, direction) = self.ray(at);
        let along = (place - origin).dot(normal) / direction.dot(normal);
        let far = self.reach(place);
        let (near, far) = if self.perspective { (0.0, far) } else { (-far, far) };
        let reached = if along.is_finite() && along > near && along < far {
            origin + direction * along
        } else {
            origin + direction * if along < near && !self.perspective { near } else { far }
        };
        reached - normal * (reached - place).dot(normal)
    }

    /// No drag reaches further: many times the height of the picture at `place`, scene units.
    pub fn reach(&self, place: DVec3) -> f64 {
        self.units_per_point(place).unwrap_or(1.0) * self.size.y * 64.0
    }
}
