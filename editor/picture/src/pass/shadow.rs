//! The maps of shadows: the depth of the scene as each lamp sees it that casts shadows.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings};
use crate::device::DeviceListener;
use crate::gpu::Gpu;
use crate::model::GpuModel;
use crate::shadow::ShadowMaps;
use std::cell::RefCell;
use std::rc::Rc;

/// Draws the maps of shadows, each in a render pass of its own before that of the scene. Without shadows it records nothing and keeps no maps.
pub(super) struct ShadowPass {
    model: Rc<RefCell<GpuModel>>,
    maps: Rc<RefCell<ShadowMaps>>,
}

impl ShadowPass {
    /// Draws this model, which the pass `skin` prepares, into these maps.
    pub(super) fn new(model: Rc<RefCell<GpuModel>>, maps: Rc<RefCell<ShadowMaps>>) -> Self {
        Self { model, maps }
    }
}

impl DeviceListener for ShadowPass {
    fn on_lost(&mut self) {
        self.maps.borrow_mut().on_lost();
    }

    fn on_reset(&mut self, gpu: &Gpu) {
        self.maps.borrow_mut().on_reset(gpu);
    }
}

impl Pass for ShadowPass {
    fn name(&self) -> &'static str {
        "shadow"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Scene
    }

    fn prepare(&mut self, around: &Surroundings<'_>, commands: &mut FrameCommands) {
        let mut maps = self.maps.borrow_mut();
        let Some(shadows) = around.scene.shadows() else {
            maps.clear();
            return;
        };
        maps.write(around.gpu, shadows);
        let model = self.model.borrow();
        for map in 0..shadows.maps().count() {
            let Some(view) = maps.target(shadows, map) else { continue };
            let mut pass = commands.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("shadow"),
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view,
                    depth_ops: Some(wgpu::Operations {
                        // Reversed: 0 is farthest from the lamp.
                        load: wgpu::LoadOp::Clear(0.0),
                        store: wgpu::StoreOp::Store,
                    }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            model.draw_casters(around.scene, map, &mut pass);
        }
    }

    /// Draws nothing: its commands come before those of the scene.
    fn draw(&mut self, _: &Surroundings<'_>, _: &mut wgpu::RenderPass<'static>) {}
}
