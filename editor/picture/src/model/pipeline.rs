//! Pipelines for drawing surfaces.

use super::geometry::VERTICES;
use crate::gpu::{Gpu, SceneEncoding, scene_depth};
use crate::shaders;
use crate::uniform::Affine;
use std::collections::HashMap;

/// Faces that are culled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Cull {
    /// None.
    Nothing,
    /// Faces towards the viewer.
    Front,
    /// Faces away from the viewer.
    Back,
}

/// Everything that distinguishes one pipeline from another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct PipelineKind {
    /// Whether alpha discards samples.
    pub(super) mask: bool,
    /// Whether alpha blends.
    pub(super) blend: bool,
    /// Faces that are culled.
    pub(super) cull: Cull,
    /// Whether front faces wind clockwise, because the pose mirrors.
    pub(super) mirrored: bool,
}

/// Pipelines, created on first use: few of the possible ones are ever used.
pub(super) struct ModelPipelines {
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    draw_layout: wgpu::BindGroupLayout,
    made: HashMap<PipelineKind, wgpu::RenderPipeline>,
}

impl ModelPipelines {
    /// Starts without pipelines.
    pub(super) fn new(gpu: &Gpu, material_layout: &wgpu::BindGroupLayout) -> Self {
        let draw_layout = draw_layout(gpu);
        let layout = gpu.pipeline_layout("model", &[&draw_layout, material_layout]);
        let module = shaders::MODEL.module(&gpu.device);
        Self { module, layout, draw_layout, made: HashMap::new() }
    }

    /// Returns the pipeline of `kind`, if it was created.
    pub(super) fn get(&self, kind: PipelineKind) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&kind)
    }

    /// Creates the pipeline of `kind` unless it exists.
    pub(super) fn make(&mut self, gpu: &Gpu, kind: PipelineKind) {
        let Self { module, layout, made, .. } = self;
        made.entry(kind).or_insert_with(|| pipeline(gpu, module, layout, kind));
    }

    /// Layout of bind group 1.
    pub(super) fn draw_layout(&self) -> &wgpu::BindGroupLayout {
        &self.draw_layout
    }

    /// Creates bind group 1 of a draw.
    pub(super) fn draw_group(
        &self,
        gpu: &Gpu,
        palettes: &wgpu::Buffer,
        weights: &wgpu::Buffer,
        deltas: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("draw"),
            layout: &self.draw_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: palettes.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: weights.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 2, resource: deltas.as_entire_binding() },
            ],
        })
    }
}

fn draw_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let entry = |binding, size: usize| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: wgpu::BufferSize::new(size as u64),
        },
        count: None,
    };
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("draw"),
        entries: &[entry(0, size_of::<Affine>()), entry(1, size_of::<f32>()), entry(2, size_of::<f32>())],
    })
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    kind: PipelineKind,
) -> wgpu::RenderPipeline {
    let flag = |is_set| f64::from(u8::from(is_set));
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("model"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vs_model"),
            compilation_options: Default::default(),
            buffers: &VERTICES,
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
        multisample: gpu.scene_samples(kind.mask),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fs_model"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &[
                    ("single_sample", flag(gpu.samples == 1)),
                    ("linear_light", flag(gpu.encoding() == SceneEncoding::Linear)),
                ],
                ..Default::default()
            },
            targets: &gpu.scene_target(kind.blend),
        }),
        multiview_mask: None,
        cache: None,
    })
}
