//! The transparent surfaces of the model, drawn after the solid ones and the ground.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings};
use crate::device::DeviceListener;
use crate::gpu::Gpu;
use crate::model::GpuModel;
use crate::shadow::ShadowMaps;
use std::cell::RefCell;
use std::rc::Rc;

/// Draws the transparent surfaces from back to front.
pub(super) struct GlassPass {
    model: Rc<RefCell<GpuModel>>,
    shadows: Rc<RefCell<ShadowMaps>>,
}

impl GlassPass {
    /// Draws this model, which the pass `skin` prepares, with the shadows that the pass `shadow` draws.
    pub(super) fn new(model: Rc<RefCell<GpuModel>>, shadows: Rc<RefCell<ShadowMaps>>) -> Self {
        Self { model, shadows }
    }
}

/// Holds no resources of the device: those of the model are released by the model, which is a listener itself.
impl DeviceListener for GlassPass {
    fn on_lost(&mut self) {}

    fn on_reset(&mut self, _: &Gpu) {}
}

impl Pass for GlassPass {
    fn name(&self) -> &'static str {
        "glass"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Scene
    }

    fn prepare(&mut self, _: &Surroundings<'_>, _: &mut FrameCommands) {}

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        if around.scene.look.surface {
            let shadows = self.shadows.borrow();
            self.model.borrow().draw_blended(around.scene, around.gpu, &shadows, pass);
        }
    }
}
