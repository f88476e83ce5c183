//! The viewport of a gizmo: conversion between screen and scene in `f64`, so that a drag keeps its precision far from
//! the origin.

use crate::camera::{Camera, Projection};
use glam::{DVec2, DVec3, Vec2};

/// Distance from the target at which orthographic lines of sight start, in distances of the camera from it.
const ORTHOGRAPHIC_START: f64 = 100.0;

/// A camera and the size of the viewport. Screen positions are in points from its top left, y down.
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
    /// Scene units that a point covers: at distance 1 in a perspective view, at any distance in an orthographic one.
    unit: f64,
    /// The size of the viewport, logical points.
    pub size: DVec2,
}

impl GizmoView {
    /// The view of a viewport of `size` points.
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

    /// The view of a viewport of this size in pixels.
    pub fn of_pixels(camera: &Camera, pixels: Vec2, pixels_per_point: f32) -> Self {
        let scale = if pixels_per_point > 0.0 { pixels_per_point } else { 1.0 };
        Self::new(camera, pixels / scale)
    }

    /// Distance in front of the camera, along the line of sight. Always 1 in an orthographic view.
    pub fn depth(&self, place: DVec3) -> f64 {
        if self.perspective { (self.eye - place).dot(self.back) } else { 1.0 }
    }

    /// Scene units that a point of the screen covers at `place`; `None` behind the camera.
    pub fn units_per_point(&self, place: DVec3) -> Option<f64> {
        let unit = self.unit * self.depth(place);
        (unit > 0.0 && unit.is_finite()).then_some(unit)
    }

    /// Position of `place` on the screen; `None` behind the camera.
    pub fn to_screen(&self, place: DVec3) -> Option<DVec2> {
        let unit = self.units_per_point(place)?;
        let from = place - if self.perspective { self.eye } else { self.target };
        let at = DVec2::new(from.dot(self.right), -from.dot(self.up)) / unit + self.size / 2.0;
        at.is_finite().then_some(at)
    }

    /// The line of sight through a screen position: where it starts, and its unit direction away from the viewer. An orthographic one starts far in
    /// front of the target, so that everything between it and the viewer is on it.
    pub fn ray(&self, at: DVec2) -> (DVec3, DVec3) {
        let (origin, direction) = self.ray_from_target(at);
        let distance = if self.perspective { 0.0 } else { (self.eye - self.target).dot(self.back) };
        (origin + self.back * (distance * ORTHOGRAPHIC_START), direction)
    }

    /// The line of sight through a screen position: from the eye, or from the plane of the target in an orthographic view.
    fn ray_from_target(&self, at: DVec2) -> (DVec3, DVec3) {
        let from_middle = at - self.size / 2.0;
        let aside = (self.right * from_middle.x - self.up * from_middle.y) * self.unit;
        if self.perspective {
            (self.eye, (aside - self.back).normalize())
        } else {
            (self.target + aside, -self.back)
        }
    }

    /// The movement in the scene, at the distance of `place`, that corresponds to a movement of `by` points on the
    /// screen. `None` behind the camera.
    pub fn move_by(&self, place: DVec3, by: DVec2) -> Option<DVec3> {
        Some((self.right * by.x - self.up * by.y) * self.units_per_point(place)?)
    }

    /// Unit vector from `place` to the viewer.
    pub fn towards(&self, place: DVec3) -> DVec3 {
        if self.perspective { (self.eye - place).normalize_or(self.back) } else { self.back }
    }

    /// A direction of the scene on the screen, y down, without perspective.
    pub fn flat(&self, direction: DVec3) -> DVec2 {
        DVec2::new(direction.dot(self.right), -direction.dot(self.up))
    }

    /// The motion on the screen of a point on a line through `place`: `s(t) - s(0) = t·g / (1 - t·b)`, returned as
    /// `(g, b)`. For parallel rays b is 0.
    pub fn run(&self, place: DVec3, direction: DVec3) -> Option<(DVec2, f64)> {
        let unit = self.units_per_point(place)?;
        let depth = self.depth(place);
        let b = if self.perspective { direction.dot(self.back) / depth } else { 0.0 };
        let from = place - self.eye;
        let g = (self.flat(direction) + self.flat(from) * b) / unit;
        (g.is_finite() && b.is_finite()).then_some((g, b))
    }

    /// Intersects the line of sight through `at` with the plane through `place` with this unit normal. Where they do
    /// not meet, or beyond the horizon, returns a distant point in that direction, projected onto the plane, so that
    /// the result is continuous for any movement of the pointer.
    pub fn on_plane(&self, at: DVec2, place: DVec3, normal: DVec3) -> DVec3 {
        let (origin, direction) = self.ray_from_target(at);
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

    /// Longest distance of a drag: many times the height of the view at `place`, scene units.
    pub fn reach(&self, place: DVec3) -> f64 {
        self.units_per_point(place).unwrap_or(1.0) * self.size.y * 64.0
    }
}
