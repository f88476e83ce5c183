//! A model on the device. Several passes share it: solid surfaces are drawn before the ground, blended ones after it.

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
use super::ghosts::GhostSkins;
use super::gpu::Gpu;
use super::posed::{DrawItem, PosedModel};
use super::uniform::{Affine, DrawInstance};
use dragonfly_anim::data::Primitive;
use dragonfly_document::LoadedModel;
use geometry::GpuGeometry;
use groups::DrawGroups;
use images::ModelImages;
use material::GpuMaterials;
use pipeline::{Cull, ModelPipelines, PipelineKind};
use recorder::{DrawCounts, DrawRecorder};
use std::cell::Cell;
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;
use texture::TextureMaker;

/// The model of the scene on the device.
#[derive(Default)]
pub struct GpuModel {
    /// Kept for loading the model again on another device.
    loaded: Option<Arc<LoadedModel>>,
    resources: Option<ModelResources>,
    /// Whether all images are uploaded before the first frame, and not some with every frame.
    loads_at_once: bool,
    /// Warnings about the images of this model.
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
    content: Option<ModelContent>,
    ghosts: ghost::Ghosts,
}

/// Device resources of this model.
struct ModelContent {
    loaded: Arc<LoadedModel>,
    images: ModelImages,
    palettes: wgpu::Buffer,
    weights: wgpu::Buffer,
    /// The instances of all draw calls of a frame.
    instances: wgpu::Buffer,
    /// Geometry by mesh and primitive.
    geometries: HashMap<(u32, u32), GpuGeometry>,
    groups: DrawGroups,
}

/// Number of pixels that are decoded in one frame: a large image, or many small ones.
const PIXELS_PER_FRAME: u64 = 4 << 20;

impl DeviceListener for GpuModel {
    fn on_lost(&mut self) {
        self.resources = None;
    }

    fn on_reset(&mut self, gpu: &Gpu) {
        let materials = GpuMaterials::new(gpu);
        let pipelines = ModelPipelines::new(gpu, &materials.layout);
        let maker = TextureMaker::new(gpu);
        self.resources =
            Some(ModelResources { pipelines, maker, materials, content: None, ghosts: Default::default() });
    }
}

impl GpuModel {
    /// Writes this frame's pose to the device; a new model is loaded first.
    pub fn prepare(&mut self, gpu: &Gpu, posed: Option<&PosedModel>) {
        self.counts.set(DrawCounts::default());
        let loaded = posed.map(|posed| Arc::clone(posed.loaded()));
        if self.loaded.as_ref().map(Arc::as_ptr) != loaded.as_ref().map(Arc::as_ptr) {
            self.warnings.clear();
        }
        self.loaded = loaded;
        let (Some(resources), Some(posed)) = (&mut self.resources, posed) else { return };
        let known =
            resources.content.as_ref().is_some_and(|content| Arc::ptr_eq(&content.loaded, posed.loaded()));
        let mut warnings = Vec::new();
        if !known {
            resources.load(gpu, posed, &mut warnings);
        }
        resources.upload(gpu, if self.loads_at_once { u64::MAX } else { PIXELS_PER_FRAME }, &mut warnings);
        // A model that is loaded again on another device has the same warnings.
        self.new_warnings
            .extend(warnings.into_iter().filter(|warning| self.warnings.insert(warning.clone())));
        if let Some(content) = &resources.content {
            gpu.queue.write_buffer(&content.palettes, 0, bytemuck::cast_slice(posed.palettes()));
            gpu.queue.write_buffer(&content.weights, 0, bytemuck::cast_slice(posed.weights()));
            let instances = posed.batches().instances();
            gpu.queue.write_buffer(&content.instances, 0, bytemuck::cast_slice(instances));
        }
        for batch in posed.batches().solid().iter().chain(posed.batches().blended()) {
            resources.make_pipelines(gpu, &posed.items()[batch.item], batch.mirrored);
        }
    }

    /// Sets whether all images are uploaded before the first frame of a model, and not some with every frame.
    pub fn load_at_once(&mut self, at_once: bool) {
        self.loads_at_once = at_once;
    }

    /// Returns whether images of the model wait for the next frame.
    pub fn is_loading(&self) -> bool {
        let content = self.resources.as_ref().and_then(|resources| resources.content.as_ref());
        content.is_some_and(|content| content.images.is_loading())
    }

    /// Returns the warnings about the images of the model since the last call, each once also if the device was lost.
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
        let Some(ModelResources { pipelines, content: Some(content), ghosts: own, .. }) = &mut self.resources
        else {
            return;
        };
        own.prepare(gpu, ghosts, pipelines, &content.geometries);
    }

    /// Draws the ghosts.
    pub fn draw_ghosts(&self, ghosts: &GhostSkins, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(ModelResources { content: Some(content), ghosts: own, .. }) = &self.resources {
            let mut recorder = DrawRecorder::new(pass, &gpu.frame_group);
            own.draw(ghosts, &content.geometries, &mut recorder);
            self.counts.set(self.counts.get() + recorder.counts());
        }
    }

    /// Draws the solid surfaces.
    pub fn draw_solid(&self, posed: &PosedModel, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>) {
        self.draw(posed, posed.batches().solid(), gpu, pass);
    }

    /// Draws the blended surfaces, from back to front.
    pub fn draw_blended(&self, posed: &PosedModel, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>) {
        self.draw(posed, posed.batches().blended(), gpu, pass);
    }

    fn draw(&self, posed: &PosedModel, batches: &[DrawBatch], gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>) {
        let Some(ModelResources { pipelines, materials, content: Some(content), .. }) = &self.resources
        else {
            return;
        };
        let mut recorder = DrawRecorder::new(pass, &gpu.frame_group);
        recorder.instances(&content.instances);
        for batch in batches {
            let item = &posed.items()[batch.item];
            let part = item.part();
            let Some(geometry) = content.geometries.get(&part) else { continue };
            let Some(material) = materials.get(item.material) else { continue };
            recorder.group(1, content.groups.get(part));
            recorder.group(2, material);
            for cull in culls(item) {
                if let Some(pipeline) = pipelines.get(kind(item, batch.mirrored, *cull)) {
                    recorder.draw(pipeline, geometry, batch.instances.clone());
                }
            }
        }
        self.counts.set(self.counts.get() + recorder.counts());
    }
}

impl ModelResources {
    fn load(&mut self, gpu: &Gpu, posed: &PosedModel, warnings: &mut Vec<String>) {
        let loaded = posed.loaded();
        // The textures of the model before are dropped first.
        self.content = None;
        self.materials.forget();
        let (images, smaller) = ModelImages::new(gpu, &mut self.maker, loaded);
        warnings.extend(smaller);
        self.materials.bind(gpu, loaded, &images);
        self.ghosts.forget();
        let buffer = |label, size, usage| gpu.buffer(label, size, usage);
        let palettes =
            buffer("palettes", size_of_val::<[Affine]>(posed.palettes()), wgpu::BufferUsages::STORAGE);
        let weights =
            buffer("morph weights", size_of_val::<[f32]>(posed.weights()), wgpu::BufferUsages::STORAGE);
        let size = size_of::<DrawInstance>() * posed.items().len().max(1);
        let instances = buffer("instances", size, wgpu::BufferUsages::VERTEX);
        let mut geometries = HashMap::new();
        for item in posed.items() {
            geometries.entry(item.part()).or_insert_with(|| {
                self.make_pipelines(gpu, item, false);
                GpuGeometry::new(&gpu.device, primitive(loaded, item))
            });
        }
        let groups = DrawGroups::new(gpu, &self.pipelines, &palettes, &weights, &geometries);
        let loaded = Arc::clone(loaded);
        self.content =
            Some(ModelContent { loaded, images, palettes, weights, instances, geometries, groups });
    }

    /// Uploads the next images of the model.
    fn upload(&mut self, gpu: &Gpu, pixels: u64, warnings: &mut Vec<String>) {
        if let Some(ModelContent { loaded, images, .. }) = &mut self.content
            && images.is_loading()
        {
            warnings.extend(images.upload(gpu, &mut self.maker, loaded, pixels));
            self.materials.bind(gpu, loaded, images);
        }
    }

    /// Creates the pipelines of `item`, unless they exist.
    fn make_pipelines(&mut self, gpu: &Gpu, item: &DrawItem, mirrored: bool) {
        for cull in culls(item) {
            self.pipelines.make(gpu, kind(item, mirrored, *cull));
        }
    }
}

fn primitive<'a>(loaded: &'a LoadedModel, item: &DrawItem) -> &'a Primitive {
    &loaded.model.meshes[item.mesh as usize].primitives[item.primitive as usize]
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
