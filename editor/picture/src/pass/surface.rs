//! The solid surfaces of the model.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings};
use crate::device::DeviceListener;
use crate::gpu::Gpu;
use crate::model::GpuModel;
use std::cell::RefCell;
use std::rc::Rc;

/// Draws the solid surfaces, and writes the models to the device for the other passes that draw it.
pub(super) struct SurfacePass {
    model: Rc<RefCell<GpuModel>>,
}

impl SurfacePass {
    /// Draws this model.
    pub(super) fn new(model: Rc<RefCell<GpuModel>>) -> Self {
        Self { model }
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

    fn prepare(&mut self, around: &Surroundings<'_>, _: &mut FrameCommands) {
        self.model.borrow_mut().prepare(around.gpu, around.scene);
    }

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        if around.scene.look.surface {
            self.model.borrow().draw_solid(around.scene, around.gpu, pass);
        }
    }
}
