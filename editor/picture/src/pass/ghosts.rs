//! Ghosts: the model at other times, drawn as transparent skins.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings};
use crate::control::GhostAppearance;
use crate::device::DeviceListener;
use crate::ghosts::GhostSkins;
use crate::gizmo::GizmoRole;
use crate::gpu::Gpu;
use crate::model::GpuModel;
use std::cell::RefCell;
use std::rc::Rc;

/// Draws the ghosts.
pub(super) struct GhostsPass {
    model: Rc<RefCell<GpuModel>>,
    skins: GhostSkins,
}

impl GhostsPass {
    /// Draws ghosts of this model, which the pass `skin` prepares.
    pub(super) fn new(model: Rc<RefCell<GpuModel>>) -> Self {
        Self { model, skins: GhostSkins::default() }
    }
}

/// Holds no resources of the device: those of the model are released by the model, which is a listener itself.
impl DeviceListener for GhostsPass {
    fn on_lost(&mut self) {}

    fn on_reset(&mut self, _: &Gpu) {}
}

impl Pass for GhostsPass {
    fn name(&self) -> &'static str {
        "ghosts"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Scene
    }

    fn prepare(&mut self, around: &Surroundings<'_>, _: &mut FrameCommands) {
        let scene = around.scene;
        let ghosts = scene.appearances.get::<GhostAppearance>().filter(|ghosts| ghosts.skins);
        match (ghosts, scene.view()) {
            (Some(ghosts), Some(view)) if !ghosts.times.is_empty() => {
                let colors = [GizmoRole::Past, GizmoRole::Future].map(|role| scene.look.handles.get(role));
                let (take, frustum) = (scene.playback.take, scene.frustum());
                self.skins.pose(view, scene.still(), take, &ghosts.times, colors, &frustum);
            }
            _ => self.skins.clear(),
        }
        self.model.borrow_mut().prepare_ghosts(around.gpu, &self.skins);
    }

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        self.model.borrow().draw_ghosts(&self.skins, around.gpu, pass);
    }
}
