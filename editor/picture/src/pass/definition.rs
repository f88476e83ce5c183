//! A render pass, and what it may read and add in a frame.

use crate::device::DeviceListener;
use crate::gpu::{Gpu, scene_depth};
use crate::scene::Scene;

/// Target of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassLayer {
    /// The scene: multisampled, with depth, in linear light; as large as the viewport.
    Scene,
    /// The window, in the color encoding of the screen.
    Window,
}

/// Read access of a pass to the frame.
pub struct Surroundings<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// The scene as prepared for this frame.
    pub scene: &'a Scene,
    /// Size of the window, pixels.
    pub window_size: [u32; 2],
    /// The finished scene; `None` while the viewport has no size.
    pub scene_view: Option<&'a wgpu::TextureView>,
    /// The finished second view of the scene; `None` without one.
    pub second_view: Option<&'a wgpu::TextureView>,
}

/// Draws one kind of object. Keeps the device resources it needs and reloads them after a loss.
pub trait Pass: DeviceListener {
    /// Name for reports.
    fn name(&self) -> &'static str;

    /// Target of the pass. Passes of the scene come before those of the window.
    fn layer(&self) -> PassLayer;

    /// Returns whether everything else is drawn over this pass, which looks the same in every sub-frame: its colors are those of the display.
    fn is_backdrop(&self, _scene: &Scene) -> bool {
        false
    }

    /// Writes this frame's data to the device, before anything is drawn.
    fn prepare(&mut self, around: &Surroundings<'_>, commands: &mut FrameCommands);

    /// Draws into the target.
    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>);
}

/// Commands that preparing may add to a frame.
pub struct FrameCommands {
    /// Encoder that runs before the first pass.
    pub encoder: wgpu::CommandEncoder,
    /// Command buffers that run before that encoder.
    pub before: Vec<wgpu::CommandBuffer>,
}

/// Creates a pipeline of the scene that uses only the frame's uniform and these entry points of `module`.
pub(super) fn scene_pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    [vertex, fragment]: [&str; 2],
    buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
    primitive: wgpu::PrimitiveState,
    blend: bool,
) -> wgpu::RenderPipeline {
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(vertex),
        layout: Some(&gpu.pipeline_layout(vertex, &[])),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers,
        },
        primitive,
        depth_stencil: Some(scene_depth(!blend)),
        multisample: gpu.scene_samples(false),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &gpu.scene_target(blend),
        }),
        multiview_mask: None,
        cache: None,
    })
}
