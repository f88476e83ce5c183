//! Handles of a gizmo: sizes, visibility and hit testing.

use super::axes::{GizmoAxes, GizmoAxis};
use super::view::GizmoView;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Transformation that a gizmo makes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum Tool {
    /// Moves bones.
    Move,
    /// Rotates bones.
    #[default]
    Rotate,
    /// Scales bones.
    Scale,
}

/// A part of a gizmo that can be dragged, and the constraint of the drag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Handle {
    /// Along an axis, or about it.
    Axis(GizmoAxis),
    /// Along both axes other than this one.
    Plane(GizmoAxis),
    /// In the image plane; for rotating, freely like a trackball; for scaling, uniformly.
    Center,
    /// The outer ring: about the line of sight; for scaling, uniformly.
    Ring,
}

/// Start of the arrows, points from the center. All sizes are independent of the distance, the window and the
/// screen's scale.
pub const AXIS_FROM: f64 = 14.0;
/// End of the arrows, points.
pub const AXIS_TO: f64 = 90.0;
/// Nearer and farther edge of the square between two axes, points from the center.
pub const PLANE: [f64; 2] = [26.0, 44.0];
/// Radius of the center, points.
pub const CENTER: f64 = 9.0;
/// Radius of the rings about the axes, points.
pub const RING: f64 = 78.0;
/// Radius of the outer ring, points.
pub const OUTER: f64 = 96.0;
/// Distance at which the pointer still hits a line, points.
pub const REACH: f64 = 7.0;

/// Cosine above which an axis pointing at the viewer is hidden: it would be a dot over the center.
const AXIS_HIDDEN: f64 = 0.985;
/// Sine below which a square seen edge-on is hidden.
const PLANE_HIDDEN: f64 = 0.17;
/// Number of segments that a ring is drawn and tested with.
pub(super) const PIECES: usize = 64;

/// A gizmo as laid out on the screen: everything needed to draw it and to test what is under the pointer.
#[derive(Clone, Copy, Debug)]
pub struct GizmoLayout {
    /// The camera and the size of the viewport.
    pub view: GizmoView,
    /// The origin of the gizmo, scene space.
    pub pivot: DVec3,
    /// The axes of the gizmo, scene space.
    pub axes: GizmoAxes,
    /// Scene units per logical point at the pivot.
    pub unit: f64,
}

impl GizmoLayout {
    /// Returns `None` where the pivot is behind the camera or not finite.
    pub fn new(view: GizmoView, pivot: DVec3, axes: GizmoAxes) -> Option<Self> {
        let unit = view.units_per_point(pivot).filter(|_| pivot.is_finite())?;
        Some(Self { view, pivot, axes, unit })
    }

    /// Returns the position at these distances along the axes, points from the center.
    pub fn place(&self, along: DVec3) -> DVec3 {
        self.pivot + self.axes.axes * along * self.unit
    }

    /// Returns whether `tool` shows a handle. Handles seen end-on or edge-on are hidden.
    pub fn shows(&self, tool: Tool, handle: Handle) -> bool {
        let towards = self.view.towards(self.pivot);
        match (tool, handle) {
            (Tool::Rotate, Handle::Plane(_)) | (Tool::Move, Handle::Ring) => false,
            (Tool::Rotate, _) | (_, Handle::Center | Handle::Ring) => true,
            (_, Handle::Axis(axis)) => self.axes.axis(axis).dot(towards).abs() < AXIS_HIDDEN,
            (_, Handle::Plane(axis)) => self.axes.axis(axis).dot(towards).abs() > PLANE_HIDDEN,
        }
    }

    /// Returns the corners of the square between the two axes other than `normal`.
    pub fn square(&self, normal: GizmoAxis) -> [DVec3; 4] {
        let [a, b] = normal.others().map(GizmoAxis::unit);
        let [near, far] = PLANE;
        [(near, near), (far, near), (far, far), (near, far)].map(|(x, y)| self.place(a * x + b * y))
    }

    /// Returns a point of the ring about an axis, at `share` of a turn from the first of the two other axes.
    pub fn on_ring(&self, axis: GizmoAxis, share: f64) -> DVec3 {
        let [a, b] = axis.others().map(GizmoAxis::unit);
        let (sin, cos) = (share * TAU).sin_cos();
        self.place((a * cos + b * sin) * RING)
    }

    /// Returns whether a position on a ring is on the half towards the viewer. A ring seen along its axis is entirely
    /// visible.
    pub fn in_front(&self, place: DVec3) -> bool {
        (place - self.pivot).dot(self.view.towards(self.pivot)) >= -0.12 * RING * self.unit
    }

    /// Returns the handle under the pointer: lines and rings before squares, squares before the center; of several
    /// lines the nearest.
    pub fn hit(&self, tool: Tool, pointer: DVec2) -> Option<Handle> {
        let middle = self.view.to_screen(self.pivot)?;
        let mut nearest: Option<(f64, Handle)> = None;
        let mut offer = |distance: f64, handle: Handle| {
            if distance <= REACH && nearest.is_none_or(|(best, _)| distance < best) {
                nearest = Some((distance, handle));
            }
        };
        for axis in GizmoAxis::ALL {
            let handle = Handle::Axis(axis);
            if self.shows(tool, handle) {
                let distance = match tool {
                    Tool::Rotate => self.distance_to_ring(axis, pointer),
                    Tool::Move | Tool::Scale => self.distance_to_arrow(axis, middle, pointer),
                };
                offer(distance, handle);
            }
        }
        if self.shows(tool, Handle::Ring) {
            offer((pointer.distance(middle) - OUTER).abs(), Handle::Ring);
        }
        if let Some((_, handle)) = nearest {
            return Some(handle);
        }
        let on_square = |axis: &GizmoAxis| {
            self.shows(tool, Handle::Plane(*axis))
                && is_inside(self.square(*axis).map(|corner| self.view.to_screen(corner)), pointer)
        };
        if let Some(axis) = GizmoAxis::ALL.into_iter().find(on_square) {
            return Some(Handle::Plane(axis));
        }
        let radius = if tool == Tool::Rotate { RING } else { CENTER };
        (pointer.distance(middle) <= radius).then_some(Handle::Center)
    }

    /// Distance to the part of an arrow outside the center, so that the center can always be hit.
    fn distance_to_arrow(&self, axis: GizmoAxis, middle: DVec2, pointer: DVec2) -> f64 {
        let Some(tip) = self.view.to_screen(self.place(axis.unit() * AXIS_TO)) else { return f64::INFINITY };
        let along = tip - middle;
        let length = along.length();
        if length <= AXIS_FROM {
            return f64::INFINITY;
        }
        to_segment(pointer, middle + along * (AXIS_FROM / length), tip)
    }

    fn distance_to_line(&self, from: DVec3, to: DVec3, pointer: DVec2) -> f64 {
        match (self.view.to_screen(from), self.view.to_screen(to)) {
            (Some(from), Some(to)) => to_segment(pointer, from, to),
            _ => f64::INFINITY,
        }
    }

    fn distance_to_ring(&self, axis: GizmoAxis, pointer: DVec2) -> f64 {
        let piece = |index: usize| {
            let [from, to] = [index, index + 1].map(|end| self.on_ring(axis, end as f64 / PIECES as f64));
            let seen = self.in_front(from) && self.in_front(to);
            if seen { self.distance_to_line(from, to, pointer) } else { f64::INFINITY }
        };
        (0..PIECES).map(piece).fold(f64::INFINITY, f64::min)
    }
}

fn to_segment(point: DVec2, from: DVec2, to: DVec2) -> f64 {
    let along = to - from;
    let square = along.length_squared();
    let share = if square > 0.0 { ((point - from).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    point.distance(from + along * share)
}

/// Returns whether a point is inside a quadrilateral with either winding.
fn is_inside(corners: [Option<DVec2>; 4], point: DVec2) -> bool {
    let [Some(a), Some(b), Some(c), Some(d)] = corners else { return false };
    let side = |from: DVec2, to: DVec2| (to - from).perp_dot(point - from);
    let sides = [side(a, b), side(b, c), side(c, d), side(d, a)];
    sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
}
