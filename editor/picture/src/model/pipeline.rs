//! Pipelines for drawing surfaces.

use super::geometry::VERTICES;
use crate::gpu::{Gpu, SceneEncoding, scene_depth};
use crate::shaders::{self, Shader};
use crate::uniform::{Affine, POSED_BYTES};
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

/// The shader of a surface, by what else is drawn in the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum ShaderVariant {
    /// Lamps cast no shadows, and vertices are posed where they are drawn.
    Plain,
    /// Lamps cast shadows.
    Shadowed,
    /// Lamps cast shadows, and vertices were posed before.
    ShadowedPosed,
}

impl ShaderVariant {
    /// Number of variants.
    const COUNT: usize = 3;

    /// Returns the variant for a frame, and vertices that were posed before or are not.
    pub(super) fn of(shadows: bool, posed: bool) -> Self {
        match (shadows, posed) {
            (false, _) => Self::Plain,
            (true, false) => Self::Shadowed,
            (true, true) => Self::ShadowedPosed,
        }
    }

    fn shader(self) -> &'static Shader {
        match self {
            Self::Plain => &shaders::MODEL,
            Self::Shadowed => &shaders::MODEL_SHADOWED,
            Self::ShadowedPosed => &shaders::MODEL_POSED,
        }
    }
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
    /// The shader.
    pub(super) variant: ShaderVariant,
}

/// A shader that was compiled, and the layout of its bind groups.
struct CompiledVariant {
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
}

/// Pipelines, created on first use: few of the possible ones are ever used.
pub(super) struct ModelPipelines {
    draw_layout: wgpu::BindGroupLayout,
    posed_layout: wgpu::BindGroupLayout,
    /// The variants that were needed so far.
    variants: [Option<CompiledVariant>; ShaderVariant::COUNT],
    made: HashMap<PipelineKind, wgpu::RenderPipeline>,
}

impl ModelPipelines {
    /// Starts without pipelines.
    pub(super) fn new(gpu: &Gpu) -> Self {
        let (draw_layout, posed_layout) = (draw_layout(gpu), posed_layout(gpu));
        Self { draw_layout, posed_layout, variants: [const { None }; _], made: HashMap::new() }
    }

    /// Returns the pipeline of `kind`, if it was created.
    pub(super) fn get(&self, kind: PipelineKind) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&kind)
    }

    /// Creates the pipeline of `kind` unless it exists. `shadows` is the layout of bind group 3; without it there is none with shadows.
    pub(super) fn make(
        &mut self,
        gpu: &Gpu,
        kind: PipelineKind,
        material: &wgpu::BindGroupLayout,
        shadows: Option<&wgpu::BindGroupLayout>,
    ) {
        if self.made.contains_key(&kind) {
            return;
        }
        let variant = &mut self.variants[kind.variant as usize];
        if variant.is_none() {
            let draw = match kind.variant {
                ShaderVariant::Plain | ShaderVariant::Shadowed => &self.draw_layout,
                ShaderVariant::ShadowedPosed => &self.posed_layout,
            };
            let layout = match (kind.variant, shadows) {
                (ShaderVariant::Plain, _) => gpu.pipeline_layout("model", &[draw, material]),
                (ShaderVariant::Shadowed | ShaderVariant::ShadowedPosed, Some(shadows)) => {
                    gpu.pipeline_layout("shadowed model", &[draw, material, shadows])
                }
                (ShaderVariant::Shadowed | ShaderVariant::ShadowedPosed, None) => return,
            };
            let module = kind.variant.shader().module(&gpu.device);
            *variant = Some(CompiledVariant { module, layout });
        }
        if let Some(variant) = variant {
            self.made.insert(kind, pipeline(gpu, variant, kind));
        }
    }

    /// Layout of bind group 1.
    pub(super) fn draw_layout(&self) -> &wgpu::BindGroupLayout {
        &self.draw_layout
    }

    /// Layout of bind group 1 of draws of vertices that were posed before.
    pub(super) fn posed_layout(&self) -> &wgpu::BindGroupLayout {
        &self.posed_layout
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

/// Describes a storage buffer of at least `size` bytes that shaders read.
pub(super) fn storage(binding: u32, visibility: wgpu::ShaderStages, size: u64) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: wgpu::BufferSize::new(size),
        },
        count: None,
    }
}

fn draw_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let compute = if gpu.skins_once { wgpu::ShaderStages::COMPUTE } else { wgpu::ShaderStages::empty() };
    let entry = |binding, size: usize| storage(binding, wgpu::ShaderStages::VERTEX | compute, size as u64);
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("draw"),
        entries: &[entry(0, size_of::<Affine>()), entry(1, size_of::<f32>()), entry(2, size_of::<f32>())],
    })
}

fn posed_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("posed draw"),
        entries: &[storage(0, wgpu::ShaderStages::VERTEX, POSED_BYTES)],
    })
}

fn pipeline(gpu: &Gpu, variant: &CompiledVariant, kind: PipelineKind) -> wgpu::RenderPipeline {
    let CompiledVariant { module, layout } = variant;
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
