//! A model on the device. Several passes share it: solid surfaces are drawn before the ground, blended ones after it.

mod geometry;
mod ghost;
mod material;
mod pipeline;
mod texture;

use super::device::DeviceListener;
use super::ghosts::GhostSkins;
use super::gpu::Gpu;
use super::posed::{DrawItem, PosedModel};
use super::uniform::{Affine, DrawUniform};
use dragonfly_anim::data::{AlphaMode, Primitive};
use dragonfly_document::LoadedModel;
use geometry::GpuGeometry;
use material::GpuMaterials;
use pipeline::{Cull, ModelPipelines, PipelineKind};
use std::cell::Cell;
use std::collections::HashMap;
use std::sync::Arc;
use texture::TextureMaker;

/// The model of the scene on the device.
#[derive(Default)]
pub struct GpuModel {
    /// Kept for loading the model again on another device.
    loaded: Option<Arc<LoadedModel>>,
    resources: Option<ModelResources>,
    /// Draw calls since the last [`Self::prepare`].
    draws: Cell<usize>,
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
    palettes: wgpu::Buffer,
    weights: wgpu::Buffer,
    /// Distance between draw uniforms, bytes.
    stride: u32,
    /// Geometry by mesh and primitive.
    geometries: HashMap<(u32, u32), GpuGeometry>,
    /// Bind groups 1, by mesh and primitive; the number of the item is their offset.
    groups: HashMap<(u32, u32), wgpu::BindGroup>,
}

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
        self.draws.set(0);
        self.loaded = posed.map(|posed| Arc::clone(posed.loaded()));
        let (Some(resources), Some(posed)) = (&mut self.resources, posed) else { return };
        let known =
            resources.content.as_ref().is_some_and(|content| Arc::ptr_eq(&content.loaded, posed.loaded()));
        if !known {
            resources.load(gpu, posed);
        }
        if let Some(content) = &resources.content {
            gpu.queue.write_buffer(&content.palettes, 0, bytemuck::cast_slice(posed.palettes()));
            gpu.queue.write_buffer(&content.weights, 0, bytemuck::cast_slice(posed.weights()));
        }
        for item in posed.items() {
            for cull in culls(posed, item) {
                resources.pipelines.make(gpu, kind(posed, item, *cull));
            }
        }
    }

    /// Number of draw calls for surfaces in this frame; all other passes together need a constant number.
    pub fn draws(&self) -> usize {
        self.draws.get()
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
            own.draw(gpu, ghosts, &content.geometries, pass);
        }
    }

    /// Draws the solid surfaces.
    pub fn draw_solid(&self, posed: &PosedModel, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>) {
        for (index, item) in posed.items().iter().enumerate().filter(|(_, item)| !item.blend) {
            self.draw(posed, index, item, gpu, pass);
        }
    }

    /// Draws the blended surfaces, from back to front.
    pub fn draw_blended(&self, posed: &PosedModel, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>) {
        for index in posed.back_to_front() {
            self.draw(posed, index, &posed.items()[index], gpu, pass);
        }
    }

    fn draw(
        &self,
        posed: &PosedModel,
        index: usize,
        item: &DrawItem,
        gpu: &Gpu,
        pass: &mut wgpu::RenderPass<'_>,
    ) {
        let Some(resources) = &self.resources else { return };
        let Some(content) = &resources.content else { return };
        let part = (item.mesh, item.primitive);
        let (Some(geometry), Some(group)) = (content.geometries.get(&part), content.groups.get(&part)) else {
            return;
        };
        let Some(material) = resources.materials.get(item.material) else { return };
        pass.set_bind_group(0, &gpu.frame_group, &[]);
        pass.set_bind_group(1, group, &[index as u32 * content.stride]);
        pass.set_bind_group(2, material, &[]);
        pass.set_vertex_buffer(0, geometry.vertices.slice(..));
        pass.set_index_buffer(geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
        for cull in culls(posed, item) {
            if let Some(pipeline) = resources.pipelines.get(kind(posed, item, *cull)) {
                pass.set_pipeline(pipeline);
                pass.draw_indexed(0..geometry.count, 0, 0..1);
                self.draws.set(self.draws.get() + 1);
            }
        }
    }
}

impl ModelResources {
    fn load(&mut self, gpu: &Gpu, posed: &PosedModel) {
        let loaded = posed.loaded();
        self.materials.load(gpu, &mut self.maker, loaded);
        self.ghosts.forget();
        let buffer = |label, size, usage| gpu.buffer(label, size, usage);
        let palettes =
            buffer("palettes", size_of_val::<[Affine]>(posed.palettes()), wgpu::BufferUsages::STORAGE);
        let weights =
            buffer("morph weights", size_of_val::<[f32]>(posed.weights()), wgpu::BufferUsages::STORAGE);
        let nothing = buffer("no morph deltas", 36, wgpu::BufferUsages::STORAGE);
        let stride = ghost::stride(gpu);
        let uniforms =
            buffer("draws", stride as usize * posed.items().len().max(1), wgpu::BufferUsages::UNIFORM);
        // Written at once: a write per item would stage each of them separately.
        let mut bytes = vec![0; stride as usize * posed.items().len()];
        let (mut geometries, mut groups) = (HashMap::new(), HashMap::new());
        for (item, place) in posed.items().iter().zip(bytes.chunks_exact_mut(stride as usize)) {
            place[..size_of::<DrawUniform>()].copy_from_slice(bytemuck::bytes_of(&item.uniform));
            let part = (item.mesh, item.primitive);
            let geometry = geometries
                .entry(part)
                .or_insert_with(|| GpuGeometry::new(&gpu.device, primitive(loaded, item)));
            let deltas = geometry.deltas.as_ref().unwrap_or(&nothing);
            let group = || self.pipelines.draw_group(gpu, &uniforms, &palettes, &weights, deltas);
            groups.entry(part).or_insert_with(group);
        }
        gpu.queue.write_buffer(&uniforms, 0, &bytes);
        self.content =
            Some(ModelContent { loaded: Arc::clone(loaded), palettes, weights, stride, geometries, groups });
    }
}

fn primitive<'a>(loaded: &'a LoadedModel, item: &DrawItem) -> &'a Primitive {
    &loaded.model.meshes[item.mesh as usize].primitives[item.primitive as usize]
}

/// Face culling of each drawing of an item: of a blended, double-sided surface the far side is drawn first.
fn culls(posed: &PosedModel, item: &DrawItem) -> &'static [Cull] {
    let materials = &posed.loaded().model.materials;
    let material = item.material.and_then(|material| materials.get(material as usize));
    match (item.blend, material.is_some_and(|material| material.double_sided)) {
        (_, false) => &[Cull::Back],
        (false, true) => &[Cull::Nothing],
        (true, true) => &[Cull::Front, Cull::Back],
    }
}

fn kind(posed: &PosedModel, item: &DrawItem, cull: Cull) -> PipelineKind {
    let materials = &posed.loaded().model.materials;
    let material = item.material.and_then(|material| materials.get(material as usize));
    let mask = material.is_some_and(|material| matches!(material.alpha_mode, AlphaMode::Mask(_)));
    PipelineKind { mask, blend: item.blend, cull, mirrored: posed.is_mirrored(item) }
}
