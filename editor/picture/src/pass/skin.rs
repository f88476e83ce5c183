//! The poses of models on the device, and their vertices, posed once where several passes draw them.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings};
use crate::device::DeviceListener;
use crate::gpu::Gpu;
use crate::model::GpuModel;
use crate::shadow::ShadowMaps;
use std::cell::RefCell;
use std::rc::Rc;

/// Writes the poses of models to the device, before the passes that draw them.
pub(super) struct SkinPass {
    model: Rc<RefCell<GpuModel>>,
    shadows: Rc<RefCell<ShadowMaps>>,
}

impl SkinPass {
    /// Prepares this model, to be drawn with these shadows.
    pub(super) fn new(model: Rc<RefCell<GpuModel>>, shadows: Rc<RefCell<ShadowMaps>>) -> Self {
        Self { model, shadows }
    }
}

/// Holds no resources of the device: those of the model are released by the model, which is a listener itself.
impl DeviceListener for SkinPass {
    fn on_lost(&mut self) {}

    fn on_reset(&mut self, _: &Gpu) {}
}

impl Pass for SkinPass {
    fn name(&self) -> &'static str {
        "skin"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Scene
    }

    fn prepare(&mut self, around: &Surroundings<'_>, _: &mut FrameCommands) {
        self.model.borrow_mut().prepare(around.gpu, around.scene, &self.shadows.borrow());
    }

    /// Draws nothing: it has done its part.
    fn draw(&mut self, _: &Surroundings<'_>, _: &mut wgpu::RenderPass<'static>) {}
}
