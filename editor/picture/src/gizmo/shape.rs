//! The shape of a gizmo, as lists of lines and triangles for a pass to draw.

use super::axes::GizmoAxis;
use super::delta::GizmoDelta;
use super::handle::{AXIS_FROM, AXIS_TO, CENTER, GizmoLayout, Handle, OUTER, PIECES, RING, Tool};
use super::ink::LineInk;
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::TAU;

/// Role of a part, which determines its color in the theme.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum GizmoRole {
    /// The x axis.
    X = 0,
    /// The y axis.
    Y = 1,
    /// The z axis.
    Z = 2,
    /// The image plane, the line of sight, and uniform scaling.
    View = 3,
    /// The handle under the pointer.
    Hover = 4,
    /// The handle being dragged.
    Active = 5,
    /// Times before the present one.
    Past = 6,
    /// Times after the present one.
    Future = 7,
    /// Selected things, in the accent color of the program.
    Selected = 8,
}

impl GizmoRole {
    /// Number of roles.
    pub const COUNT: usize = 9;
    /// All roles, in the order of their numbers.
    pub const ALL: [Self; Self::COUNT] = [
        Self::X,
        Self::Y,
        Self::Z,
        Self::View,
        Self::Hover,
        Self::Active,
        Self::Past,
        Self::Future,
        Self::Selected,
    ];

    fn of(axis: GizmoAxis) -> Self {
        [Self::X, Self::Y, Self::Z][axis as usize]
    }
}

/// A color for each [`GizmoRole`], linear RGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoleColors([[f32; 3]; GizmoRole::COUNT]);

impl RoleColors {
    /// Asks `color` for the color of each role.
    pub fn new(color: impl FnMut(GizmoRole) -> [f32; 3]) -> Self {
        Self(GizmoRole::ALL.map(color))
    }

    /// The color of a role.
    pub fn get(&self, role: GizmoRole) -> [f32; 3] {
        self.0[role as usize]
    }
}

impl Default for RoleColors {
    /// The colors for images without a window.
    fn default() -> Self {
        Self::new(|role| match role {
            GizmoRole::X => [0.81, 0.16, 0.15],
            GizmoRole::Y => [0.26, 0.56, 0.12],
            GizmoRole::Z => [0.12, 0.35, 0.84],
            GizmoRole::View => [0.70, 0.72, 0.74],
            GizmoRole::Hover | GizmoRole::Active => [1.0, 0.86, 0.35],
            GizmoRole::Past => [0.85, 0.25, 0.16],
            GizmoRole::Future => [0.12, 0.55, 0.60],
            GizmoRole::Selected => [0.95, 0.38, 0.06],
        })
    }
}

/// A vertex of a line or a triangle.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct GizmoVertex {
    /// Position, scene space.
    pub position: Vec3,
    /// A [`GizmoRole`], or a [`LineInk`] by its bits.
    pub role: u32,
    /// Opacity, 0 to 1.
    pub opacity: f32,
}

/// Lines and triangles, in lists that keep their memory from frame to frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GizmoShape {
    lines: Vec<GizmoVertex>,
    triangles: Vec<GizmoVertex>,
}

/// Number of sides of a cone or a disc.
const SIDES: usize = 12;
/// Length of a guide along a constrained axis to either side, points.
const GUIDE: f64 = 4000.0;

impl GizmoShape {
    /// The vertices of the lines, two per line.
    pub fn lines(&self) -> &[GizmoVertex] {
        &self.lines
    }

    /// The vertices of the triangles, three each; both sides are visible.
    pub fn triangles(&self) -> &[GizmoVertex] {
        &self.triangles
    }

    /// Removes everything, keeping the memory.
    pub fn clear(&mut self) {
        self.lines.clear();
        self.triangles.clear();
    }

    /// Adds a line, scene space; opacity 0 to 1.
    pub fn add_line(&mut self, from: Vec3, to: Vec3, role: GizmoRole, opacity: f32) {
        self.lines.extend([from, to].map(|position| GizmoVertex { position, role: role as u32, opacity }));
    }

    /// Adds a line with a color and a width of its own, scene space; opacity 0 to 1.
    pub fn add_inked_line(&mut self, from: Vec3, to: Vec3, ink: LineInk, opacity: f32) {
        self.lines.extend([from, to].map(|position| GizmoVertex { position, role: ink.bits(), opacity }));
    }

    /// Adds a diamond in the image plane: `right` and `up` reach to its corners.
    pub fn add_diamond(&mut self, at: Vec3, right: Vec3, up: Vec3, role: GizmoRole, opacity: f32) {
        let [a, b, c, d] = [at + up, at + right, at - up, at - right];
        let corner = |position| GizmoVertex { position, role: role as u32, opacity };
        self.triangles.extend([a, b, c, a, c, d].map(corner));
    }

    /// Adds all of another shape.
    pub fn extend(&mut self, other: &Self) {
        self.lines.extend_from_slice(&other.lines);
        self.triangles.extend_from_slice(&other.triangles);
    }

    /// Adds all handles of a gizmo that is not being dragged.
    pub fn waiting(&mut self, layout: &GizmoLayout, tool: Tool, hovered: Option<Handle>) {
        let role =
            |handle: Handle, role: GizmoRole| if hovered == Some(handle) { GizmoRole::Hover } else { role };
        for axis in GizmoAxis::ALL {
            for handle in [Handle::Axis(axis), Handle::Plane(axis)] {
                if layout.shows(tool, handle) {
                    self.handle(layout, tool, handle, role(handle, GizmoRole::of(axis)));
                }
            }
        }
        for handle in [Handle::Center, Handle::Ring] {
            if layout.shows(tool, handle) {
                self.handle(layout, tool, handle, role(handle, GizmoRole::View));
            }
        }
    }

    /// Adds the handle being dragged, the line it is constrained to, and the angle of rotation.
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
            Handle::Center | Handle::Ring => {}
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
            (Tool::Rotate, Handle::Center) => self.disc(layout, RING, role, 0.06),
            (_, Handle::Center) => self.disc(layout, CENTER, role, 0.8),
            (_, Handle::Ring) => {
                let around = |index: usize| facing(layout, OUTER, index as f64 / PIECES as f64);
                (0..PIECES).for_each(|index| self.line(around(index), around(index + 1), role, 1.0));
            }
        }
    }

    /// Adds a line with a cone (moving) or a cube (scaling).
    fn arrow(&mut self, layout: &GizmoLayout, axis: GizmoAxis, tool: Tool, role: GizmoRole) {
        let along = axis.unit();
        let [a, b] = axis.others().map(GizmoAxis::unit);
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

    /// Adds the half of a ring towards the viewer; while it is dragged, the whole ring.
    fn ring(&mut self, layout: &GizmoLayout, axis: GizmoAxis, role: GizmoRole) {
        for index in 0..PIECES {
            let [from, to] = [index, index + 1].map(|end| layout.on_ring(axis, end as f64 / PIECES as f64));
            let is_front = layout.in_front(from) && layout.in_front(to);
            if is_front || role == GizmoRole::Active {
                self.line(from, to, role, if is_front { 1.0 } else { 0.35 });
            }
        }
    }

    fn disc(&mut self, layout: &GizmoLayout, radius: f64, role: GizmoRole, opacity: f32) {
        // A large disc is as round as the rings around it.
        let sides = if radius > CENTER { PIECES } else { SIDES * 2 };
        for index in 0..sides {
            let [from, to] = [index, index + 1].map(|end| facing(layout, radius, end as f64 / sides as f64));
            self.triangle([layout.pivot, from, to], role, opacity);
        }
    }

    fn guide(&mut self, layout: &GizmoLayout, axis: GizmoAxis) {
        let [from, to] = [-GUIDE, GUIDE].map(|along| layout.place(axis.unit() * along));
        self.line(from, to, GizmoRole::of(axis), 0.6);
    }

    /// Adds the angle of rotation as a fan from its start; a full disc beyond a turn.
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

/// Returns a point of a circle in the image plane.
fn facing(layout: &GizmoLayout, radius: f64, share: f64) -> DVec3 {
    let (sin, cos) = (share * TAU).sin_cos();
    layout.pivot + (layout.view.right * cos + layout.view.up * sin) * (radius * layout.unit)
}
