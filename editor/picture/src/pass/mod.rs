//! The passes: what draws, in which order. A new one is a file here, a shader, and a line in [`all`].

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

/// Into what a pass draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// The scene: many samples, depth, linear light; the size of the viewport.
    Scene,
    /// The window: colours as the screen takes them.
    Window,
}

/// What a pass may look at.
pub struct Surroundings<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// What is shown.
    pub scene: &'a Scene,
    /// Size of what stands for the window, pixels.
    pub window_size: [u32; 2],
    /// The finished scene; `None` while it has no size.
    pub scene_view: Option<&'a wgpu::TextureView>,
}

/// Draws one kind of thing. Keeps on the device what it needs, and reloads it after a loss.
pub trait Pass: DeviceListener {
    /// For reports.
    fn name(&self) -> &'static str;

    /// Into what it draws. Passes of the scene come before those of the window.
    fn layer(&self) -> Layer;

    /// Hands this frame's data to the device, before anything is drawn.
    fn prepare(&mut self, around: &Surroundings<'_>, commands: &mut Commands);

    /// Draws.
    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>);
}

/// What preparing may add to a frame.
pub struct Commands {
    /// Runs before the first pass.
    pub encoder: wgpu::CommandEncoder,
    /// Run before that encoder.
    pub before: Vec<wgpu::CommandBuffer>,
}

/// A pass and whoever else holds it.
pub type SharedPass = Rc<RefCell<dyn Pass>>;

/// All passes in drawing order, and the panels among them by their own name.
pub struct Passes {
    /// In drawing order.
    pub list: Vec<SharedPass>,
    /// Holds a device's model for the passes that draw it.
    pub model: Rc<RefCell<GpuModel>>,
    /// Takes what the main thread paints.
    pub panels: Rc<RefCell<PanelsPass>>,
}

/// The list of passes.
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

/// A pass as a listener: the list of passes and the list of listeners hold the same object under two names.
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

/// A pipeline of the scene that needs no more than the frame's uniform and these entry points of `module`.
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
