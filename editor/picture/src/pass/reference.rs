//! A reference picture that is drawn before the model: locked to the camera, or on a plane of the scene.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings};
use crate::appearance::Appearance;
use crate::device::DeviceListener;
use crate::gpu::{Gpu, scene_depth};
use crate::scene::Scene;
use crate::shaders;
use bytemuck::{Pod, Zeroable};
use dragonfly_document::DecodedImage;
use std::sync::Arc;

/// The reference picture that is shown, and where.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReferenceAppearance {
    /// The picture; `None` shows nothing.
    pub picture: Option<ReferencePicture>,
    /// Its place.
    pub place: ReferencePlace,
    /// 0 is invisible, 1 is opaque.
    pub opacity: f32,
}

impl Appearance for ReferenceAppearance {}

/// A decoded picture. Two are equal if they share their pixels, which are not compared.
#[derive(Clone, Debug)]
pub struct ReferencePicture(pub Arc<DecodedImage>);

impl PartialEq for ReferencePicture {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// The place of a reference picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReferencePlace {
    /// Over the background, the same for every camera.
    Camera {
        /// Factor of the size at which the picture just fits into the viewport.
        scale: f32,
        /// Distance of its center from that of the viewport, in widths and heights of the viewport, up and to the right.
        offset: [f32; 2],
    },
    /// On a plane of the scene.
    Plane {
        /// Center, meters.
        center: [f32; 3],
        /// Direction to the right edge, unit length.
        right: [f32; 3],
        /// Height of the upright picture, meters.
        height: f32,
    },
}

impl Default for ReferencePlace {
    fn default() -> Self {
        Self::Camera { scale: 1.0, offset: [0.0; 2] }
    }
}

/// The data of the shader. WGSL twin: `Reference` in `shaders/reference.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
struct ReferenceUniform {
    center: [f32; 4],
    right: [f32; 4],
    up: [f32; 4],
    look: [f32; 4],
}

impl ReferenceUniform {
    /// Returns the data for a picture and a viewport of these sizes, pixels.
    fn of(appearance: &ReferenceAppearance, picture: [u32; 2], viewport: [u32; 2]) -> Self {
        let [width, height] = picture.map(|side| side.max(1) as f32);
        let [across, down] = viewport.map(|side| side.max(1) as f32);
        let look = [appearance.opacity, 0.0, 0.0, 0.0];
        match appearance.place {
            ReferencePlace::Camera { scale, offset: [x, y] } => {
                let fit = (across / width).min(down / height) * scale;
                Self {
                    center: [2.0 * x, 2.0 * y, 0.0, 0.0],
                    right: [fit * width / across, 0.0, 0.0, 0.0],
                    up: [0.0, fit * height / down, 0.0, 0.0],
                    look,
                }
            }
            ReferencePlace::Plane { center: [x, y, z], right, height: meters } => {
                let half = meters / 2.0;
                let [a, b, c] = right.map(|number| number * half * width / height);
                Self { center: [x, y, z, 1.0], right: [a, b, c, 0.0], up: [0.0, half, 0.0, 0.0], look }
            }
        }
    }
}

/// Draws the reference picture.
#[derive(Default)]
pub(super) struct ReferencePass {
    device: Option<DeviceParts>,
    /// The picture in the texture.
    uploaded: Option<ReferencePicture>,
    shown: bool,
}

/// Resources of the device.
struct DeviceParts {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    uniform: wgpu::Buffer,
    sampler: wgpu::Sampler,
    texture: Option<(wgpu::Texture, wgpu::BindGroup)>,
}

impl DeviceListener for ReferencePass {
    fn on_lost(&mut self) {
        (self.device, self.uploaded) = (None, None);
    }

    fn on_reset(&mut self, gpu: &Gpu) {
        (self.device, self.uploaded) = (Some(DeviceParts::new(gpu)), None);
    }
}

impl DeviceParts {
    fn new(gpu: &Gpu) -> Self {
        let entry =
            |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("reference"),
            entries: &[
                entry(0, wgpu::ShaderStages::VERTEX_FRAGMENT, uniform),
                entry(1, fragment, texture),
                entry(2, fragment, sampler),
            ],
        });
        let module = shaders::REFERENCE.module(&gpu.device);
        let primitive = wgpu::PrimitiveState {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..wgpu::PrimitiveState::default()
        };
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("reference"),
            layout: Some(&gpu.pipeline_layout("reference", &[&layout])),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs_reference"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive,
            // Behind the model from every side: it writes no depth.
            depth_stencil: Some(scene_depth(false)),
            multisample: gpu.scene_samples(false),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs_reference"),
                compilation_options: Default::default(),
                targets: &gpu.scene_target(true),
            }),
            multiview_mask: None,
            cache: None,
        });
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("reference"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let size = size_of::<ReferenceUniform>();
        let uniform = gpu.buffer("reference", size, wgpu::BufferUsages::UNIFORM);
        Self { layout, pipeline, uniform, sampler, texture: None }
    }

    /// Uploads a picture into the texture, which is created again where the size differs. Returns whether it can be shown.
    fn upload(&mut self, gpu: &Gpu, image: &DecodedImage) -> bool {
        let DecodedImage { width, height, .. } = *image;
        let bytes = u64::from(width) * u64::from(height) * 4;
        if bytes == 0 || width.max(height) > gpu.max_side || bytes != image.pixels.len() as u64 {
            return false;
        }
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        if self.texture.as_ref().is_none_or(|(texture, _)| texture.size() != size) {
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("reference"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba8UnormSrgb,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
            let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("reference"),
                layout: &self.layout,
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: self.uniform.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&view) },
                    wgpu::BindGroupEntry {
                        binding: 2,
                        resource: wgpu::BindingResource::Sampler(&self.sampler),
                    },
                ],
            });
            self.texture = Some((texture, group));
        }
        let Some((texture, _)) = &self.texture else { return false };
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 4), rows_per_image: None };
        gpu.queue.write_texture(texture.as_image_copy(), &image.pixels, layout, size);
        true
    }
}

impl Pass for ReferencePass {
    fn name(&self) -> &'static str {
        "reference"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Scene
    }

    fn is_backdrop(&self, scene: &Scene) -> bool {
        let shown = scene.appearances.get::<ReferenceAppearance>();
        shown.is_some_and(|shown| matches!(shown.place, ReferencePlace::Camera { .. }))
    }

    fn prepare(&mut self, around: &Surroundings<'_>, _: &mut FrameCommands) {
        self.shown = false;
        let Some(device) = &mut self.device else { return };
        let appearance = around.scene.appearances.get::<ReferenceAppearance>();
        let Some((appearance, picture)) = appearance.and_then(|shown| Some((shown, shown.picture.as_ref()?)))
        else {
            (device.texture, self.uploaded) = (None, None);
            return;
        };
        if self.uploaded.as_ref() != Some(picture) {
            self.uploaded = device.upload(around.gpu, &picture.0).then(|| picture.clone());
        }
        let [_, _, across, down] = around.scene.look.viewport;
        let size = [picture.0.width, picture.0.height];
        let uniform = ReferenceUniform::of(appearance, size, [across, down]);
        around.gpu.queue.write_buffer(&device.uniform, 0, bytemuck::bytes_of(&uniform));
        self.shown = self.uploaded.is_some() && appearance.opacity > 0.0;
    }

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        let Some(DeviceParts { pipeline, texture: Some((_, group)), .. }) =
            self.device.as_ref().filter(|_| self.shown)
        else {
            return;
        };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &around.gpu.frame_group, &[]);
        pass.set_bind_group(1, group, &[]);
        pass.draw(0..4, 0..1);
    }
}
