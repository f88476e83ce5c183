//! What of a gizmo can be taken hold of, how large it is, and what lies under the pointer.

use super::axes::{Axis, GizmoAxes};
use super::view::GizmoView;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// What a gizmo does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum Tool {
    /// Moves.
    Move,
    /// Rotates.
    #[default]
    Rotate,
    /// Scales.
    Scale,
}

/// A part of a gizmo that can be dragged, and the way a drag is bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Handle {
    /// Along an axis, or about it.
    Axis(Axis),
    /// Along both axes but this one.
    Plane(Axis),
    /// In the plane of the picture; rotating freely, as a ball; scaling evenly.
    Centre,
    /// The outer ring: about the line of sight; scaling evenly.
    Ring,
}

/// Lengths of handles, points. They are as large at every distance, size of window and scale of the screen.
pub const AXIS_FROM: f64 = 14.0;
/// Where arrows end, points.
pub const AXIS_TO: f64 = 90.0;
/// Nearer and farther edge of a square between two axes, points from the middle.
pub const PLANE: [f64; 2] = [26.0, 44.0];
/// Radius of the middle, points.
pub const CENTRE: f64 = 9.0;
/// Radius of the rings about the axes, points.
pub const RING: f64 = 78.0;
/// Radius of the outer ring, points.
pub const OUTER: f64 = 96.0;
/// The pointer may miss a line by so much, points.
pub const REACH: f64 = 7.0;

/// An axis that points at the viewer more than this, as a cosine, is not shown: it would be a dot over the middle.
const AXIS_HIDDEN: f64 = 0.985;
/// A square seen flatter than this, as a sine, is not shown.
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

    /// A place so many points from the middle along the axes.
    pub fn place(&self, along: DVec3) -> DVec3 {
        self.pivot + self.axes.axes * along * self.unit
    }

    /// Is a handle of `tool` there? Not what is seen end on or edge on.
    pub fn shows(&self, tool: Tool, handle: Handle) -> bool {
        let towards = self.view.towards(self.pivot);
        match (tool, handle) {
            (Tool::Rotate, Handle::Plane(_)) | (Tool::Move, Handle::Ring) => false,
            (Tool::Rotate, _) | (_, Handle::Centre | Handle::Ring) => true,
            (_, Handle::Axis(axis)) => self.axes.axis(axis).dot(towards).abs() < AXIS_HIDDEN,
            (_, Handle::Plane(axis)) => self.axes.axis(axis).dot(towards).abs() > PLANE_HIDDEN,
        }
    }

    /// The corners of a square between two axes.
    pub fn square(&self, normal: Axis) -> [DVec3; 4] {
        let [a, b] = normal.others().map(Axis::unit);
        let [near, far] = PLANE;
        [(near, near), (far, near), (far, far), (near, far)].map(|(x, y)| self.place(a * x + b * y))
    }

    /// A point of the ring about an axis, at `share` of a turn from the first of the two other axes.
    pub fn on_ring(&self, axis: Axis, share: f64) -> DVec3 {
        let [a, b] = axis.others().map(Axis::unit);
        let (sin, cos) = (share * TAU).sin_cos();
        self.place((a * cos + b * sin) * RING)
    }

    /// Does a place of a ring lie on the half towards the viewer? All of a ring seen from its axis does.
    pub fn in_front(&self, place: DVec3) -> bool {
        (place - self.pivot).dot(self.view.towards(self.pivot)) >= -0.12 * RING * self.unit
    }

    /// The handle under the pointer: lines and rings before squares, those before the middle; of lines the nearest.
    pub fn hit(&self, tool: Tool, pointer: DVec2) -> Option<Handle> {
        let middle = self.view.to_screen(self.pivot)?;
        let mut nearest: Option<(f64, Handle)> = None;
        let mut offer = |distance: f64, handle: Handle| {
            if distance <= REACH && nearest.is_none_or(|(best, _)| distance < best) {
                nearest = Some((distance, handle));
            }
        };
        for axis in Axis::ALL {
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
        let on_square = |axis: &Axis| {
            self.shows(tool, Handle::Plane(*axis))
                && is_inside(self.square(*axis).map(|corner| self.view.to_screen(corner)), pointer)
        };
        if let Some(axis) = Axis::ALL.into_iter().find(on_square) {
            return Some(Handle::Plane(axis));
        }
        let radius = if tool == Tool::Rotate { RING } else { CENTRE };
        (pointer.distance(middle) <= radius).then_some(Handle::Centre)
    }

    /// To the part of an arrow that is not over the middle, so that the middle can always be met.
    fn distance_to_arrow(&self, axis: Axis, middle: DVec2, pointer: DVec2) -> f64 {
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

    fn distance_to_ring(&self, axis: Axis, pointer: DVec2) -> f64 {
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

/// Is a point inside of four corners, whichever way round they run?
fn is_inside(corners: [Option<DVec2>; 4], point: DVec2) -> bool {
    let [Some(a), Some(b), Some(c), Some(d)] = corners else { return false };
    let side = |from: DVec2, to: DVec2| (to - from).perp_dot(point - from);
    let sides = [side(a, b), side(b, c), side(c, d), side(d, a)];
    sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
}
