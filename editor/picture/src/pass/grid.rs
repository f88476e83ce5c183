//! The ground: grid and contact shadow.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings, scene_pipeline};
use crate::device::DeviceListener;
use crate::gpu::Gpu;
use crate::shaders;

/// Draws the ground grid and the contact shadow.
#[derive(Default)]
pub(super) struct GridPass {
    pipeline: Option<wgpu::RenderPipeline>,
}

impl DeviceListener for GridPass {
    fn on_lost(&mut self) {
        self.pipeline = None;
    }

    fn on_reset(&mut self, gpu: &Gpu) {
        let module = shaders::GRID.module(&gpu.device);
        let topology = wgpu::PrimitiveTopology::TriangleStrip;
        let strip = wgpu::PrimitiveState { topology, ..Default::default() };
        self.pipeline = Some(scene_pipeline(gpu, &module, ["vs_grid", "fs_grid"], &[], strip, true));
    }
}

impl Pass for GridPass {
    fn name(&self) -> &'static str {
        "grid"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Scene
    }

    fn prepare(&mut self, _: &Surroundings<'_>, _: &mut FrameCommands) {}

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        let Some(pipeline) = &self.pipeline else { return };
        if around.scene.look.grid || around.scene.look.contact_shadow {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &around.gpu.frame_group, &[]);
            pass.draw(0..4, 0..1);
        }
    }
}
