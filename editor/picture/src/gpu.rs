//! The objects that every creator and drawer of resources needs: device, queue, formats, and this frame's uniform.

use super::error::GraphicsError;
use super::losses::DeviceReports;
use super::texture_memory::TextureMemory;
use super::uniform::FrameUniform;

/// Format of the scene: drawn in linear light and stored sRGB-encoded, so that 8 bits suffice where the eye
/// distinguishes most.
pub const SCENE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Format of the scene before the tone map, of which sums are made.
const LINEAR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Format of these sums.
pub(crate) const SUM_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;
/// Format of the depth; reversed: 1 is near.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Number of samples per pixel of the scene, where the adapter supports it; almost every adapter does.
pub const SAMPLES: u32 = 4;
/// Format of whole frames without a window; egui needs one that does not encode.
const OFFSCREEN_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Meaning of the colors in the target of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SceneEncoding {
    /// Colors of the display, in [`SCENE_FORMAT`]: each surface is tone-mapped by its own shader.
    #[default]
    Display,
    /// Light before the tone map, in floating-point numbers: several images are added and tone-mapped once.
    Linear,
}

impl SceneEncoding {
    /// Format of the target.
    pub fn format(self) -> wgpu::TextureFormat {
        match self {
            Self::Display => SCENE_FORMAT,
            Self::Linear => LINEAR_FORMAT,
        }
    }
}

/// A device and its common resources.
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Format of the window, or of the texture that replaces it.
    pub window_format: wgpu::TextureFormat,
    /// Longest side of a texture.
    pub max_side: u32,
    /// Samples per pixel of the scene in the present encoding; 1 is no smoothing of edges.
    pub samples: u32,
    encoding: SceneEncoding,
    display_samples: u32,
    /// Samples per pixel in [`SceneEncoding::Linear`]; `None` where the device cannot draw in it.
    linear_samples: Option<u32>,
    /// Samples of an image that a pixel may take along a surface seen at a flat angle; 1 is no anisotropic filtering.
    pub anisotropy: u16,
    /// Whether vertices can be posed in a compute shader.
    pub(crate) skins_once: bool,
    /// Memory for the textures of a model.
    pub(crate) texture_memory: TextureMemory,
    /// Layout of bind group 0 of all passes of the scene.
    pub frame_layout: wgpu::BindGroupLayout,
    /// Bind group 0 of all passes of the scene.
    pub frame_group: wgpu::BindGroup,
    frame_buffer: wgpu::Buffer,
}

impl Gpu {
    /// Creates a device of `adapter` that can draw into `surface`, with at most `most_samples` samples per pixel.
    pub fn new(
        adapter: &wgpu::Adapter,
        surface: Option<&wgpu::Surface<'static>>,
        most_samples: u32,
        reports: &DeviceReports,
    ) -> Result<Self, GraphicsError> {
        check(adapter)?;
        let features =
            [SCENE_FORMAT, DEPTH_FORMAT].map(|format| adapter.get_texture_format_features(format).flags);
        let samples = samples(features, most_samples);
        let linear_samples = linear_samples(adapter, most_samples);
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("dragonfly"),
            required_limits: limits(&adapter.limits()),
            ..Default::default()
        }))
        .map_err(|error| GraphicsError::NoDevice(error.to_string()))?;
        reports.watch(&device);
        let window_format = match surface {
            Some(surface) => format(surface, adapter)?,
            None => OFFSCREEN_FORMAT,
        };
        let max_side = device.limits().max_texture_dimension_2d;
        let device_type = adapter.get_info().device_type;
        let (anisotropy, texture_memory) = (anisotropy(device_type), TextureMemory::of(device_type));
        let skins_once = skins_once(adapter, &device.limits());
        let (frame_layout, frame_group, frame_buffer) = uniform_binding::<FrameUniform>(&device, "frame");
        Ok(Self {
            device,
            queue,
            window_format,
            max_side,
            samples,
            encoding: SceneEncoding::Display,
            display_samples: samples,
            linear_samples,
            anisotropy,
            skins_once,
            texture_memory,
            frame_layout,
            frame_group,
            frame_buffer,
        })
    }

    /// Meaning of the colors in the target of the scene.
    pub fn encoding(&self) -> SceneEncoding {
        self.encoding
    }

    /// Returns whether the scene can be drawn in [`SceneEncoding::Linear`].
    pub fn has_linear_encoding(&self) -> bool {
        self.linear_samples.is_some()
    }

    /// Draws the scene in `encoding` from now on. Pipelines and targets made for another one cannot be used with it.
    pub(crate) fn set_encoding(&mut self, encoding: SceneEncoding) {
        self.encoding = encoding;
        self.samples = match encoding {
            SceneEncoding::Display => self.display_samples,
            SceneEncoding::Linear => self.linear_samples.unwrap_or(1),
        };
    }

    /// Creates a buffer of `size` bytes to be written later.
    pub(super) fn buffer(&self, label: &str, size: usize, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: size as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// Writes this frame's uniform to the device.
    pub fn write_frame(&self, uniform: &FrameUniform) {
        self.queue.write_buffer(&self.frame_buffer, 0, bytemuck::bytes_of(uniform));
    }

    /// Returns the multisampling of the scene's pipelines.
    pub fn scene_samples(&self, alpha_to_coverage: bool) -> wgpu::MultisampleState {
        // One sample is covered or not; a mask then discards it in its shader.
        let alpha_to_coverage_enabled = alpha_to_coverage && self.samples > 1;
        wgpu::MultisampleState { count: self.samples, mask: !0, alpha_to_coverage_enabled }
    }

    /// Returns the target of the scene's pipelines; colors are premultiplied by alpha.
    pub fn scene_target(&self, blend: bool) -> [Option<wgpu::ColorTargetState>; 1] {
        [Some(wgpu::ColorTargetState {
            format: self.encoding.format(),
            blend: blend.then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            write_mask: wgpu::ColorWrites::ALL,
        })]
    }

    /// Creates a pipeline layout with the frame in group 0, followed by `groups`.
    pub fn pipeline_layout(&self, label: &str, groups: &[&wgpu::BindGroupLayout]) -> wgpu::PipelineLayout {
        let layouts: Vec<Option<&wgpu::BindGroupLayout>> =
            std::iter::once(&self.frame_layout).chain(groups.iter().copied()).map(Some).collect();
        self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &layouts,
            immediate_size: 0,
        })
    }
}

/// The depth test of the scene: nearer surfaces win; with `write` they also hide later ones.
pub fn scene_depth(write: bool) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: DEPTH_FORMAT,
        depth_write_enabled: Some(write),
        depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

/// Returns the format to draw in: one that does not encode, because egui encodes colors itself.
fn format(
    surface: &wgpu::Surface<'static>,
    adapter: &wgpu::Adapter,
) -> Result<wgpu::TextureFormat, GraphicsError> {
    let formats = surface.get_capabilities(adapter).formats;
    egui_wgpu::preferred_framebuffer_format(&formats)
        .map_err(|error| GraphicsError::NoSurface(error.to_string()))
}

/// Rejects an adapter that lacks a feature, instead of failing in the middle of a frame.
fn check(adapter: &wgpu::Adapter) -> Result<(), GraphicsError> {
    let lack = |lack| Err(GraphicsError::Unsuitable { adapter: adapter.get_info().name, lack });
    let capabilities = adapter.get_downlevel_capabilities();
    if !capabilities.flags.contains(wgpu::DownlevelFlags::VERTEX_STORAGE) {
        return lack("read storage buffers in vertex shaders, which skinning by any number of bones needs");
    }
    Ok(())
}

/// Returns the number of samples per pixel to draw with, for formats with these features: [`SAMPLES`], or 1 where one of
/// the formats does not support that or `most` is less.
pub fn samples(formats: [wgpu::TextureFormatFeatureFlags; 2], most: u32) -> u32 {
    let supported = most >= SAMPLES && formats.iter().all(|flags| flags.sample_count_supported(SAMPLES));
    if supported { SAMPLES } else { 1 }
}

/// Returns the number of samples per pixel for [`SceneEncoding::Linear`]; `None` where a format of it cannot be drawn in.
fn linear_samples(adapter: &wgpu::Adapter, most: u32) -> Option<u32> {
    let features = |format| adapter.get_texture_format_features(format);
    let is_target = |format| features(format).allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
    let blends = features(LINEAR_FORMAT).flags.contains(wgpu::TextureFormatFeatureFlags::BLENDABLE);
    let flags = [LINEAR_FORMAT, DEPTH_FORMAT].map(|format| features(format).flags);
    (blends && is_target(LINEAR_FORMAT) && is_target(SUM_FORMAT)).then(|| samples(flags, most))
}

/// Anisotropy is expensive on a software adapter, and not safe: Mesa's llvmpipe visits every texel of the ellipse
/// that a pixel covers, and for a triangle seen almost edge-on that ellipse is unbounded, so that a frame was
/// observed that never ended.
fn anisotropy(device: wgpu::DeviceType) -> u16 {
    if device == wgpu::DeviceType::Cpu { 1 } else { 8 }
}

/// Number of storage buffers of the shader that poses vertices.
const SKIN_BUFFERS: u32 = 6;

/// Returns whether a device with these limits can pose vertices in a compute shader; almost every one can.
fn skins_once(adapter: &wgpu::Adapter, limits: &wgpu::Limits) -> bool {
    adapter.get_downlevel_capabilities().flags.contains(wgpu::DownlevelFlags::COMPUTE_SHADERS)
        && limits.max_storage_buffers_per_shader_stage >= SKIN_BUFFERS
}

/// The limits that every adapter supports, raised where this one does: large models need large buffers.
fn limits(adapter: &wgpu::Limits) -> wgpu::Limits {
    let base = wgpu::Limits::downlevel_defaults().using_resolution(adapter.clone());
    let storage_buffers = adapter.max_storage_buffers_per_shader_stage.min(SKIN_BUFFERS);
    wgpu::Limits {
        max_storage_buffers_per_shader_stage: base.max_storage_buffers_per_shader_stage.max(storage_buffers),
        max_buffer_size: adapter.max_buffer_size,
        max_storage_buffer_binding_size: adapter.max_storage_buffer_binding_size,
        ..base
    }
}

/// Describes a bind group layout with one uniform of type `T` at binding 0.
pub(crate) fn uniform_binding<T>(
    device: &wgpu::Device,
    label: &str,
) -> (wgpu::BindGroupLayout, wgpu::BindGroup, wgpu::Buffer) {
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: wgpu::BufferSize::new(size_of::<T>() as u64),
            },
            count: None,
        }],
    });
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size_of::<T>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(label),
        layout: &layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
    });
    (layout, group, buffer)
}
