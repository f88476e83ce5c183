//! A control of the scene as it is drawn, and the frame that it draws itself in.

use crate::appearance::Appearances;
use crate::camera::Camera;
use crate::cast::PosedScene;
use crate::gizmo::GizmoShape;
use crate::message::Look;
use crate::posed::PosedModel;

/// The frame that a component draws itself in.
pub struct ControlFrame<'a> {
    /// The model in the pose of this frame.
    pub model: &'a PosedModel,
    /// The things of a script at the time of this frame; `None` where a model is shown.
    pub cast: Option<&'a PosedScene>,
    /// The camera.
    pub camera: &'a Camera,
    /// The look of the viewport, with the selection.
    pub look: &'a Look,
    /// The data set for controls.
    pub appearances: &'a Appearances,
}

/// A control in the graphics thread.
pub trait GraphicComponent {
    /// Adds the shape of the control in this frame. Allocates only as the shape grows.
    fn present(&mut self, frame: &ControlFrame<'_>, shape: &mut GizmoShape);
}
