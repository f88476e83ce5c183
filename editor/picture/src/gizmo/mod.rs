//! The geometry of gizmos: axes, handles, hit testing and the shape to draw. It is shared by the pass that draws a gizmo in
//! the pose of the frame and by the tool in the window that drags it, so both place every handle in the same position.

mod axes;
mod delta;
mod handle;
mod select;
mod shape;
mod view;

pub use axes::{Axis, GizmoAxes, GizmoTarget, Pivot, Space, unit};
pub use delta::GizmoDelta;
pub use handle::{AXIS_FROM, AXIS_TO, CENTRE, GizmoLayout, Handle, OUTER, PLANE, REACH, RING, Tool};
pub use select::{GizmoAnchor, GizmoPlacement, PosedSkeleton};
pub use shape::{GizmoRole, GizmoShape, GizmoVertex};
pub use view::GizmoView;

/// How gizmos work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GizmoSettings {
    /// Whose axes.
    pub space: Space,
    /// What several bones turn and grow about.
    pub pivot: Pivot,
    /// Does every bone of a selected chain turn and grow by the amount, as when a finger is curled? Else those with a
    /// selected bone above them only follow it. Only for [`Pivot::Individual`], and not for moving.
    pub curl: bool,
    /// Scene units that moving snaps to, with Ctrl.
    pub move_step: f64,
    /// Radians that rotating snaps to.
    pub rotate_step: f64,
    /// Part of a factor that scaling snaps to.
    pub scale_step: f64,
    /// How much of the pointer's way counts, with Shift.
    pub precise: f64,
}

impl Default for GizmoSettings {
    fn default() -> Self {
        Self {
            space: Space::default(),
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
