//! The solid surfaces of the models.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings};
use crate::device::DeviceListener;
use crate::gpu::Gpu;
use crate::model::GpuModel;
use crate::shadow::ShadowMaps;
use std::cell::RefCell;
use std::rc::Rc;

/// Draws the solid surfaces.
pub(super) struct SurfacePass {
    model: Rc<RefCell<GpuModel>>,
    shadows: Rc<RefCell<ShadowMaps>>,
}

impl SurfacePass {
    /// Draws this model, which the pass `skin` prepares, with the shadows that the pass `shadow` draws.
    pub(super) fn new(model: Rc<RefCell<GpuModel>>, shadows: Rc<RefCell<ShadowMaps>>) -> Self {
        Self { model, shadows }
    }
}

/// Holds no resources of the device: those of the model are released by the model, which is a listener itself.
impl DeviceListener for SurfacePass {
    fn on_lost(&mut self) {}

    fn on_reset(&mut self, _: &Gpu) {}
}

impl Pass for SurfacePass {
    fn name(&self) -> &'static str {
        "surface"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Scene
    }

    fn prepare(&mut self, _: &Surroundings<'_>, _: &mut FrameCommands) {}

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        if around.scene.look.surface {
            let shadows = self.shadows.borrow();
            self.model.borrow().draw_solid(around.scene, around.gpu, &shadows, pass);
        }
    }
}
