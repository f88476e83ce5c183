//! Drawing the maps of shadows: surfaces as a lamp sees them, their depth alone.

use super::geometry::VERTICES;
use super::pipeline::ModelPipelines;
use crate::draw_set::DrawItem;
use crate::gpu::{DEPTH_FORMAT, Gpu};
use crate::shaders::{self, Shader};
use crate::shadow::{CASCADES, SPOT_SHADOWS, SceneShadows};
use glam::Mat4;
use std::collections::HashMap;

/// Bias of the maps: by how many texels of slope what casts shadows is moved away from the lamp, so that it casts none on itself. Depth is
/// reversed, so that away is less.
const SLOPE_BIAS: f32 = -2.0;

/// Distance between the matrices of maps in their buffer, bytes: the largest that a device may ask for.
const STRIDE: u64 = 256;

/// Everything that distinguishes one pipeline from another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct CasterKind {
    /// Whether the alpha of the material cuts holes.
    pub(super) masked: bool,
    /// Whether vertices were posed before.
    pub(super) posed: bool,
}

impl CasterKind {
    /// Returns the kind of an item. A transparent one casts the shadow of what is more than half opaque.
    pub(super) fn of(item: &DrawItem, posed: bool) -> Self {
        Self { masked: item.mask || item.blend, posed }
    }

    fn shader(self) -> &'static Shader {
        if self.posed { &shaders::SHADOW_POSED } else { &shaders::SHADOW }
    }
}

/// Pipelines for maps, and the matrices of the maps of a frame.
pub(super) struct CasterPipelines {
    view_layout: wgpu::BindGroupLayout,
    views: wgpu::Buffer,
    view_group: wgpu::BindGroup,
    /// Those that were needed so far.
    made: HashMap<CasterKind, wgpu::RenderPipeline>,
}

impl CasterPipelines {
    /// Starts without pipelines.
    pub(super) fn new(gpu: &Gpu) -> Self {
        let size = wgpu::BufferSize::new(size_of::<Mat4>() as u64);
        let view_layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("lamp view"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: true,
                    min_binding_size: size,
                },
                count: None,
            }],
        });
        let bytes = (CASCADES + SPOT_SHADOWS) * STRIDE as usize;
        let views = gpu.buffer("lamp views", bytes, wgpu::BufferUsages::UNIFORM);
        let one = wgpu::BufferBinding { buffer: &views, offset: 0, size };
        let view_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("lamp view"),
            layout: &view_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(one) }],
        });
        Self { view_layout, views, view_group, made: HashMap::new() }
    }

    /// Writes the matrices of the maps of a frame.
    pub(super) fn write(&self, gpu: &Gpu, shadows: &SceneShadows) {
        for (index, map) in (0..).zip(shadows.maps()) {
            gpu.queue.write_buffer(&self.views, index * STRIDE, bytemuck::bytes_of(&map.clip_from_world));
        }
    }

    /// Bind group 0 of draws into a map, and its offset.
    pub(super) fn view(&self, map: usize) -> (&wgpu::BindGroup, u32) {
        (&self.view_group, map as u32 * STRIDE as u32)
    }

    /// Returns the pipeline of `kind`, if it was created.
    pub(super) fn get(&self, kind: CasterKind) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&kind)
    }

    /// Creates the pipeline of `kind` unless it exists.
    pub(super) fn make(
        &mut self,
        gpu: &Gpu,
        kind: CasterKind,
        pipelines: &ModelPipelines,
        material: &wgpu::BindGroupLayout,
    ) {
        let Self { view_layout, made, .. } = self;
        made.entry(kind).or_insert_with(|| {
            let draw = if kind.posed { pipelines.posed_layout() } else { pipelines.draw_layout() };
            let groups = [view_layout, draw, material].map(Some);
            let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("shadow"),
                bind_group_layouts: &groups[..if kind.masked { 3 } else { 2 }],
                immediate_size: 0,
            });
            pipeline(gpu, kind, &layout)
        });
    }
}

fn pipeline(gpu: &Gpu, kind: CasterKind, layout: &wgpu::PipelineLayout) -> wgpu::RenderPipeline {
    let module = kind.shader().module(&gpu.device);
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("shadow"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(if kind.masked { "vs_masked" } else { "vs_caster" }),
            compilation_options: Default::default(),
            buffers: &VERTICES,
        },
        // Both sides: many models are not closed, and a leaf has one side only.
        primitive: wgpu::PrimitiveState { cull_mode: None, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState { constant: 0, slope_scale: SLOPE_BIAS, clamp: 0.0 },
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: kind.masked.then_some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs_masked"),
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}
