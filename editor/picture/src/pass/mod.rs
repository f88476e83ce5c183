//! The render passes and their order. A new pass is a file here, a line in [`all`], and its shader: a file in `shaders/` and a
//! line in `shaders!`. Data that another thread sets for it is an [`Appearance`](crate::Appearance) declared in its file.

mod background;
mod composite;
mod controls;
mod ghosts;
mod glass;
mod grid;
mod panels;
mod skeleton;
mod surface;

pub use panels::PanelsPass;

use super::device::DeviceListener;
use super::gpu::{Gpu, scene_depth, scene_samples, scene_target};
use super::model::GpuModel;
use super::scene::Scene;
use std::cell::RefCell;
use std::rc::Rc;

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
}

/// Draws one kind of object. Keeps the device resources it needs and reloads them after a loss.
pub trait Pass: DeviceListener {
    /// Name for reports.
    fn name(&self) -> &'static str;

    /// Target of the pass. Passes of the scene come before those of the window.
    fn layer(&self) -> PassLayer;

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

/// A pass, shared with its other users.
pub type SharedPass = Rc<RefCell<dyn Pass>>;

/// All passes in drawing order; the panels also by name.
pub struct Passes {
    /// The passes in drawing order.
    pub list: Vec<SharedPass>,
    /// The model on the device, shared by the passes that draw it.
    pub model: Rc<RefCell<GpuModel>>,
    /// The pass that receives the panels from the main thread.
    pub panels: Rc<RefCell<PanelsPass>>,
}

/// Creates all passes.
pub fn all() -> Passes {
    let model = Rc::new(RefCell::new(GpuModel::default()));
    let panels = Rc::new(RefCell::new(PanelsPass::default()));
    let list: Vec<SharedPass> = vec![
        shared(background::BackgroundPass::default()),
        shared(surface::SurfacePass::new(Rc::clone(&model))),
        shared(grid::GridPass::default()),
        shared(glass::GlassPass::new(Rc::clone(&model))),
        shared(ghosts::GhostsPass::new(Rc::clone(&model))),
        shared(skeleton::SkeletonPass::default()),
        shared(controls::ControlRender::default()),
        shared(composite::CompositePass::default()),
        Rc::clone(&panels) as SharedPass,
    ];
    Passes { list, model, panels }
}

/// Returns a pass as a listener: the list of passes and the list of listeners contain the same object.
pub fn listener(pass: &SharedPass) -> Rc<RefCell<dyn DeviceListener>> {
    Rc::new(RefCell::new(ListeningPass(Rc::clone(pass))))
}

struct ListeningPass(SharedPass);

impl DeviceListener for ListeningPass {
    fn on_lost(&mut self) {
        self.0.borrow_mut().on_lost();
    }

    fn on_reset(&mut self, gpu: &Gpu) {
        self.0.borrow_mut().on_reset(gpu);
    }
}

fn shared(pass: impl Pass + 'static) -> SharedPass {
    Rc::new(RefCell::new(pass))
}

/// Creates a pipeline of the scene that uses only the frame's uniform and these entry points of `module`.
fn scene_pipeline(
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
        multisample: scene_samples(false),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &scene_target(blend),
        }),
        multiview_mask: None,
        cache: None,
    })
}
