//! Models on the device. Several passes share them: solid surfaces are drawn before the ground, blended ones after it.

mod content;
mod geometry;
mod ghost;
mod groups;
mod image_plan;
mod images;
mod material;
mod pipeline;
mod recorder;
mod texture;

use super::batch::DrawBatch;
use super::device::DeviceListener;
use super::draw_set::{DrawItem, DrawSet};
use super::ghosts::GhostSkins;
use super::gpu::Gpu;
use super::scene::Scene;
use content::ModelContent;
use dragonfly_document::LoadedModel;
use images::PixelBudget;
use material::GpuMaterials;
use pipeline::{Cull, ModelPipelines, PipelineKind};
use recorder::{DrawCounts, DrawRecorder};
use std::cell::Cell;
use std::collections::BTreeSet;
use std::sync::Arc;
use texture::TextureMaker;

/// The models of the scene on the device: the one that is shown, or those of all things of a script.
#[derive(Default)]
pub struct GpuModel {
    resources: Option<ModelResources>,
    /// Whether all images are uploaded before the first frame, and not some with every frame.
    loads_at_once: bool,
    /// The models that are shown.
    shown: Vec<Arc<LoadedModel>>,
    /// Warnings about the images of these models.
    warnings: BTreeSet<String>,
    /// Those of them that [`Self::take_warnings`] has not returned yet.
    new_warnings: Vec<String>,
    /// Number of commands recorded since the last [`Self::prepare`].
    counts: Cell<DrawCounts>,
}

/// Device resources for any model.
struct ModelResources {
    pipelines: ModelPipelines,
    maker: TextureMaker,
    materials: GpuMaterials,
    /// Those of each model that is shown.
    contents: Vec<ModelContent>,
    ghosts: ghost::Ghosts,
}

/// Number of pixels that are decoded in one frame, of all models together: a large image, or many small ones.
const PIXELS_PER_FRAME: u64 = 4 << 20;

impl DeviceListener for GpuModel {
    fn on_lost(&mut self) {
        self.resources = None;
    }

    fn on_reset(&mut self, gpu: &Gpu) {
        let materials = GpuMaterials::new(gpu);
        let pipelines = ModelPipelines::new(gpu, &materials.layout);
        let maker = TextureMaker::new(gpu);
        let (contents, ghosts) = (Vec::new(), ghost::Ghosts::default());
        self.resources = Some(ModelResources { pipelines, maker, materials, contents, ghosts });
    }
}

impl GpuModel {
    /// Writes this frame's poses to the device; models that are new are loaded first.
    pub fn prepare(&mut self, gpu: &Gpu, scene: &Scene) {
        self.counts.set(DrawCounts::default());
        self.keep_shown(scene);
        let Some(resources) = &mut self.resources else { return };
        let mut warnings = Vec::new();
        let mut budget = PixelBudget::new(if self.loads_at_once { u64::MAX } else { PIXELS_PER_FRAME });
        resources.forget_others(&self.shown);
        for set in scene.draw_sets() {
            resources.write(gpu, set, &mut budget, &mut warnings);
        }
        // A model that is loaded again on another device has the same warnings.
        self.new_warnings
            .extend(warnings.into_iter().filter(|warning| self.warnings.insert(warning.clone())));
    }

    /// Remembers which models are shown. Allocates nothing while they stay the same.
    fn keep_shown(&mut self, scene: &Scene) {
        let is_same = |(kept, set): (&Arc<LoadedModel>, &DrawSet)| Arc::ptr_eq(kept, set.loaded());
        let count = scene.draw_sets().count();
        if self.shown.len() != count || !self.shown.iter().zip(scene.draw_sets()).all(is_same) {
            self.shown = scene.draw_sets().map(|set| Arc::clone(set.loaded())).collect();
            self.warnings.clear();
        }
    }

    /// Sets whether all images are uploaded before the first frame of a model, and not some with every frame.
    pub fn load_at_once(&mut self, at_once: bool) {
        self.loads_at_once = at_once;
    }

    /// Returns whether images of a model wait for the next frame.
    pub fn is_loading(&self) -> bool {
        let contents = self.resources.as_ref().map_or(&[][..], |resources| &resources.contents);
        contents.iter().any(ModelContent::is_loading)
    }

    /// Returns the warnings about the images of the models since the last call, each once also if the device was lost.
    pub fn take_warnings(&mut self) -> Vec<String> {
        std::mem::take(&mut self.new_warnings)
    }

    /// Number of draw calls for surfaces and ghosts in this frame; all other passes together need a constant number.
    pub fn draws(&self) -> usize {
        self.counts.get().draws
    }

    /// Number of pipelines and bind groups that were set for these draw calls.
    pub fn state_changes(&self) -> usize {
        self.counts.get().state_changes
    }

    /// Writes the poses of ghosts to the device, after [`Self::prepare`].
    pub fn prepare_ghosts(&mut self, gpu: &Gpu, ghosts: &GhostSkins) {
        let Some(ModelResources { pipelines, contents, ghosts: own, .. }) = &mut self.resources else {
            return;
        };
        if let Some(content) = content_of_ghosts(contents, ghosts) {
            own.prepare(gpu, ghosts, pipelines, content.geometries());
        }
    }

    /// Draws the ghosts.
    pub fn draw_ghosts(&self, ghosts: &GhostSkins, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>) {
        let Some(ModelResources { contents, ghosts: own, .. }) = &self.resources else { return };
        if let Some(content) = content_of_ghosts(contents, ghosts) {
            let mut recorder = DrawRecorder::new(pass, &gpu.frame_group);
            own.draw(ghosts, content.geometries(), &mut recorder);
            self.counts.set(self.counts.get() + recorder.counts());
        }
    }

    /// Draws the solid surfaces.
    pub fn draw_solid(&self, scene: &Scene, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>) {
        self.draw(scene.draw_sets().map(|set| (set, set.batches().solid())), gpu, pass);
    }

    /// Draws the blended surfaces, from back to front.
    pub fn draw_blended(&self, scene: &Scene, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>) {
        self.draw(scene.blended_runs(), gpu, pass);
    }

    fn draw<'s>(
        &self,
        runs: impl Iterator<Item = (&'s DrawSet, &'s [DrawBatch])>,
        gpu: &Gpu,
        pass: &mut wgpu::RenderPass<'_>,
    ) {
        let Some(ModelResources { pipelines, contents, .. }) = &self.resources else { return };
        let mut recorder = DrawRecorder::new(pass, &gpu.frame_group);
        for (set, batches) in runs.filter(|run| !run.1.is_empty()) {
            if let Some(content) = content_of(contents, set.loaded()) {
                content.draw(set, batches, pipelines, &mut recorder);
            }
        }
        self.counts.set(self.counts.get() + recorder.counts());
    }
}

/// Returns the resources of a model.
fn content_of<'a>(contents: &'a [ModelContent], loaded: &Arc<LoadedModel>) -> Option<&'a ModelContent> {
    contents.iter().find(|content| Arc::ptr_eq(content.loaded(), loaded))
}

/// Returns the resources of the model that ghosts are of.
fn content_of_ghosts<'a>(contents: &'a [ModelContent], ghosts: &GhostSkins) -> Option<&'a ModelContent> {
    content_of(contents, ghosts.posed()?.loaded())
}

impl ModelResources {
    /// Drops the resources of models that are not shown any more, and with them their textures.
    fn forget_others(&mut self, shown: &[Arc<LoadedModel>]) {
        let before = self.contents.len();
        self.contents.retain(|content| shown.iter().any(|loaded| Arc::ptr_eq(loaded, content.loaded())));
        if self.contents.len() < before {
            self.ghosts.forget();
        }
    }

    /// Writes the poses of a model, which is loaded first unless it is known.
    fn write(&mut self, gpu: &Gpu, set: &DrawSet, budget: &mut PixelBudget, warnings: &mut Vec<String>) {
        let known = self.contents.iter().position(|content| Arc::ptr_eq(content.loaded(), set.loaded()));
        let at = known.unwrap_or_else(|| {
            for item in set.items() {
                self.make_pipelines(gpu, item, false);
            }
            let (content, smaller) = ModelContent::new(gpu, &self.pipelines, &mut self.maker, set);
            warnings.extend(smaller);
            self.contents.push(content);
            self.contents.len() - 1
        });
        let Self { pipelines, maker, materials, contents, .. } = self;
        contents[at].upload(gpu, maker, materials, budget, warnings);
        contents[at].write(gpu, pipelines, set);
        for batch in set.batches().solid().iter().chain(set.batches().blended()) {
            self.make_pipelines(gpu, &set.items()[batch.item], batch.mirrored);
        }
    }

    /// Creates the pipelines of `item`, unless they exist.
    fn make_pipelines(&mut self, gpu: &Gpu, item: &DrawItem, mirrored: bool) {
        for cull in culls(item) {
            self.pipelines.make(gpu, kind(item, mirrored, *cull));
        }
    }
}

/// Face culling of each drawing of an item: of a blended, double-sided surface the far side is drawn first.
fn culls(item: &DrawItem) -> &'static [Cull] {
    match (item.blend, item.double_sided) {
        (_, false) => &[Cull::Back],
        (false, true) => &[Cull::Nothing],
        (true, true) => &[Cull::Front, Cull::Back],
    }
}

fn kind(item: &DrawItem, mirrored: bool, cull: Cull) -> PipelineKind {
    PipelineKind { mask: item.mask, blend: item.blend, cull, mirrored }
}
