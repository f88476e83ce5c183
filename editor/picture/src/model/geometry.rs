//! Vertices and triangles on the device.

use crate::gpu::Gpu;
use crate::uniform::DrawInstance;
use bytemuck::{Pod, Zeroable};
use dragonfly_anim::data::{Influence, Primitive};
use glam::{Vec3, Vec4};
use wgpu::util::DeviceExt;

/// A vertex on the device. WGSL twins: `VertexIn` in `shaders/common/vertex.wgsl`, `vertex_words` in `shaders/skin.wgsl`. Attributes that a
/// primitive lacks get neutral values.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct GpuVertex {
    position: [f32; 3],
    normal: [f32; 3],
    tangent: [f32; 4],
    texture_coordinates: [f32; 4],
    color: [f32; 4],
    joints: [u16; 8],
    weights: [f32; 8],
}

/// Attributes of [`GpuVertex`], by shader location.
const ATTRIBUTES: [wgpu::VertexAttribute; 9] = wgpu::vertex_attr_array![
    0 => Float32x3,
    1 => Float32x3,
    2 => Float32x4,
    3 => Float32x4,
    4 => Float32x4,
    5 => Uint16x4,
    6 => Uint16x4,
    7 => Float32x4,
    8 => Float32x4,
];

/// Attributes of [`DrawInstance`], by shader location.
const INSTANCE_ATTRIBUTES: [wgpu::VertexAttribute; 2] =
    wgpu::vertex_attr_array![9 => Uint32x4, 10 => Uint32x3];

/// Layouts of vertices and of instances in their buffers.
pub(super) const VERTICES: [Option<wgpu::VertexBufferLayout<'static>>; 2] = [
    Some(wgpu::VertexBufferLayout {
        array_stride: size_of::<GpuVertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &ATTRIBUTES,
    }),
    Some(wgpu::VertexBufferLayout {
        array_stride: size_of::<DrawInstance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &INSTANCE_ATTRIBUTES,
    }),
];

/// Buffers of one primitive.
pub(super) struct GpuGeometry {
    /// Vertices, each a [`GpuVertex`].
    pub(super) vertices: wgpu::Buffer,
    /// Indices of 32 bits.
    pub(super) indices: wgpu::Buffer,
    /// Number of indices.
    pub(super) count: u32,
    /// Morph deltas; `None` without morph targets.
    pub(super) deltas: Option<wgpu::Buffer>,
}

impl GpuGeometry {
    /// Uploads `primitive` to the device.
    pub(super) fn new(gpu: &Gpu, primitive: &Primitive) -> Self {
        let buffer = |label, contents: &[u8], usage| {
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some(label),
                contents,
                usage,
            })
        };
        let vertices: Vec<GpuVertex> =
            (0..primitive.vertices.len()).map(|index| vertex(primitive, index)).collect();
        let deltas = (!primitive.morph_targets.is_empty()).then(|| deltas(primitive));
        // The shader that poses vertices reads them as words.
        let words = if gpu.skins_once { wgpu::BufferUsages::STORAGE } else { wgpu::BufferUsages::empty() };
        let usage = wgpu::BufferUsages::VERTEX | words;
        Self {
            vertices: buffer("vertices", bytemuck::cast_slice(&vertices), usage),
            indices: buffer("indices", bytemuck::cast_slice(&primitive.indices), wgpu::BufferUsages::INDEX),
            count: primitive.indices.len() as u32,
            deltas: deltas.map(|deltas| {
                buffer("morph deltas", bytemuck::cast_slice(&deltas), wgpu::BufferUsages::STORAGE)
            }),
        }
    }
}

fn vertex(primitive: &Primitive, index: usize) -> GpuVertex {
    let columns = &primitive.vertices;
    let mut joints = [0; 8];
    let mut weights = [0.0; 8];
    for (slot, &Influence { joint, weight }) in columns.influences_of(index).iter().take(8).enumerate() {
        (joints[slot], weights[slot]) = (joint, weight);
    }
    let [first, second] =
        [0, 1].map(|set| columns.texture_coordinates[set].get(index).copied().unwrap_or_default());
    GpuVertex {
        position: columns.positions[index].into(),
        normal: columns.normals.get(index).copied().unwrap_or(Vec3::Y).into(),
        // A tangent of length zero means that there is none: the shader derives one.
        tangent: columns.tangents.get(index).copied().unwrap_or(Vec4::W).into(),
        texture_coordinates: [first.x, first.y, second.x, second.y],
        color: columns.colors.get(index).copied().unwrap_or(Vec4::ONE).into(),
        joints,
        weights,
    }
}

/// Nine values per vertex and target, target after target, as `deltas` in `shaders/common/pose.wgsl` reads them.
fn deltas(primitive: &Primitive) -> Vec<[Vec3; 3]> {
    let count = primitive.vertices.len();
    let mut all = Vec::with_capacity(count * primitive.morph_targets.len());
    for target in &primitive.morph_targets {
        let at = |column: &[Vec3], index: usize| column.get(index).copied().unwrap_or(Vec3::ZERO);
        all.extend((0..count).map(|index| {
            [at(&target.positions, index), at(&target.normals, index), at(&target.tangents, index)]
        }));
    }
    all
}
