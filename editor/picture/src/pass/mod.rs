//! The render passes and their order. A new pass is a file here, a line in [`all`], and its shader: a file in `shaders/` and a
//! line in `shaders!`. Data that another thread sets for it is an [`Appearance`](crate::Appearance) declared in its file.

mod background;
mod composite;
mod controls;
mod definition;
mod ghosts;
mod glass;
mod grid;
mod panels;
mod reference;
mod shadow;
mod shadow_catcher;
mod skeleton;
mod skin;
mod surface;

pub use definition::{FrameCommands, Pass, PassLayer, Surroundings};
pub use panels::PanelsPass;
pub use reference::{ReferenceAppearance, ReferencePicture, ReferencePlace};

use super::device::DeviceListener;
use super::gpu::Gpu;
use super::model::GpuModel;
use super::shadow::ShadowMaps;
use std::cell::RefCell;
use std::rc::Rc;

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
    let shadows = Rc::new(RefCell::new(ShadowMaps::default()));
    let panels = Rc::new(RefCell::new(PanelsPass::default()));
    let list: Vec<SharedPass> = vec![
        shared(skin::SkinPass::new(Rc::clone(&model), Rc::clone(&shadows))),
        shared(shadow::ShadowPass::new(Rc::clone(&model), Rc::clone(&shadows))),
        shared(background::BackgroundPass::default()),
        shared(reference::ReferencePass::default()),
        shared(surface::SurfacePass::new(Rc::clone(&model), Rc::clone(&shadows))),
        shared(grid::GridPass::default()),
        shared(shadow_catcher::ShadowCatcherPass::new(Rc::clone(&shadows))),
        shared(glass::GlassPass::new(Rc::clone(&model), shadows)),
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
