//! The background gradient.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings, scene_pipeline};
use crate::device::DeviceListener;
use crate::gpu::Gpu;
use crate::scene::Scene;
use crate::shaders;

/// Draws the background gradient.
#[derive(Default)]
pub(super) struct BackgroundPass {
    pipeline: Option<wgpu::RenderPipeline>,
}

impl DeviceListener for BackgroundPass {
    fn on_lost(&mut self) {
        self.pipeline = None;
    }

    fn on_reset(&mut self, gpu: &Gpu) {
        let module = shaders::BACKGROUND.module(&gpu.device);
        let entries = ["vs_background", "fs_background"];
        // Blended into the cleared target, so that it writes no depth.
        self.pipeline = Some(scene_pipeline(gpu, &module, entries, &[], Default::default(), true));
    }
}

impl Pass for BackgroundPass {
    fn name(&self) -> &'static str {
        "background"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Scene
    }

    fn is_backdrop(&self, _: &Scene) -> bool {
        true
    }

    fn prepare(&mut self, _: &Surroundings<'_>, _: &mut FrameCommands) {}

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        let Some(pipeline) = &self.pipeline else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &around.gpu.frame_group, &[]);
        pass.draw(0..3, 0..1);
    }
}
