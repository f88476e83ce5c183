//! Bind groups 1 of draws: the pose, and the morph deltas of a part of a mesh.

use super::geometry::GpuGeometry;
use super::pipeline::ModelPipelines;
use crate::gpu::Gpu;
use std::collections::HashMap;

/// Bind groups 1 of all draws of a model.
pub(super) struct DrawGroups {
    /// For all parts without morph targets.
    plain: wgpu::BindGroup,
    /// For parts with morph targets, by mesh and primitive.
    morphed: HashMap<(u32, u32), wgpu::BindGroup>,
}

impl DrawGroups {
    /// Creates the bind groups of `geometries` with matrices and morph weights in these buffers.
    pub(super) fn new(
        gpu: &Gpu,
        pipelines: &ModelPipelines,
        palettes: &wgpu::Buffer,
        weights: &wgpu::Buffer,
        geometries: &HashMap<(u32, u32), GpuGeometry>,
    ) -> Self {
        let nothing = gpu.buffer("no morph deltas", 36, wgpu::BufferUsages::STORAGE);
        let group = |deltas: &wgpu::Buffer| pipelines.draw_group(gpu, palettes, weights, deltas);
        let morphed = |(&part, geometry): (&(u32, u32), &GpuGeometry)| {
            geometry.deltas.as_ref().map(|deltas| (part, group(deltas)))
        };
        Self { plain: group(&nothing), morphed: geometries.iter().filter_map(morphed).collect() }
    }

    /// Returns the bind group of a part.
    pub(super) fn get(&self, part: (u32, u32)) -> &wgpu::BindGroup {
        self.morphed.get(&part).unwrap_or(&self.plain)
    }
}
