//! From where the pointer is to how much is moved, turned or scaled.
//!
//! A measure is made where the drag begins and answers 0 there. Each has an answer for every pointer and runs on smoothly:
//!
//! * *Along an axis*: the place on the axis that is drawn nearest to the pointer. Past the point where the axis vanishes in
//!   perspective it stays at the farthest. An axis that points at the viewer has no length on the screen to follow: then
//!   the pointer going up by a point moves by what a point covers.
//! * *In a plane*: where the line of sight meets it. A plane seen edge on: what the pointer does in the plane of the
//!   picture, without the part across.
//! * *About an axis*: the angle about it of where the line of sight meets the plane of the ring, turns counted. A ring seen
//!   edge on: its near side follows the pointer as if it were a wheel.
//! * *Scaling*: the ratio of the distances from the middle; along an axis the signed one, so it can mirror. Too near to the
//!   middle to divide by, right and up enlarge.

use dragonfly_picture::gizmo::{AXIS_TO, GizmoAxis, GizmoLayout, Handle, RING, Tool};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Below this, as a sine, an axis points at the viewer, a plane is seen edge on.
const FLAT: f64 = 0.1;
/// Below this, as a sine, a ring is seen edge on.
const RING_FLAT: f64 = 0.15;
/// Nearer to the middle than this, points, no ratio is formed.
const NEAREST: f64 = 20.0;
/// Nearer to the middle than this, points, there is no angle.
const NO_ANGLE: f64 = 1.0;

/// How pointers are turned into amounts.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// `t = σ / (a + σ·b)` for a pointer σ points along the axis on the screen.
    Line { from: DVec2, along: DVec2, a: f64, b: f64, reach: f64 },
    /// By the pointer's way up.
    Up { unit: f64 },
    /// Of a plane with this normal, for a pointer shifted by so much.
    Plane { normal: DVec3, shift: DVec2 },
    /// Of a plane seen edge on.
    Edge { normal: DVec3, unit: f64 },
    /// From one direction to another in the plane of the ring.
    Ring { normal: DVec3, sign: f64, zero: DVec3, last: Option<f64>, total: f64 },
    /// As a wheel seen from its rim.
    Wheel { along: DVec2, sign: f64 },
    /// As a ball.
    Ball,
    /// Distance from the middle over that at the start.
    Ratio { middle: DVec2, start: f64 },
    /// By the pointer's way right and up.
    Slide,
}

/// See the module. Amounts are along the axes of the gizmo: scene units for moving; radians in x for turning, in x and y for
/// turning freely (about the line up and the line to the right); factor less 1 in x for scaling.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measure {
    kind: Kind,
    layout: GizmoLayout,
    start: DVec2,
    /// What the kind answers at the start.
    zero: DVec3,
    /// Is the amount a ratio with [`Self::zero`]?
    is_ratio: bool,
}

impl Measure {
    /// A drag of `handle` that began at `start`. `grabbed`: was the handle itself under the pointer, so that its axis can be
    /// followed by sign?
    pub(super) fn new(tool: Tool, handle: Handle, layout: GizmoLayout, start: DVec2, grabbed: bool) -> Self {
        let kind = match tool {
            Tool::Move => translation(handle, &layout, start, grabbed),
            Tool::Rotate => rotation(handle, &layout),
            Tool::Scale => scale(handle, &layout, start, grabbed),
        };
        let is_ratio = tool == Tool::Scale && matches!(kind, Kind::Line { .. });
        let mut measure = Self { kind, layout, start, zero: DVec3::ZERO, is_ratio };
        measure.zero = measure.raw(start);
        // Too near to divide by.
        if is_ratio && measure.zero.x.abs() < NEAREST * layout.unit {
            measure.kind = distance(&layout, start);
            measure.is_ratio = false;
            measure.zero = measure.raw(start);
        }
        measure
    }

    /// The amount for a pointer. For rings it counts turns, so it must see the pointer on its way.
    pub(super) fn at(&mut self, pointer: DVec2) -> DVec3 {
        let raw = self.raw(pointer);
        let amount = if self.is_ratio { DVec3::X * (raw.x / self.zero.x - 1.0) } else { raw - self.zero };
        if amount.is_finite() { amount } else { DVec3::ZERO }
    }

    fn raw(&mut self, pointer: DVec2) -> DVec3 {
        let GizmoLayout { view, pivot, axes: frame, unit } = self.layout;
        let by = pointer - self.start;
        let to_axes = frame.axes.transpose();
        match &mut self.kind {
            Kind::Line { from, along, a, b, reach } => {
                let way = (pointer - *from).dot(*along);
                let divisor = *a + way * *b;
                let t = if divisor > 0.0 { way / divisor } else { f64::INFINITY * way.signum() };
                DVec3::X * t.clamp(-*reach, *reach)
            }
            Kind::Up { unit } => DVec3::X * (-by.y * *unit),
            Kind::Plane { normal, shift } => {
                to_axes * (view.on_plane(pointer + *shift, pivot, *normal) - pivot)
            }
            Kind::Edge { normal, unit } => {
                let way = (view.right * by.x - view.up * by.y) * *unit;
                to_axes * (way - *normal * way.dot(*normal))
            }
            Kind::Ring { normal, sign, zero, last, total } => {
                let from = view.on_plane(pointer, pivot, *normal) - pivot;
                if from.length() > NO_ANGLE * unit {
                    let angle = from.dot(normal.cross(*zero)).atan2(from.dot(*zero));
                    let turned = angle - last.unwrap_or(angle);
                    // The short way round.
                    *total += turned - TAU * (turned / TAU).round();
                    *last = Some(angle);
                }
                DVec3::X * (*total * *sign)
            }
            Kind::Wheel { along, sign } => DVec3::X * (by.dot(*along) / RING * *sign),
            Kind::Ball => DVec3::new(by.x, by.y, 0.0) / RING,
            Kind::Ratio { middle, start } => DVec3::X * (pointer.distance(*middle) / *start - 1.0),
            Kind::Slide => DVec3::X * ((by.x - by.y) / AXIS_TO),
        }
    }
}

/// Along an axis. Where the pointer began away from it, taken hold of by a key, that place counts as the joint's: the pointer
/// may be past the point where the axis vanishes, and nothing would follow it there.
fn axis_line(axis: GizmoAxis, layout: &GizmoLayout, start: DVec2, grabbed: bool) -> Kind {
    let GizmoLayout { view, pivot, unit, axes: frame } = layout;
    let along = frame.axis(axis);
    if let (Some((g, b)), Some(joint)) = (view.run(*pivot, along), view.to_screen(*pivot)) {
        let a = g.length();
        // Points a unit, times units a point: the sine of the angle to the line of sight.
        if a * unit > FLAT {
            let along = g / a;
            let way = (start - joint).dot(along);
            let is_on_it = grabbed && way.abs() < AXIS_TO * 2.0 && a + way * b > a * 0.3;
            let from = if is_on_it { joint } else { joint + along * way };
            return Kind::Line { from, along, a, b, reach: view.reach(*pivot) };
        }
    }
    Kind::Up { unit: *unit }
}

fn translation(handle: Handle, layout: &GizmoLayout, start: DVec2, grabbed: bool) -> Kind {
    match handle {
        Handle::Axis(axis) => axis_line(axis, layout, start, grabbed),
        Handle::Plane(axis) => {
            let normal = layout.axes.axis(axis);
            if normal.dot(layout.view.towards(layout.pivot)).abs() > FLAT {
                // Taken hold of by a key, the pointer may be beyond the horizon: as for axes.
                let joint = layout.view.to_screen(layout.pivot).filter(|_| !grabbed);
                Kind::Plane { normal, shift: joint.map_or(DVec2::ZERO, |joint| joint - start) }
            } else {
                Kind::Edge { normal, unit: layout.unit }
            }
        }
        Handle::Center | Handle::Ring => Kind::Plane { normal: layout.view.back, shift: DVec2::ZERO },
    }
}

fn rotation(handle: Handle, layout: &GizmoLayout) -> Kind {
    let view = &layout.view;
    // About an axis of the gizmo the angle is one in its axes, which run the other way where they are mirrored; the line of
    // sight is the world's.
    let (normal, sign) = match handle {
        Handle::Axis(axis) | Handle::Plane(axis) => (layout.axes.axis(axis), layout.axes.sign),
        Handle::Ring => (view.back, 1.0),
        Handle::Center => return Kind::Ball,
    };
    let towards = view.towards(layout.pivot);
    if normal.dot(towards).abs() > RING_FLAT {
        return Kind::Ring { normal, sign, zero: normal.any_orthonormal_vector(), last: None, total: 0.0 };
    }
    let along = view.flat(normal.cross(towards)).normalize_or(DVec2::X);
    Kind::Wheel { along, sign }
}

fn scale(handle: Handle, layout: &GizmoLayout, start: DVec2, grabbed: bool) -> Kind {
    match handle {
        Handle::Axis(axis) if grabbed => match axis_line(axis, layout, start, true) {
            line @ Kind::Line { .. } => line,
            _ => Kind::Slide,
        },
        _ => distance(layout, start),
    }
}

fn distance(layout: &GizmoLayout, start: DVec2) -> Kind {
    let middle = layout.view.to_screen(layout.pivot).unwrap_or(start);
    let distance = start.distance(middle);
    if distance < NEAREST { Kind::Slide } else { Kind::Ratio { middle, start: distance } }
}
