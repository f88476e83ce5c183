//! Drawing ghosts: the surface of the model once more for each ghost, with the same triangles, other matrices and one
//! color.

use super::geometry::{GpuGeometry, VERTICES};
use super::pipeline::ModelPipelines;
use crate::ghosts::GhostSkins;
use crate::gpu::{Gpu, scene_depth, scene_target};
use crate::shaders;
use crate::uniform::{Affine, DrawUniform};
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
}

/// Buffers for a number of ghosts of one model.
struct GhostBuffers {
    loaded: Arc<LoadedModel>,
    ghosts: usize,
    uniforms: wgpu::Buffer,
    palettes: wgpu::Buffer,
    weights: wgpu::Buffer,
    stride: u32,
    /// Bind groups, by mesh and primitive.
    groups: HashMap<(u32, u32), wgpu::BindGroup>,
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
            .max(stride(gpu) as usize * posed.items().len());
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
        let items = posed.items().len();
        for (ghost, &tint) in ghosts.tints()[first..].iter().enumerate() {
            for (index, item) in posed.items().iter().enumerate() {
                let uniform = DrawUniform {
                    palette: item.uniform.palette + (ghost * matrices) as u32,
                    morph_weights: item.uniform.morph_weights + (ghost * weights) as u32,
                    tint,
                    ..item.uniform
                };
                let offset = (ghost * items + index) as u64 * u64::from(room.stride);
                gpu.queue.write_buffer(&room.uniforms, offset, bytemuck::bytes_of(&uniform));
            }
        }
        self.count = count;
    }

    /// Draws the ghosts.
    pub(super) fn draw(
        &self,
        gpu: &Gpu,
        ghosts: &GhostSkins,
        geometries: &HashMap<(u32, u32), GpuGeometry>,
        pass: &mut wgpu::RenderPass<'_>,
    ) {
        let (Some(room), Some(pipelines), Some(posed)) = (&self.room, &self.pipelines, ghosts.posed()) else {
            return;
        };
        pass.set_bind_group(0, &gpu.frame_group, &[]);
        let first = ghosts.len().saturating_sub(self.count);
        for ghost in 0..self.count {
            for (index, item) in posed.items().iter().enumerate() {
                let part = (item.mesh, item.primitive);
                let Some((geometry, group)) = geometries.get(&part).zip(room.groups.get(&part)) else {
                    continue;
                };
                let place = (ghost * posed.items().len() + index) as u32;
                pass.set_pipeline(&pipelines[usize::from(ghosts.is_mirrored(first + ghost, index))]);
                pass.set_bind_group(1, group, &[place * room.stride]);
                pass.set_vertex_buffer(0, geometry.vertices.slice(..));
                pass.set_index_buffer(geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(0..geometry.count, 0, 0..1);
            }
        }
    }
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
        let nothing = buffer("no morph deltas", 36, storage);
        let stride = stride(gpu);
        let size = stride as usize * posed.items().len() * count;
        let uniforms = buffer("ghosts' draws", size, wgpu::BufferUsages::UNIFORM);
        let group = |(&part, geometry): (&(u32, u32), &GpuGeometry)| {
            let deltas = geometry.deltas.as_ref().unwrap_or(&nothing);
            (part, pipelines.draw_group(gpu, &uniforms, &palettes, &weights, deltas))
        };
        let groups = geometries.iter().map(group).collect();
        let loaded = Arc::clone(posed.loaded());
        Some(Self { loaded, ghosts: count, groups, uniforms, palettes, weights, stride })
    }
}

/// Returns the distance between draw uniforms, bytes.
pub(super) fn stride(gpu: &Gpu) -> u32 {
    let alignment = gpu.device.limits().min_uniform_buffer_offset_alignment;
    (size_of::<DrawUniform>() as u32).next_multiple_of(alignment)
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
            buffers: &[Some(VERTICES)],
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
            targets: &scene_target(true),
        }),
        multiview_mask: None,
        cache: None,
    })
}
