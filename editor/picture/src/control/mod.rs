//! What controls of the scene look like (thesis §3.2.9.2, §3.2.9.4): each is a component that hears of its appearance and
//! presents itself with every frame, in the pose of that frame; one pass draws them all.

mod ghosts;
mod gizmo;
mod ik;
mod path;

use super::message::{Appearance, Look};
use super::posed::PosedModel;
use crate::camera::Camera;
use crate::gizmo::GizmoShape;
use ghosts::GhostsGraphic;
use gizmo::GizmoGraphic;
use ik::IkGraphic;
use path::PathGraphic;

/// What a component may look at when it presents itself.
pub struct Frame<'a> {
    /// In the pose of this frame.
    pub model: &'a PosedModel,
    /// From where it is seen.
    pub camera: &'a Camera,
    /// How, and what is selected.
    pub look: &'a Look,
}

/// A control, as the graphics thread sees it.
pub trait GraphicComponent {
    /// It looks like this from now on. Tells whether that was for this component.
    fn receive(&mut self, appearance: &Appearance) -> bool;

    /// Adds what is to be drawn in this frame. Allocates only as it grows.
    fn present(&mut self, frame: &Frame<'_>, shape: &mut GizmoShape);
}

/// All components, and what they want drawn.
pub struct Controls {
    list: Vec<Box<dyn GraphicComponent>>,
    shape: GizmoShape,
    /// When the model is shown as a ghost, and whether it is as a skin.
    ghosts: (Vec<(f32, i32)>, bool),
}

impl Default for Controls {
    fn default() -> Self {
        // The later over the earlier.
        let list: Vec<Box<dyn GraphicComponent>> = vec![
            Box::<GhostsGraphic>::default(),
            Box::<PathGraphic>::default(),
            Box::<IkGraphic>::default(),
            Box::<GizmoGraphic>::default(),
        ];
        Self { list, shape: GizmoShape::default(), ghosts: (Vec::new(), false) }
    }
}

impl Controls {
    /// Hands an appearance to whom it is for.
    pub fn receive(&mut self, appearance: Appearance) {
        match &appearance {
            Appearance::Ghosts(times) => self.ghosts.0.clone_from(times),
            Appearance::GhostSkins(on) => self.ghosts.1 = *on,
            _ => {}
        }
        let _ = self.list.iter_mut().any(|component| component.receive(&appearance));
    }

    /// Lets every component present itself.
    pub(super) fn present(&mut self, model: &PosedModel, camera: &Camera, look: &Look) {
        self.shape.clear();
        let frame = Frame { model, camera, look };
        for component in &mut self.list {
            component.present(&frame, &mut self.shape);
        }
    }

    /// When the model is shown as a ghost with its skin: seconds, and how far from now.
    pub fn ghost_skins(&self) -> &[(f32, i32)] {
        if self.ghosts.1 { &self.ghosts.0 } else { &[] }
    }

    /// What is to be drawn.
    pub fn shape(&self) -> &GizmoShape {
        &self.shape
    }
}
