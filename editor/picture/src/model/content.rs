//! One model on the device: its triangles and images, and memory for the poses of its copies.

use super::caster::{CasterKind, CasterPipelines};
use super::geometry::GpuGeometry;
use super::groups::DrawGroups;
use super::images::{ModelImages, PixelBudget};
use super::material::{GpuMaterials, MaterialGroups};
use super::pipeline::{ModelPipelines, ShaderVariant};
use super::recorder::DrawRecorder;
use super::skin::{PosedVertices, SkinPipeline};
use super::texture::TextureMaker;
use super::{culls, kind};
use crate::batch::DrawBatch;
use crate::draw_set::{DrawItem, DrawSet, primitives};
use crate::gpu::Gpu;
use crate::uniform::{Affine, DrawInstance, NOT_POSED, POSED_BYTES};
use dragonfly_document::LoadedModel;
use std::collections::HashMap;
use std::sync::Arc;

/// Device resources of a model.
pub(super) struct ModelContent {
    loaded: Arc<LoadedModel>,
    images: ModelImages,
    /// `None` until the first images are there.
    materials: Option<MaterialGroups>,
    /// Geometry by mesh and primitive.
    geometries: HashMap<(u32, u32), GpuGeometry>,
    poses: PoseBuffers,
    /// Vertices that are posed once for several passes; `None` where each pass poses them.
    posed: Option<PosedVertices>,
    /// The instances of all draw calls of the maps of shadows, map after map; `None` before the first.
    casters: Option<wgpu::Buffer>,
    /// Whether the frame drawn last had shadows; `None` before the first.
    shadowed: Option<bool>,
    /// Revision of the matrices and weights that the device has.
    revision: Option<(u64, u64)>,
}

/// Memory for the poses of a number of copies.
struct PoseBuffers {
    palettes: wgpu::Buffer,
    weights: wgpu::Buffer,
    /// The instances of all draw calls of a frame.
    instances: wgpu::Buffer,
    groups: DrawGroups,
}

impl PoseBuffers {
    fn new(
        gpu: &Gpu,
        pipelines: &ModelPipelines,
        geometries: &HashMap<(u32, u32), GpuGeometry>,
        set: &DrawSet,
    ) -> Self {
        let storage = wgpu::BufferUsages::STORAGE;
        let palettes = gpu.buffer("palettes", size_of_val::<[Affine]>(set.palettes()), storage);
        let weights = gpu.buffer("morph weights", size_of_val::<[f32]>(set.weights()), storage);
        let size = size_of::<DrawInstance>() * set.items().len().max(1);
        let instances = gpu.buffer("instances", size, wgpu::BufferUsages::VERTEX);
        let groups = DrawGroups::new(gpu, pipelines, &palettes, &weights, geometries);
        Self { palettes, weights, instances, groups }
    }

    fn has_room_for(&self, set: &DrawSet) -> bool {
        let fits = |buffer: &wgpu::Buffer, bytes: usize| buffer.size() >= bytes as u64;
        fits(&self.palettes, size_of_val::<[Affine]>(set.palettes()))
            && fits(&self.weights, size_of_val::<[f32]>(set.weights()))
            && fits(&self.instances, size_of::<DrawInstance>() * set.items().len())
    }
}

impl ModelContent {
    /// Loads the model of `set`. Returns also a warning if images will be shown smaller.
    pub(super) fn new(
        gpu: &Gpu,
        pipelines: &ModelPipelines,
        maker: &mut TextureMaker,
        set: &DrawSet,
    ) -> (Self, Option<String>) {
        let loaded = Arc::clone(set.loaded());
        let (images, smaller) = ModelImages::new(gpu, maker, &loaded);
        let mut geometries = HashMap::new();
        for item in set.items() {
            if let Some(primitive) = primitives(&loaded.model, item.mesh).get(item.primitive as usize) {
                geometries.entry(item.part()).or_insert_with(|| GpuGeometry::new(gpu, primitive));
            }
        }
        let poses = PoseBuffers::new(gpu, pipelines, &geometries, set);
        let content = Self {
            loaded,
            images,
            materials: None,
            geometries,
            poses,
            posed: None,
            casters: None,
            shadowed: None,
            revision: None,
        };
        (content, smaller)
    }

    /// The model.
    pub(super) fn loaded(&self) -> &Arc<LoadedModel> {
        &self.loaded
    }

    /// Geometry by mesh and primitive.
    pub(super) fn geometries(&self) -> &HashMap<(u32, u32), GpuGeometry> {
        &self.geometries
    }

    /// Returns whether this is the first frame, or the first with or without shadows after others.
    pub(super) fn is_first_with(&mut self, shadows: bool) -> bool {
        self.shadowed.replace(shadows) != Some(shadows)
    }

    /// Returns whether images wait for the next frame.
    pub(super) fn is_loading(&self) -> bool {
        self.images.is_loading()
    }

    /// Uploads the next images, as far as the budget of the frame goes.
    pub(super) fn upload(
        &mut self,
        gpu: &Gpu,
        maker: &mut TextureMaker,
        materials: &GpuMaterials,
        budget: &mut PixelBudget,
        warnings: &mut Vec<String>,
    ) {
        let is_loading = self.images.is_loading();
        if is_loading {
            warnings.extend(self.images.upload(gpu, maker, &self.loaded, budget));
        }
        if is_loading || self.materials.is_none() {
            self.materials = materials.bind(gpu, &self.loaded, &self.images);
        }
    }

    /// Writes the poses of this frame, unless the device has them, and the instances of its draw calls.
    pub(super) fn write(&mut self, gpu: &Gpu, pipelines: &ModelPipelines, set: &DrawSet) {
        if !self.poses.has_room_for(set) {
            self.poses = PoseBuffers::new(gpu, pipelines, &self.geometries, set);
            self.revision = None;
            self.posed.iter_mut().for_each(PosedVertices::forget);
        }
        if self.revision != Some(set.revision()) {
            gpu.queue.write_buffer(&self.poses.palettes, 0, bytemuck::cast_slice(set.palettes()));
            gpu.queue.write_buffer(&self.poses.weights, 0, bytemuck::cast_slice(set.weights()));
            self.revision = Some(set.revision());
        }
        let instances = set.batches().instances();
        gpu.queue.write_buffer(&self.poses.instances, 0, bytemuck::cast_slice(instances));
    }

    /// Lists the vertices to pose once for all passes of this frame, if they fit into `budget`, which gets less by them. Without `skins`
    /// each pass poses them.
    pub(super) fn list_posed(
        &mut self,
        gpu: &Gpu,
        pipelines: &ModelPipelines,
        skins: Option<&SkinPipeline>,
        set: &DrawSet,
        budget: &mut u64,
    ) {
        let bytes = set.posed_vertices().saturating_mul(POSED_BYTES);
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let readable = |geometry: &GpuGeometry| geometry.vertices.size() <= limit;
        let fits = || (1..=limit.min(*budget)).contains(&bytes) && self.geometries.values().all(readable);
        let Some(skins) = skins.filter(|_| fits()) else {
            self.posed = None;
            return;
        };
        *budget -= bytes;
        if !self.posed.as_ref().is_some_and(|posed| posed.has_room_for(set)) {
            self.posed = None;
        }
        let posed = self.posed.get_or_insert_with(|| PosedVertices::new(gpu, skins, pipelines, set));
        posed.list(gpu, skins, &self.geometries, set);
    }

    /// Number of vertices that this frame poses once for several passes.
    pub(super) fn skinned_vertices(&self) -> u64 {
        self.posed.as_ref().map_or(0, PosedVertices::count)
    }

    /// Records posing what was listed.
    pub(super) fn record_posed(&self, skins: &SkinPipeline, pass: &mut wgpu::ComputePass<'_>) {
        if let Some(posed) = &self.posed {
            posed.record(&self.poses.groups, skins, pass);
        }
    }

    /// Returns whether the vertices of an item were posed before they are drawn.
    pub(super) fn is_posed(&self, item: &DrawItem) -> bool {
        self.posed.is_some() && item.instance.posed != NOT_POSED
    }

    /// Writes the instances of the draw calls of `maps` maps of shadows.
    pub(super) fn write_casters(&mut self, gpu: &Gpu, set: &DrawSet, maps: usize) {
        let one = caster_bytes(set);
        let needed = (one * maps as u64).max(1);
        if self.casters.as_ref().is_none_or(|buffer| buffer.size() < needed) {
            self.casters = Some(gpu.buffer("casters", needed as usize, wgpu::BufferUsages::VERTEX));
        }
        let Some(buffer) = &self.casters else { return };
        for (index, batches) in (0..maps as u64).zip((0..).map_while(|map| set.casters(map))) {
            gpu.queue.write_buffer(buffer, index * one, bytemuck::cast_slice(batches.instances()));
        }
    }

    /// Draws what casts shadows into map number `map`.
    pub(super) fn draw_casters<'a>(
        &'a self,
        set: &DrawSet,
        map: usize,
        pipelines: &'a CasterPipelines,
        recorder: &mut DrawRecorder<'a, '_>,
    ) {
        let (Some(buffer), Some(batches)) = (&self.casters, set.casters(map)) else { return };
        recorder.instances_from(buffer, caster_bytes(set) * map as u64);
        for batch in batches.solid() {
            let item = &set.items()[batch.item];
            let part = item.part();
            let kind = CasterKind::of(item, self.is_posed(item));
            let material = self.materials.as_ref().and_then(|materials| materials.get(item.material));
            let (Some(geometry), Some(material), Some(pipeline)) =
                (self.geometries.get(&part), material, pipelines.get(kind))
            else {
                continue;
            };
            recorder.group(1, self.group_of(item));
            if kind.masked {
                recorder.group(2, material);
            }
            recorder.draw(pipeline, geometry, batch.instances.clone());
        }
    }

    /// Bind group 1 of draws of an item.
    fn group_of(&self, item: &DrawItem) -> &wgpu::BindGroup {
        match &self.posed {
            Some(posed) if item.instance.posed != NOT_POSED => posed.group(),
            Some(_) | None => self.poses.groups.get(item.part()),
        }
    }

    /// Draws some draw calls of `set`; with `shadows`, lamps cast shadows on them.
    pub(super) fn draw<'a>(
        &'a self,
        set: &DrawSet,
        batches: &[DrawBatch],
        pipelines: &'a ModelPipelines,
        shadows: Option<&'a wgpu::BindGroup>,
        recorder: &mut DrawRecorder<'a, '_>,
    ) {
        recorder.instances(&self.poses.instances);
        for batch in batches {
            let item = &set.items()[batch.item];
            let part = item.part();
            let Some(geometry) = self.geometries.get(&part) else { continue };
            let material = self.materials.as_ref().and_then(|materials| materials.get(item.material));
            let Some(material) = material else { continue };
            recorder.group(1, self.group_of(item));
            recorder.group(2, material);
            if let Some(shadows) = shadows {
                recorder.group(3, shadows);
            }
            let variant = ShaderVariant::of(shadows.is_some(), self.is_posed(item));
            for cull in culls(item) {
                if let Some(pipeline) = pipelines.get(kind(item, batch.mirrored, *cull, variant)) {
                    recorder.draw(pipeline, geometry, batch.instances.clone());
                }
            }
        }
    }
}

/// Returns the bytes of the instances of one map of shadows.
fn caster_bytes(set: &DrawSet) -> u64 {
    (size_of::<DrawInstance>() * set.items().len()) as u64
}
