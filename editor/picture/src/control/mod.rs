//! The controls of the scene as they are drawn (thesis §3.2.9.2, §3.2.9.4): each is a component that draws itself in
//! every frame, in the pose of that frame; one pass draws them all.
//!
//! A new control is a file here with its component, and a line in the list of `all` below. Its data, if it has any, is an
//! [`Appearance`](crate::Appearance) declared in its file, which the main thread sets.

mod cast;
mod compared;
mod component;
mod ghosts;
mod gizmo;
mod ik;
mod lines;
mod path;

pub use cast::ThingAppearance;
pub use compared::{ComparedAppearance, OtherSkeleton, SecondSkeleton};
pub use component::{ControlFrame, GraphicComponent};
pub use ghosts::GhostAppearance;
pub use gizmo::{GizmoAppearance, GizmoDragAppearance, GizmoLook};
pub use ik::{IkAppearance, IkLook};
pub use lines::{LineAppearance, LineHandle, LineLook};
pub use path::{PathAppearance, PathLook};

use crate::gizmo::GizmoShape;

/// All components, and the shape that they draw together.
pub struct SceneControls {
    list: Vec<Box<dyn GraphicComponent>>,
    shape: GizmoShape,
}

/// Creates all components. Later ones are drawn over earlier ones.
fn all() -> Vec<Box<dyn GraphicComponent>> {
    vec![
        Box::<cast::CastGraphic>::default(),
        Box::<lines::LinesGraphic>::default(),
        Box::<ghosts::GhostsGraphic>::default(),
        Box::<compared::ComparedGraphic>::default(),
        Box::<path::PathGraphic>::default(),
        Box::<ik::IkGraphic>::default(),
        Box::<gizmo::GizmoGraphic>::default(),
    ]
}

impl Default for SceneControls {
    fn default() -> Self {
        Self { list: all(), shape: GizmoShape::default() }
    }
}

impl SceneControls {
    /// Draws every component into the shape.
    pub(super) fn present(&mut self, frame: &ControlFrame<'_>) {
        self.shape.clear();
        for component in &mut self.list {
            component.present(frame, &mut self.shape);
        }
    }

    /// Draws no control.
    pub(super) fn clear(&mut self) {
        self.shape.clear();
    }

    /// The shape of all controls in the frame prepared last.
    pub fn shape(&self) -> &GizmoShape {
        &self.shape
    }
}
