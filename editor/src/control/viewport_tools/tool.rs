//! The trait of all tools in the viewport.

use crate::control::base::BaseControl;
use dragonfly_picture::gizmo::GizmoView;
use glam::Vec2;

/// A tool in the viewport that a press can begin to drag.
pub trait ViewportTool: BaseControl {
    /// Sets the top left of the viewport, points from that of the window.
    fn place(&mut self, corner: Vec2);

    /// Sets the view.
    fn look(&mut self, view: GizmoView);

    /// Whether a drag of the tool changes the document.
    fn is_dragging(&self) -> bool;

    /// Whether the tool has mouse and keyboard although no button is held.
    fn is_modal(&self) -> bool {
        false
    }
}
