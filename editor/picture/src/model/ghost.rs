//! Drawing ghosts: the surface of the model once more for each ghost, with the same triangles, other matrices and one
//! color.

use super::geometry::{GpuGeometry, VERTICES};
use super::groups::DrawGroups;
use super::pipeline::ModelPipelines;
use super::recorder::DrawRecorder;
use crate::ghosts::GhostSkins;
use crate::gpu::{Gpu, scene_depth};
use crate::shaders;
use crate::uniform::{Affine, DrawInstance};
use dragonfly_document::LoadedModel;
use std::collections::HashMap;
use std::sync::Arc;

/// Device resources of ghosts.
#[derive(Default)]
pub(super) struct Ghosts {
    /// Pipelines for front faces of either winding; the second is for mirrored poses.
    pipelines: Option<[wgpu::RenderPipeline; 2]>,
    room: Option<GhostBuffers>,
    /// Number of ghosts drawn.
    count: usize,
    /// Their instances, with indices into the buffers of the device.
    instances: Vec<DrawInstance>,
}

/// Buffers for a number of ghosts of one model.
struct GhostBuffers {
    loaded: Arc<LoadedModel>,
    ghosts: usize,
    instances: wgpu::Buffer,
    palettes: wgpu::Buffer,
    weights: wgpu::Buffer,
    groups: DrawGroups,
}

impl Ghosts {
    /// Drops the buffers, because another model is shown.
    pub(super) fn forget(&mut self) {
        (self.room, self.count) = (None, 0);
    }

    /// Writes the poses to the device.
    pub(super) fn prepare(
        &mut self,
        gpu: &Gpu,
        ghosts: &GhostSkins,
        pipelines: &ModelPipelines,
        geometries: &HashMap<(u32, u32), GpuGeometry>,
    ) {
        self.count = 0;
        let Some(posed) = ghosts.posed().filter(|posed| !ghosts.is_empty() && !posed.items().is_empty())
        else {
            return;
        };
        // No more ghosts than one buffer can contain.
        let limits = gpu.device.limits();
        let largest = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) as usize;
        let own = size_of_val::<[Affine]>(posed.palettes())
            .max(size_of_val::<[f32]>(posed.weights()))
            .max(size_of::<DrawInstance>() * posed.items().len());
        let count = ghosts.len().min(largest / own.max(1));
        if count == 0 {
            return;
        }
        let fits = |room: &GhostBuffers| Arc::ptr_eq(&room.loaded, posed.loaded()) && room.ghosts >= count;
        if !self.room.as_ref().is_some_and(fits) {
            let Some(room) = GhostBuffers::new(gpu, ghosts, count, pipelines, geometries) else { return };
            self.room = Some(room);
        }
        self.pipelines.get_or_insert_with(|| {
            let layout = gpu.pipeline_layout("ghost", &[pipelines.draw_layout()]);
            [wgpu::FrontFace::Ccw, wgpu::FrontFace::Cw].map(|front| pipeline(gpu, &layout, front))
        });
        let Some(room) = &self.room else { return };
        let (matrices, weights) = (posed.palettes().len(), posed.weights().len());
        // The nearest ghosts are the last.
        let first = ghosts.len() - count;
        gpu.queue.write_buffer(
            &room.palettes,
            0,
            bytemuck::cast_slice(&ghosts.palettes()[first * matrices..]),
        );
        gpu.queue.write_buffer(&room.weights, 0, bytemuck::cast_slice(&ghosts.weights()[first * weights..]));
        let begin = first_instance(ghosts, first);
        self.instances.clear();
        self.instances.extend(ghosts.instances()[begin..].iter().map(|instance| DrawInstance {
            palette: instance.palette - (first * matrices) as u32,
            morph_weights: instance.morph_weights - (first * weights) as u32,
            ..*instance
        }));
        gpu.queue.write_buffer(&room.instances, 0, bytemuck::cast_slice(&self.instances));
        self.count = count;
    }

    /// Draws the ghosts.
    pub(super) fn draw<'a>(
        &'a self,
        ghosts: &GhostSkins,
        geometries: &'a HashMap<(u32, u32), GpuGeometry>,
        recorder: &mut DrawRecorder<'a, '_>,
    ) {
        let (Some(room), Some(pipelines), Some(posed)) = (&self.room, &self.pipelines, ghosts.posed()) else {
            return;
        };
        let first = ghosts.len().saturating_sub(self.count);
        let begin = first_instance(ghosts, first) as u32;
        recorder.instances(&room.instances);
        for batch in ghosts.batches_from(first) {
            let part = posed.items()[batch.item].part();
            let Some(geometry) = geometries.get(&part) else { continue };
            recorder.group(1, room.groups.get(part));
            let instances = batch.instances.start - begin..batch.instances.end - begin;
            recorder.draw(&pipelines[usize::from(batch.mirrored)], geometry, instances);
        }
    }
}

/// Returns the first instance of ghost number `ghost` and of those after it.
fn first_instance(ghosts: &GhostSkins, ghost: usize) -> usize {
    let batch = ghosts.batches_from(ghost).first();
    batch.map_or(ghosts.instances().len(), |batch| batch.instances.start as usize)
}

impl GhostBuffers {
    fn new(
        gpu: &Gpu,
        ghosts: &GhostSkins,
        count: usize,
        pipelines: &ModelPipelines,
        geometries: &HashMap<(u32, u32), GpuGeometry>,
    ) -> Option<Self> {
        let posed = ghosts.posed()?;
        let buffer = |label, size, usage| gpu.buffer(label, size, usage);
        let storage = wgpu::BufferUsages::STORAGE;
        let palettes = buffer("ghosts", count * size_of_val::<[Affine]>(posed.palettes()), storage);
        let weights = buffer("ghosts' weights", count * size_of_val::<[f32]>(posed.weights()), storage);
        let size = size_of::<DrawInstance>() * posed.items().len() * count;
        let instances = buffer("ghosts' instances", size, wgpu::BufferUsages::VERTEX);
        let groups = DrawGroups::new(gpu, pipelines, &palettes, &weights, geometries);
        let loaded = Arc::clone(posed.loaded());
        Some(Self { loaded, ghosts: count, groups, instances, palettes, weights })
    }
}

/// Surfaces in front of a ghost hide it; the ghost itself hides nothing.
fn pipeline(gpu: &Gpu, layout: &wgpu::PipelineLayout, front_face: wgpu::FrontFace) -> wgpu::RenderPipeline {
    let module = shaders::GHOST.module(&gpu.device);
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("ghost"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_ghost"),
            compilation_options: Default::default(),
            buffers: &VERTICES,
        },
        primitive: wgpu::PrimitiveState {
            front_face,
            cull_mode: Some(wgpu::Face::Back),
            ..Default::default()
        },
        depth_stencil: Some(scene_depth(false)),
        multisample: gpu.scene_samples(false),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs_ghost"),
            compilation_options: Default::default(),
            targets: &gpu.scene_target(true),
        }),
        multiview_mask: None,
        cache: None,
    })
}
