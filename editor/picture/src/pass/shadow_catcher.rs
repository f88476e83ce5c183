//! Shadows of lamps on the ground.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings};
use crate::device::DeviceListener;
use crate::gpu::{Gpu, scene_depth};
use crate::shaders;
use crate::shadow::ShadowMaps;
use std::cell::RefCell;
use std::rc::Rc;

/// Darkens the ground where lamps do not reach it, if the ground is shown: its grid or the contact shadow on it.
pub(super) struct ShadowCatcherPass {
    shadows: Rc<RefCell<ShadowMaps>>,
    /// Created for the first frame with shadows.
    pipeline: Option<wgpu::RenderPipeline>,
}

impl ShadowCatcherPass {
    /// Draws these shadows, whose maps the pass `shadow` draws.
    pub(super) fn new(shadows: Rc<RefCell<ShadowMaps>>) -> Self {
        Self { shadows, pipeline: None }
    }
}

impl DeviceListener for ShadowCatcherPass {
    fn on_lost(&mut self) {
        self.pipeline = None;
    }

    fn on_reset(&mut self, _: &Gpu) {
        self.pipeline = None;
    }
}

impl Pass for ShadowCatcherPass {
    fn name(&self) -> &'static str {
        "shadow_catcher"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Scene
    }

    fn prepare(&mut self, around: &Surroundings<'_>, _: &mut FrameCommands) {
        let shadows = self.shadows.borrow();
        if let Some(layout) = shadows.layout().filter(|_| is_shown(around)) {
            self.pipeline.get_or_insert_with(|| pipeline(around.gpu, layout));
        }
    }

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        let shadows = self.shadows.borrow();
        let (Some(pipeline), Some(group)) = (&self.pipeline, shadows.group()) else { return };
        if is_shown(around) {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &around.gpu.frame_group, &[]);
            pass.set_bind_group(3, group, &[]);
            pass.draw(0..4, 0..1);
        }
    }
}

/// Returns whether there are shadows, and ground that they fall on.
fn is_shown(around: &Surroundings<'_>) -> bool {
    let look = &around.scene.look;
    around.scene.shadows().is_some() && (look.grid || look.contact_shadow)
}

fn pipeline(gpu: &Gpu, shadows: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    let module = shaders::SHADOW_CATCHER.module(&gpu.device);
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("shadow catcher"),
        bind_group_layouts: &[Some(&gpu.frame_layout), None, None, Some(shadows)],
        immediate_size: 0,
    });
    let topology = wgpu::PrimitiveTopology::TriangleStrip;
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("shadow catcher"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_catcher"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState { topology, ..Default::default() },
        depth_stencil: Some(scene_depth(false)),
        multisample: gpu.scene_samples(false),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs_catcher"),
            compilation_options: Default::default(),
            targets: &gpu.scene_target(true),
        }),
        multiview_mask: None,
        cache: None,
    })
}
