//! Models on the device. Several passes share them: solid surfaces are drawn before the ground, blended ones after it, and both into the maps
//! of shadows before that.

mod caster;
mod content;
mod geometry;
mod ghost;
mod groups;
mod image_plan;
mod images;
mod material;
mod pipeline;
mod recorder;
mod skin;
mod texture;

use super::batch::{DrawBatch, DrawBatches};
use super::device::DeviceListener;
use super::draw_set::{DrawItem, DrawSet};
use super::ghosts::GhostSkins;
use super::gpu::Gpu;
use super::scene::Scene;
use super::shadow::ShadowMaps;
use caster::{CasterKind, CasterPipelines};
use content::ModelContent;
use dragonfly_document::LoadedModel;
use images::PixelBudget;
use material::GpuMaterials;
use pipeline::{Cull, ModelPipelines, PipelineKind, ShaderVariant};
use recorder::{DrawCounts, DrawRecorder};
use skin::{SKIN_BUDGET, SkinPipeline};
use std::cell::Cell;
use std::collections::BTreeSet;
use std::sync::Arc;
use texture::TextureMaker;

/// The models of the scene on the device: the one that is shown, or those of all things of a script.
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
    /// Number of draw calls for the maps of shadows since then.
    shadow_draws: Cell<usize>,
    /// Number of bytes of vertices that may be posed once for several passes.
    skin_budget: u64,
}

/// Device resources for any model.
struct ModelResources {
    pipelines: ModelPipelines,
    maker: TextureMaker,
    materials: GpuMaterials,
    /// For frames with shadows; `None` before the first.
    skins: Option<SkinPipeline>,
    casters: Option<CasterPipelines>,
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
        let pipelines = ModelPipelines::new(gpu);
        let maker = TextureMaker::new(gpu);
        let (contents, ghosts) = (Vec::new(), ghost::Ghosts::default());
        let (skins, casters) = (None, None);
        self.resources =
            Some(ModelResources { pipelines, maker, materials, skins, casters, contents, ghosts });
    }
}

impl Default for GpuModel {
    fn default() -> Self {
        Self {
            resources: None,
            loads_at_once: false,
            shown: Vec::new(),
            warnings: BTreeSet::new(),
            new_warnings: Vec::new(),
            counts: Cell::default(),
            shadow_draws: Cell::default(),
            skin_budget: SKIN_BUDGET,
        }
    }
}

impl GpuModel {
    /// Writes this frame's poses to the device; models that are new are loaded first. Where lamps cast shadows, vertices that several passes draw
    /// are posed once for all of them.
    pub(crate) fn prepare(&mut self, gpu: &Gpu, scene: &Scene, shadows: &ShadowMaps) {
        self.counts.set(DrawCounts::default());
        self.shadow_draws.set(0);
        self.keep_shown(scene);
        let Some(resources) = &mut self.resources else { return };
        let mut warnings = Vec::new();
        let mut budget = PixelBudget::new(if self.loads_at_once { u64::MAX } else { PIXELS_PER_FRAME });
        resources.forget_others(&self.shown);
        let layout = shadows.layout().filter(|_| scene.shadows().is_some());
        for set in scene.draw_sets() {
            resources.write(gpu, set, &mut budget, &mut warnings);
        }
        resources.prepare_shadows(gpu, scene, layout.is_some().then_some(self.skin_budget));
        for set in scene.draw_sets() {
            resources.make_drawn(gpu, set, layout);
        }
        resources.submit_posed(gpu);
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

    /// Number of draw calls for the maps of shadows in this frame.
    pub fn shadow_draws(&self) -> usize {
        self.shadow_draws.get()
    }

    /// Number of vertices that this frame posed once for several passes.
    pub fn skinned_vertices(&self) -> u64 {
        let contents = self.resources.as_ref().map_or(&[][..], |resources| &resources.contents);
        contents.iter().map(ModelContent::skinned_vertices).sum()
    }

    /// Sets how many bytes of vertices may be posed once for several passes.
    pub fn set_skin_budget(&mut self, bytes: u64) {
        self.skin_budget = bytes;
    }

    /// Draws what casts shadows into map number `map`.
    pub(crate) fn draw_casters(&self, scene: &Scene, map: usize, pass: &mut wgpu::RenderPass<'_>) {
        let Some(ModelResources { casters: Some(casters), contents, .. }) = &self.resources else { return };
        let (view, offset) = casters.view(map);
        let mut recorder = DrawRecorder::at(pass, view, &[offset]);
        for set in scene.draw_sets() {
            if let Some(content) = content_of(contents, set.loaded()) {
                content.draw_casters(set, map, casters, &mut recorder);
            }
        }
        self.shadow_draws.set(self.shadow_draws.get() + recorder.counts().draws);
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
    pub(crate) fn draw_solid(
        &self,
        scene: &Scene,
        gpu: &Gpu,
        shadows: &ShadowMaps,
        pass: &mut wgpu::RenderPass<'_>,
    ) {
        self.draw(scene.draw_sets().map(|set| (set, set.batches().solid())), gpu, shadows, pass);
    }

    /// Draws the blended surfaces, from back to front.
    pub(crate) fn draw_blended(
        &self,
        scene: &Scene,
        gpu: &Gpu,
        shadows: &ShadowMaps,
        pass: &mut wgpu::RenderPass<'_>,
    ) {
        self.draw(scene.blended_runs(), gpu, shadows, pass);
    }

    fn draw<'s>(
        &self,
        runs: impl Iterator<Item = (&'s DrawSet, &'s [DrawBatch])>,
        gpu: &Gpu,
        shadows: &ShadowMaps,
        pass: &mut wgpu::RenderPass<'_>,
    ) {
        let Some(ModelResources { pipelines, contents, .. }) = &self.resources else { return };
        let mut recorder = DrawRecorder::new(pass, &gpu.frame_group);
        for (set, batches) in runs.filter(|run| !run.1.is_empty()) {
            if let Some(content) = content_of(contents, set.loaded()) {
                content.draw(set, batches, pipelines, shadows.group(), &mut recorder);
            }
        }
        self.counts.set(self.counts.get() + recorder.counts());
    }
}

/// Returns the resources of a model.
fn content_of<'a>(contents: &'a [ModelContent], loaded: &Arc<LoadedModel>) -> Option<&'a ModelContent> {
    contents.iter().find(|content| Arc::ptr_eq(content.loaded(), loaded))
}

/// Returns the resources of a model, to be changed.
fn content_of_mut<'a>(
    contents: &'a mut [ModelContent],
    loaded: &Arc<LoadedModel>,
) -> Option<&'a mut ModelContent> {
    contents.iter_mut().find(|content| Arc::ptr_eq(content.loaded(), loaded))
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
            let (content, smaller) = ModelContent::new(gpu, &self.pipelines, &mut self.maker, set);
            warnings.extend(smaller);
            self.contents.push(content);
            self.contents.len() - 1
        });
        let Self { pipelines, maker, materials, contents, .. } = self;
        contents[at].upload(gpu, maker, materials, budget, warnings);
        contents[at].write(gpu, pipelines, set);
    }

    /// Writes what the maps of shadows need, and lists the vertices to pose once for all passes, up to `budget` bytes; without a budget the frame
    /// has no shadows.
    fn prepare_shadows(&mut self, gpu: &Gpu, scene: &Scene, budget: Option<u64>) {
        let Self { pipelines, materials, skins, casters, contents, .. } = self;
        let shadows = scene.shadows().filter(|_| budget.is_some());
        let mut budget = budget.unwrap_or(0);
        if shadows.is_some() && gpu.skins_once && skins.is_none() {
            *skins = Some(SkinPipeline::new(gpu, pipelines));
        }
        let skins = skins.as_ref().filter(|_| shadows.is_some());
        for set in scene.draw_sets() {
            if let Some(content) = content_of_mut(contents, set.loaded()) {
                content.list_posed(gpu, pipelines, skins, set, &mut budget);
            }
        }
        let Some(shadows) = shadows else { return };
        let casters = casters.get_or_insert_with(|| CasterPipelines::new(gpu));
        casters.write(gpu, shadows);
        let maps = shadows.maps().count();
        for set in scene.draw_sets() {
            let Some(content) = content_of_mut(contents, set.loaded()) else { continue };
            content.write_casters(gpu, set, maps);
            for batch in (0..maps).filter_map(|map| set.casters(map)).flat_map(DrawBatches::solid) {
                let item = &set.items()[batch.item];
                let kind = CasterKind::of(item, content.is_posed(item));
                casters.make(gpu, kind, pipelines, &materials.layout);
            }
        }
    }

    /// Creates the pipelines of the draw calls of a set, unless they exist; `shadows` is the layout of bind group 3 in a frame with shadows.
    fn make_drawn(&mut self, gpu: &Gpu, set: &DrawSet, shadows: Option<&wgpu::BindGroupLayout>) {
        let Self { pipelines, materials, contents, .. } = self;
        let Some(content) = content_of_mut(contents, set.loaded()) else { return };
        let is_first = content.is_first_with(shadows.is_some());
        let mut make = |item: &DrawItem, mirrored| {
            let variant = ShaderVariant::of(shadows.is_some(), content.is_posed(item));
            for cull in culls(item) {
                let kind = kind(item, mirrored, *cull, variant);
                pipelines.make(gpu, kind, &materials.layout, shadows);
            }
        };
        if is_first {
            // Also those of what is out of view, so that it need not wait when it comes into it.
            set.items().iter().for_each(|item| make(item, false));
        }
        for batch in set.batches().solid().iter().chain(set.batches().blended()) {
            make(&set.items()[batch.item], batch.mirrored);
        }
    }

    /// Poses the vertices that were listed, at once: in a frame that is never submitted they would count as posed.
    fn submit_posed(&self, gpu: &Gpu) {
        let is_listed = |content: &ModelContent| content.skinned_vertices() > 0;
        let Some(skins) = self.skins.as_ref().filter(|_| self.contents.iter().any(is_listed)) else {
            return;
        };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let descriptor = wgpu::ComputePassDescriptor { label: Some("skin"), timestamp_writes: None };
        let mut pass = encoder.begin_compute_pass(&descriptor);
        for content in self.contents.iter().filter(|content| is_listed(content)) {
            content.record_posed(skins, &mut pass);
        }
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
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

fn kind(item: &DrawItem, mirrored: bool, cull: Cull, variant: ShaderVariant) -> PipelineKind {
    PipelineKind { mask: item.mask, blend: item.blend, cull, mirrored, variant }
}
