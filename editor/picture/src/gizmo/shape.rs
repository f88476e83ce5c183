//! What a gizmo looks like, as lists of lines and triangles for a pass to draw.

use super::axes::Axis;
use super::delta::GizmoDelta;
use super::handle::{AXIS_FROM, AXIS_TO, CENTRE, GizmoLayout, Handle, OUTER, PIECES, RING, Tool};
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::TAU;

/// Which colour a part has; the theme says which.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum GizmoRole {
    /// Of the x axis.
    X = 0,
    /// Of the y axis.
    Y = 1,
    /// Of the z axis.
    Z = 2,
    /// Of the plane and the line of the picture, and of what is even.
    View = 3,
    /// Under the pointer.
    Hover = 4,
    /// Being dragged.
    Active = 5,
    /// What was before the time shown.
    Past = 6,
    /// What comes after it.
    Future = 7,
}

impl GizmoRole {
    fn of(axis: Axis) -> Self {
        [Self::X, Self::Y, Self::Z][axis as usize]
    }
}

/// A corner of a line or a triangle.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct GizmoVertex {
    /// Scene space.
    pub position: Vec3,
    /// A [`GizmoRole`].
    pub role: u32,
    /// 0 to 1.
    pub opacity: f32,
}

/// Lists that keep their memory from frame to frame.
#[derive(Clone, Debug, Default)]
pub struct GizmoShape {
    lines: Vec<GizmoVertex>,
    triangles: Vec<GizmoVertex>,
}

/// Sides of a cone or a disc.
const SIDES: usize = 12;
/// Points that a guide along a bound axis reaches to either side.
const GUIDE: f64 = 4000.0;

impl GizmoShape {
    /// Two corners a line.
    pub fn lines(&self) -> &[GizmoVertex] {
        &self.lines
    }

    /// Three corners a triangle; either side may be seen.
    pub fn triangles(&self) -> &[GizmoVertex] {
        &self.triangles
    }

    /// Nothing, with the memory kept.
    pub fn clear(&mut self) {
        self.lines.clear();
        self.triangles.clear();
    }

    /// A line from place to place, scene space; opacity 0 to 1.
    pub fn add_line(&mut self, from: Vec3, to: Vec3, role: GizmoRole, opacity: f32) {
        self.lines.extend([from, to].map(|position| GizmoVertex { position, role: role as u32, opacity }));
    }

    /// A square that stands on its corner, in the plane of the picture: `right` and `up` reach to its corners.
    pub fn add_diamond(&mut self, at: Vec3, right: Vec3, up: Vec3, role: GizmoRole, opacity: f32) {
        let [a, b, c, d] = [at + up, at + right, at - up, at - right];
        let corner = |position| GizmoVertex { position, role: role as u32, opacity };
        self.triangles.extend([a, b, c, a, c, d].map(corner));
    }

    /// All of another one too.
    pub fn extend(&mut self, other: &Self) {
        self.lines.extend_from_slice(&other.lines);
        self.triangles.extend_from_slice(&other.triangles);
    }

    /// All handles.
    pub fn waiting(&mut self, layout: &GizmoLayout, tool: Tool, hovered: Option<Handle>) {
        let role =
            |handle: Handle, role: GizmoRole| if hovered == Some(handle) { GizmoRole::Hover } else { role };
        for axis in Axis::ALL {
            for handle in [Handle::Axis(axis), Handle::Plane(axis)] {
                if layout.shows(tool, handle) {
                    self.handle(layout, tool, handle, role(handle, GizmoRole::of(axis)));
                }
            }
        }
        for handle in [Handle::Centre, Handle::Ring] {
            if layout.shows(tool, handle) {
                self.handle(layout, tool, handle, role(handle, GizmoRole::View));
            }
        }
    }

    /// The handle that is dragged, the line it is bound to, and the angle turned.
    pub fn dragging(
        &mut self,
        layout: &GizmoLayout,
        tool: Tool,
        handle: Handle,
        delta: Option<GizmoDelta>,
        start: DVec2,
    ) {
        match handle {
            Handle::Axis(axis) => self.guide(layout, axis),
            Handle::Plane(normal) => normal.others().into_iter().for_each(|axis| self.guide(layout, axis)),
            Handle::Centre | Handle::Ring => {}
        }
        if layout.shows(tool, handle) {
            self.handle(layout, tool, handle, GizmoRole::Active);
        }
        if let Some(GizmoDelta::Rotate { axis, angle }) = delta {
            self.turned(layout, layout.axes.axes * axis, layout.axes.sign * angle, start);
        }
    }

    fn handle(&mut self, layout: &GizmoLayout, tool: Tool, handle: Handle, role: GizmoRole) {
        match (tool, handle) {
            (Tool::Rotate, Handle::Axis(axis) | Handle::Plane(axis)) => self.ring(layout, axis, role),
            (_, Handle::Axis(axis)) => self.arrow(layout, axis, tool, role),
            (_, Handle::Plane(axis)) => {
                let [a, b, c, d] = layout.square(axis);
                self.triangle([a, b, c], role, 0.35);
                self.triangle([a, c, d], role, 0.35);
                [(a, b), (b, c), (c, d), (d, a)]
                    .into_iter()
                    .for_each(|(from, to)| self.line(from, to, role, 1.0));
            }
            (Tool::Rotate, Handle::Centre) => self.disc(layout, RING, role, 0.06),
            (_, Handle::Centre) => self.disc(layout, CENTRE, role, 0.8),
            (_, Handle::Ring) => {
                let around = |index: usize| facing(layout, OUTER, index as f64 / PIECES as f64);
                (0..PIECES).for_each(|index| self.line(around(index), around(index + 1), role, 1.0));
            }
        }
    }

    /// A line with a cone for moving, with a cube for scaling.
    fn arrow(&mut self, layout: &GizmoLayout, axis: Axis, tool: Tool, role: GizmoRole) {
        let along = axis.unit();
        let [a, b] = axis.others().map(Axis::unit);
        let neck = if tool == Tool::Move { AXIS_TO - 18.0 } else { AXIS_TO - 10.0 };
        self.line(layout.place(along * AXIS_FROM), layout.place(along * neck), role, 1.0);
        if tool == Tool::Move {
            let rim = |index: usize| {
                let (sin, cos) = (index as f64 / SIDES as f64 * TAU).sin_cos();
                layout.place(along * neck + (a * cos + b * sin) * 5.0)
            };
            for index in 0..SIDES {
                self.triangle([rim(index), rim(index + 1), layout.place(along * AXIS_TO)], role, 1.0);
                self.triangle([rim(index + 1), rim(index), layout.place(along * neck)], role, 1.0);
            }
            return;
        }
        let corner =
            |x: f64, y: f64, z: f64| layout.place(along * (AXIS_TO - 5.0 + 5.0 * z) + (a * x + b * y) * 5.0);
        for turn in 0..3 {
            for side in [-1.0, 1.0] {
                let on_face = |u: f64, v: f64| match turn {
                    0 => corner(side, u, v),
                    1 => corner(u, side, v),
                    _ => corner(u, v, side),
                };
                let [p, q, r, s] =
                    [on_face(-1.0, -1.0), on_face(1.0, -1.0), on_face(1.0, 1.0), on_face(-1.0, 1.0)];
                self.triangle([p, q, r], role, 1.0);
                self.triangle([p, r, s], role, 1.0);
            }
        }
    }

    /// The half towards the viewer; what is dragged is shown whole.
    fn ring(&mut self, layout: &GizmoLayout, axis: Axis, role: GizmoRole) {
        for index in 0..PIECES {
            let [from, to] = [index, index + 1].map(|end| layout.on_ring(axis, end as f64 / PIECES as f64));
            let is_front = layout.in_front(from) && layout.in_front(to);
            if is_front || role == GizmoRole::Active {
                self.line(from, to, role, if is_front { 1.0 } else { 0.35 });
            }
        }
    }

    fn disc(&mut self, layout: &GizmoLayout, radius: f64, role: GizmoRole, opacity: f32) {
        // A large one as round as the rings around it.
        let sides = if radius > CENTRE { PIECES } else { SIDES * 2 };
        for index in 0..sides {
            let [from, to] = [index, index + 1].map(|end| facing(layout, radius, end as f64 / sides as f64));
            self.triangle([layout.pivot, from, to], role, opacity);
        }
    }

    fn guide(&mut self, layout: &GizmoLayout, axis: Axis) {
        let [from, to] = [-GUIDE, GUIDE].map(|along| layout.place(axis.unit() * along));
        self.line(from, to, GizmoRole::of(axis), 0.6);
    }

    /// The angle turned as a fan from where it began; a full disc beyond a turn.
    fn turned(&mut self, layout: &GizmoLayout, axis: DVec3, angle: f64, start: DVec2) {
        let Some(axis) = axis.try_normalize() else { return };
        let from = layout.view.on_plane(start, layout.pivot, axis) - layout.pivot;
        let from = (from - axis * from.dot(axis)).normalize_or(axis.any_orthonormal_vector());
        let across = axis.cross(from);
        let radius = RING * layout.unit;
        let angle = angle.clamp(-TAU, TAU);
        let at = |index: usize| {
            let (sin, cos) = (angle * index as f64 / PIECES as f64).sin_cos();
            layout.pivot + (from * cos + across * sin) * radius
        };
        for index in 0..PIECES {
            self.triangle([layout.pivot, at(index), at(index + 1)], GizmoRole::Active, 0.25);
        }
        self.line(layout.pivot, at(0), GizmoRole::Active, 1.0);
        self.line(layout.pivot, at(PIECES), GizmoRole::Active, 1.0);
    }

    fn line(&mut self, from: DVec3, to: DVec3, role: GizmoRole, opacity: f32) {
        self.lines.extend([from, to].map(|place| vertex(place, role, opacity)));
    }

    fn triangle(&mut self, corners: [DVec3; 3], role: GizmoRole, opacity: f32) {
        self.triangles.extend(corners.map(|place| vertex(place, role, opacity)));
    }
}

fn vertex(place: DVec3, role: GizmoRole, opacity: f32) -> GizmoVertex {
    GizmoVertex { position: place.as_vec3(), role: role as u32, opacity }
}

/// A point of a circle in the plane of the picture.
fn facing(layout: &GizmoLayout, radius: f64, share: f64) -> DVec3 {
    let (sin, cos) = (share * TAU).sin_cos();
    layout.pivot + (layout.view.right * cos + layout.view.up * sin) * (radius * layout.unit)
}
