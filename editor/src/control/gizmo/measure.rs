//! Converts the position of the pointer into an amount of translation, rotation or scale.
//!
//! A measurement begins with a drag, where its amount is 0. Each kind has an amount for every pointer position, and changes
//! continuously:
//!
//! * *Along an axis*: the point on the axis that is drawn nearest to the pointer. Beyond the vanishing point of the axis the
//!   amount stays at the largest one. An axis that points at the viewer has no length on the screen to follow: then moving
//!   the pointer up by one point moves by the size of a point at the pivot.
//! * *In a plane*: where the line of sight meets it. For a plane seen edge on: the movement of the pointer in the view plane,
//!   without its component across the plane.
//! * *About an axis*: the angle about it of the point where the line of sight meets the plane of the ring, with turns
//!   counted. For a ring seen edge on, its near side follows the pointer as if it were a wheel.
//! * *Scale*: the ratio of the distances from the center; along an axis the signed one, so that it can mirror. Too near to
//!   the center to divide by the distance, right and up enlarge.

use dragonfly_picture::between;
use dragonfly_picture::gizmo::{AXIS_TO, GizmoAxis, GizmoLayout, Handle, RING, Tool};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Sine below which an axis points at the viewer, or a plane is seen edge on.
const FLAT: f64 = 0.1;
/// Sine below which a ring is seen edge on.
const RING_FLAT: f64 = 0.15;
/// Distance from the center below which no ratio is formed, points.
const NEAREST: f64 = 20.0;
/// Distance from the center below which there is no angle, points.
const NO_ANGLE: f64 = 1.0;

/// How the pointer is converted into an amount.
#[derive(Clone, Copy, Debug)]
enum MeasureKind {
    /// `t = σ / (a + σ·b)` for a pointer σ points along the axis on the screen.
    Line { from: DVec2, along: DVec2, a: f64, b: f64, reach: f64 },
    /// By the upward movement of the pointer, for an axis that points at the viewer.
    Up { unit: f64 },
    /// In a plane with this normal, with the pointer shifted by an offset.
    Plane { normal: DVec3, shift: DVec2 },
    /// In a plane seen edge on.
    Edge { normal: DVec3, unit: f64 },
    /// By the angle between two directions in the plane of the ring.
    Ring { normal: DVec3, sign: f64, zero: DVec3, last: Option<f64>, total: f64 },
    /// Along the near side of a ring seen edge on, as if it were a wheel.
    Wheel { along: DVec2, sign: f64 },
    /// By the movement of the pointer, as with a trackball.
    Ball,
    /// By the ratio of the distances from the center, now and at the start.
    Ratio { middle: DVec2, start: f64 },
    /// By the movement of the pointer to the right and up.
    Slide,
}

/// Converts pointer positions into amounts. Amounts are along the axes of the gizmo: scene units for moving; radians in
/// x for rotating, in x and y for free rotation (about the vertical and the horizontal line of the view); factor minus
/// 1 in x for scaling.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measure {
    kind: MeasureKind,
    layout: GizmoLayout,
    start: DVec2,
    /// Raw amount at the start.
    zero: DVec3,
    /// Whether the amount is a ratio to [`Self::zero`].
    is_ratio: bool,
}

impl Measure {
    /// Begins a measurement of a drag of `handle` at `start`. `grabbed` is whether the handle itself was under the
    /// pointer, so that its axis can be followed with its sign.
    pub(super) fn new(tool: Tool, handle: Handle, layout: GizmoLayout, start: DVec2, grabbed: bool) -> Self {
        let kind = match tool {
            Tool::Move => translation(handle, &layout, start, grabbed),
            Tool::Rotate => rotation(handle, &layout),
            Tool::Scale => scale(handle, &layout, start, grabbed),
        };
        let is_ratio = tool == Tool::Scale && matches!(kind, MeasureKind::Line { .. });
        let mut measure = Self { kind, layout, start, zero: DVec3::ZERO, is_ratio };
        measure.zero = measure.raw(start);
        // Too near to the center to divide by the distance.
        if is_ratio && measure.zero.x.abs() < NEAREST * layout.unit {
            measure.kind = distance(&layout, start);
            measure.is_ratio = false;
            measure.zero = measure.raw(start);
        }
        measure
    }

    /// Returns the amount for a pointer position. Rings count turns, so they must get the positions in between.
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
            MeasureKind::Line { from, along, a, b, reach } => {
                let way = (pointer - *from).dot(*along);
                let divisor = *a + way * *b;
                let t = if divisor > 0.0 { way / divisor } else { f64::INFINITY * way.signum() };
                DVec3::X * between(t, -*reach, *reach)
            }
            MeasureKind::Up { unit } => DVec3::X * (-by.y * *unit),
            MeasureKind::Plane { normal, shift } => {
                to_axes * (view.on_plane(pointer + *shift, pivot, *normal) - pivot)
            }
            MeasureKind::Edge { normal, unit } => {
                let way = (view.right * by.x - view.up * by.y) * *unit;
                to_axes * (way - *normal * way.dot(*normal))
            }
            MeasureKind::Ring { normal, sign, zero, last, total } => {
                let from = view.on_plane(pointer, pivot, *normal) - pivot;
                if from.length() > NO_ANGLE * unit {
                    let angle = libm::atan2(from.dot(normal.cross(*zero)), from.dot(*zero));
                    let turned = angle - last.unwrap_or(angle);
                    // Of the two directions of rotation, the shorter one counts.
                    *total += turned - TAU * (turned / TAU).round();
                    *last = Some(angle);
                }
                DVec3::X * (*total * *sign)
            }
            MeasureKind::Wheel { along, sign } => DVec3::X * (by.dot(*along) / RING * *sign),
            MeasureKind::Ball => DVec3::new(by.x, by.y, 0.0) / RING,
            MeasureKind::Ratio { middle, start } => DVec3::X * (pointer.distance(*middle) / *start - 1.0),
            MeasureKind::Slide => DVec3::X * ((by.x - by.y) / AXIS_TO),
        }
    }
}

/// Along an axis. If a key began the drag with the pointer elsewhere, that position counts as the joint: the pointer
/// may be past the vanishing point of the axis, where nothing would follow it.
fn axis_line(axis: GizmoAxis, layout: &GizmoLayout, start: DVec2, grabbed: bool) -> MeasureKind {
    let GizmoLayout { view, pivot, unit, axes: frame } = layout;
    let along = frame.axis(axis);
    if let (Some((g, b)), Some(joint)) = (view.run(*pivot, along), view.to_screen(*pivot)) {
        let a = g.length();
        // Points per unit, times units per point: the sine of the angle to the line of sight.
        if a * unit > FLAT {
            let along = g / a;
            let way = (start - joint).dot(along);
            let is_on_it = grabbed && way.abs() < AXIS_TO * 2.0 && a + way * b > a * 0.3;
            let from = if is_on_it { joint } else { joint + along * way };
            return MeasureKind::Line { from, along, a, b, reach: view.reach(*pivot) };
        }
    }
    MeasureKind::Up { unit: *unit }
}

fn translation(handle: Handle, layout: &GizmoLayout, start: DVec2, grabbed: bool) -> MeasureKind {
    match handle {
        Handle::Axis(axis) => axis_line(axis, layout, start, grabbed),
        Handle::Plane(axis) => {
            let normal = layout.axes.axis(axis);
            if normal.dot(layout.view.towards(layout.pivot)).abs() > FLAT {
                // If a key began the drag, the pointer may be beyond the horizon: as for axes.
                let joint = layout.view.to_screen(layout.pivot).filter(|_| !grabbed);
                MeasureKind::Plane { normal, shift: joint.map_or(DVec2::ZERO, |joint| joint - start) }
            } else {
                MeasureKind::Edge { normal, unit: layout.unit }
            }
        }
        Handle::Center | Handle::Ring => MeasureKind::Plane { normal: layout.view.back, shift: DVec2::ZERO },
    }
}

fn rotation(handle: Handle, layout: &GizmoLayout) -> MeasureKind {
    let view = &layout.view;
    // Angles about an axis of the gizmo are measured in its axes, which run the other way if they are mirrored; angles
    // about the line of sight are measured in the axes of the world.
    let (normal, sign) = match handle {
        Handle::Axis(axis) | Handle::Plane(axis) => (layout.axes.axis(axis), layout.axes.sign),
        Handle::Ring => (view.back, 1.0),
        Handle::Center => return MeasureKind::Ball,
    };
    let towards = view.towards(layout.pivot);
    if normal.dot(towards).abs() > RING_FLAT {
        return MeasureKind::Ring {
            normal,
            sign,
            zero: normal.any_orthonormal_vector(),
            last: None,
            total: 0.0,
        };
    }
    let along = view.flat(normal.cross(towards)).normalize_or(DVec2::X);
    MeasureKind::Wheel { along, sign }
}

fn scale(handle: Handle, layout: &GizmoLayout, start: DVec2, grabbed: bool) -> MeasureKind {
    match handle {
        Handle::Axis(axis) if grabbed => match axis_line(axis, layout, start, true) {
            line @ MeasureKind::Line { .. } => line,
            _ => MeasureKind::Slide,
        },
        _ => distance(layout, start),
    }
}

fn distance(layout: &GizmoLayout, start: DVec2) -> MeasureKind {
    let middle = layout.view.to_screen(layout.pivot).unwrap_or(start);
    let distance = start.distance(middle);
    if distance < NEAREST { MeasureKind::Slide } else { MeasureKind::Ratio { middle, start: distance } }
}
