//! The geometry of gizmos: axes, handles, hit testing and the shape to draw. It is shared by the pass that draws a gizmo in
//! the pose of the frame and by the tool in the window that drags it, so both place every handle in the same position.

mod axes;
mod delta;
mod handle;
mod ink;
mod select;
mod shape;
mod view;

pub use axes::{GizmoAxes, GizmoAxis, GizmoSpace, GizmoTarget, Pivot, unit};
pub use delta::GizmoDelta;
pub use handle::{AXIS_FROM, AXIS_TO, CENTER, GizmoLayout, Handle, OUTER, PLANE, REACH, RING, Tool};
pub use ink::LineInk;
pub use select::{GizmoAnchor, GizmoPlacement, PosedSkeleton};
pub use shape::{GizmoRole, GizmoShape, GizmoVertex, RoleColors};
pub use view::GizmoView;

/// Settings of gizmos.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GizmoSettings {
    /// Space that gives the axes.
    pub space: GizmoSpace,
    /// Point about which several bones rotate and scale.
    pub pivot: Pivot,
    /// Whether every bone of a selected chain rotates and scales by the full amount, as when curling a finger.
    /// Otherwise bones with a selected ancestor only follow it. Applies to [`Pivot::Individual`] only, and not to
    /// moving.
    pub curl: bool,
    /// Snapping step for moving with Ctrl, scene units.
    pub move_step: f64,
    /// Snapping step for rotating, radians.
    pub rotate_step: f64,
    /// Snapping step for scaling, as a factor.
    pub scale_step: f64,
    /// Fraction of the pointer's movement that counts while Shift is held.
    pub precise: f64,
}

impl Default for GizmoSettings {
    fn default() -> Self {
        Self {
            space: GizmoSpace::default(),
            pivot: Pivot::default(),
            curl: false,
            move_step: 0.1,
            rotate_step: 5f64.to_radians(),
            scale_step: 0.1,
            precise: 0.1,
        }
    }
}

impl GizmoSettings {
    /// Snapping step of `tool`, in its own unit.
    pub fn step(&self, tool: Tool) -> f64 {
        match tool {
            Tool::Move => self.move_step,
            Tool::Rotate => self.rotate_step,
            Tool::Scale => self.scale_step,
        }
    }
}
