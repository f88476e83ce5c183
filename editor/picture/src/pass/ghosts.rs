//! The model at other times, as skins that one can look through.

use super::{Commands, Layer, Pass, Surroundings};
use crate::device::DeviceListener;
use crate::gpu::Gpu;
use crate::model::GpuModel;
use std::cell::RefCell;
use std::rc::Rc;

/// Draws them.
pub(super) struct GhostsPass {
    model: Rc<RefCell<GpuModel>>,
}

impl GhostsPass {
    /// Of this model, which the pass of solid surfaces prepares.
    pub(super) fn new(model: Rc<RefCell<GpuModel>>) -> Self {
        Self { model }
    }
}

/// The model is a listener of its own.
impl DeviceListener for GhostsPass {
    fn on_lost(&mut self) {}

    fn on_reset(&mut self, _: &Gpu) {}
}

impl Pass for GhostsPass {
    fn name(&self) -> &'static str {
        "ghosts"
    }

    fn layer(&self) -> Layer {
        Layer::Scene
    }

    fn prepare(&mut self, around: &Surroundings<'_>, _: &mut Commands) {
        self.model.borrow_mut().prepare_ghosts(around.gpu, around.scene.ghosts());
    }

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        self.model.borrow().draw_ghosts(around.scene.ghosts(), around.gpu, pass);
    }
}
