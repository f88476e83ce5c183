//! One model on the device: its triangles and images, and memory for the poses of its copies.

use super::geometry::GpuGeometry;
use super::groups::DrawGroups;
use super::images::{ModelImages, PixelBudget};
use super::material::{GpuMaterials, MaterialGroups};
use super::pipeline::ModelPipelines;
use super::recorder::DrawRecorder;
use super::texture::TextureMaker;
use super::{culls, kind};
use crate::batch::DrawBatch;
use crate::draw_set::{DrawSet, primitives};
use crate::gpu::Gpu;
use crate::uniform::{Affine, DrawInstance};
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
    /// Loads the model of `set`, whose pipelines exist. Returns also a warning if images will be shown smaller.
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
                geometries.entry(item.part()).or_insert_with(|| GpuGeometry::new(&gpu.device, primitive));
            }
        }
        let poses = PoseBuffers::new(gpu, pipelines, &geometries, set);
        (Self { loaded, images, materials: None, geometries, poses, revision: None }, smaller)
    }

    /// The model.
    pub(super) fn loaded(&self) -> &Arc<LoadedModel> {
        &self.loaded
    }

    /// Geometry by mesh and primitive.
    pub(super) fn geometries(&self) -> &HashMap<(u32, u32), GpuGeometry> {
        &self.geometries
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
        }
        if self.revision != Some(set.revision()) {
            gpu.queue.write_buffer(&self.poses.palettes, 0, bytemuck::cast_slice(set.palettes()));
            gpu.queue.write_buffer(&self.poses.weights, 0, bytemuck::cast_slice(set.weights()));
            self.revision = Some(set.revision());
        }
        let instances = set.batches().instances();
        gpu.queue.write_buffer(&self.poses.instances, 0, bytemuck::cast_slice(instances));
    }

    /// Draws some draw calls of `set`.
    pub(super) fn draw<'a>(
        &'a self,
        set: &DrawSet,
        batches: &[DrawBatch],
        pipelines: &'a ModelPipelines,
        recorder: &mut DrawRecorder<'a, '_>,
    ) {
        recorder.instances(&self.poses.instances);
        for batch in batches {
            let item = &set.items()[batch.item];
            let part = item.part();
            let Some(geometry) = self.geometries.get(&part) else { continue };
            let material = self.materials.as_ref().and_then(|materials| materials.get(item.material));
            let Some(material) = material else { continue };
            recorder.group(1, self.poses.groups.get(part));
            recorder.group(2, material);
            for cull in culls(item) {
                if let Some(pipeline) = pipelines.get(kind(item, batch.mirrored, *cull)) {
                    recorder.draw(pipeline, geometry, batch.instances.clone());
                }
            }
        }
    }
}
