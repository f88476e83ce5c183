//! The ways to draw a surface.

use super::geometry::VERTICES;
use crate::gpu::{Gpu, scene_depth, scene_samples, scene_target};
use crate::shaders;
use crate::uniform::{Affine, DrawUniform};
use std::collections::HashMap;

/// Which faces are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Cull {
    /// None.
    Nothing,
    /// Those that face the viewer.
    Front,
    /// Those that face away.
    Back,
}

/// What tells one pipeline from another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct PipelineKind {
    /// Alpha chooses samples.
    pub(super) mask: bool,
    /// Alpha blends.
    pub(super) blend: bool,
    /// Which faces are left out.
    pub(super) cull: Cull,
    /// Front faces run clockwise: the pose mirrors.
    pub(super) mirrored: bool,
}

/// Pipelines, made when first wanted: few of the possible ones ever are.
pub(super) struct ModelPipelines {
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    draw_layout: wgpu::BindGroupLayout,
    made: HashMap<PipelineKind, wgpu::RenderPipeline>,
}

impl ModelPipelines {
    /// None made yet.
    pub(super) fn new(gpu: &Gpu, material_layout: &wgpu::BindGroupLayout) -> Self {
        let draw_layout = draw_layout(gpu);
        let layout = gpu.pipeline_layout("model", &[&draw_layout, material_layout]);
        let module = shaders::MODEL.module(&gpu.device);
        Self { module, layout, draw_layout, made: HashMap::new() }
    }

    /// The pipeline of `kind`, if it was made.
    pub(super) fn get(&self, kind: PipelineKind) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&kind)
    }

    /// Makes the pipeline of `kind` unless it is there.
    pub(super) fn make(&mut self, gpu: &Gpu, kind: PipelineKind) {
        let Self { module, layout, made, .. } = self;
        made.entry(kind).or_insert_with(|| pipeline(gpu, module, layout, kind));
    }

    /// The layout of bind group 1.
    pub(super) fn draw_layout(&self) -> &wgpu::BindGroupLayout {
        &self.draw_layout
    }

    /// Bind group 1 of a draw.
    pub(super) fn draw_group(
        &self,
        gpu: &Gpu,
        uniforms: &wgpu::Buffer,
        palettes: &wgpu::Buffer,
        weights: &wgpu::Buffer,
        deltas: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let one = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: uniforms,
            offset: 0,
            size: wgpu::BufferSize::new(size_of::<DrawUniform>() as u64),
        });
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("draw"),
            layout: &self.draw_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: one },
                wgpu::BindGroupEntry { binding: 1, resource: palettes.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 2, resource: weights.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 3, resource: deltas.as_entire_binding() },
            ],
        })
    }
}

fn draw_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entry = |binding, ty, has_dynamic_offset, size: usize| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX,
        ty: wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset,
            min_binding_size: wgpu::BufferSize::new(size as u64),
        },
        count: None,
    };
    let storage = wgpu::BufferBindingType::Storage { read_only: true };
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("draw"),
        entries: &[
            entry(0, wgpu::BufferBindingType::Uniform, true, size_of::<DrawUniform>()),
            entry(1, storage, false, size_of::<Affine>()),
            entry(2, storage, false, size_of::<f32>()),
            entry(3, storage, false, size_of::<f32>()),
        ],
    })
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    kind: PipelineKind,
) -> wgpu::RenderPipeline {
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("model"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vs_model"),
            compilation_options: Default::default(),
            buffers: &[Some(VERTICES)],
        },
        primitive: wgpu::PrimitiveState {
            front_face: if kind.mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
            cull_mode: match kind.cull {
                Cull::Nothing => None,
                Cull::Front => Some(wgpu::Face::Front),
                Cull::Back => Some(wgpu::Face::Back),
            },
            ..Default::default()
        },
        depth_stencil: Some(scene_depth(!kind.blend)),
        multisample: scene_samples(kind.mask),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fs_model"),
            compilation_options: Default::default(),
            targets: &scene_target(kind.blend),
        }),
        multiview_mask: None,
        cache: None,
    })
}
