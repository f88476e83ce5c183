//! The sum of sub-frames on the device, and the image that is developed from it.
//!
//! Sums are 32-bit floating-point numbers in two textures that are written in turn, because not every device can blend them; the order of
//! additions is that of the sub-frames, so the result is the same whenever it is computed.

use crate::full_screen::{
    draw_full_screen, fragment_layout, full_screen_pipeline, image_entry, uniform_entry,
};
use crate::gpu::{Gpu, SUM_FORMAT};
use crate::shaders;
use crate::target::SceneTarget;

/// Format of the developed image: encoded by its shader, straight alpha.
const DEVELOPED_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The uniform of the shader. WGSL twin: `Develop` in `shaders/accumulate.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct DevelopUniform {
    /// 1 divided by the number of sub-frames.
    weight: f32,
    /// 1 where the tone map is applied, 0 where colors are shown as they are.
    tone: f32,
    pad: [f32; 2],
}

/// A texture to draw into, and its view.
struct SumTexture {
    texture: wgpu::Texture,
    view: wgpu::TextureView,
}

/// The sum of the sub-frames of a frame.
pub(crate) struct FrameSum {
    /// The sub-frame that is added next, and last what is drawn under the scene.
    target: SceneTarget,
    sums: [SumTexture; 2],
    developed: SumTexture,
    /// Bind groups that read the first and the second sum.
    groups: [wgpu::BindGroup; 2],
    uniform: wgpu::Buffer,
    first: wgpu::RenderPipeline,
    add: wgpu::RenderPipeline,
    develop: wgpu::RenderPipeline,
    linear: wgpu::RenderPipeline,
    /// Number of sub-frames added.
    count: u32,
}

impl FrameSum {
    /// Creates the textures for frames of `size` pixels, both sides positive.
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let target = SceneTarget::new(gpu, size);
        let sums = [(); 2].map(|()| SumTexture::new(gpu, "sum of sub-frames", SUM_FORMAT, size));
        let developed = SumTexture::new(gpu, "developed frame", DEVELOPED_FORMAT, size);
        let uniform = gpu.buffer("develop", size_of::<DevelopUniform>(), wgpu::BufferUsages::UNIFORM);
        // The sum, the target of sub-frames, the uniform.
        let bindings = [image_entry(false), image_entry(false), uniform_entry::<DevelopUniform>()];
        let layout = fragment_layout(&gpu.device, "accumulate", &bindings);
        let groups = [&sums[0], &sums[1]].map(|sum| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("accumulate"),
                layout: &layout,
                entries: &[
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: wgpu::BindingResource::TextureView(&sum.view),
                    },
                    wgpu::BindGroupEntry {
                        binding: 1,
                        resource: wgpu::BindingResource::TextureView(target.view()),
                    },
                    wgpu::BindGroupEntry { binding: 2, resource: uniform.as_entire_binding() },
                ],
            })
        });
        let module = shaders::ACCUMULATE.module(&gpu.device);
        let pipeline = |fragment, format| {
            full_screen_pipeline(&gpu.device, &module, &layout, ["vs_accumulate", fragment], format)
        };
        Self {
            first: pipeline("fs_first", SUM_FORMAT),
            add: pipeline("fs_add", SUM_FORMAT),
            develop: pipeline("fs_develop", DEVELOPED_FORMAT),
            linear: pipeline("fs_linear", SUM_FORMAT),
            target,
            sums,
            developed,
            groups,
            uniform,
            count: 0,
        }
    }

    /// Size of the frames, pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.target.size()
    }

    /// The target of the next sub-frame.
    pub(crate) fn target(&self) -> &SceneTarget {
        &self.target
    }

    /// Begins the next frame.
    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds the sub-frame that is in the target.
    pub(crate) fn add(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let next = (self.count % 2) as usize;
        let pipeline = if self.count == 0 { &self.first } else { &self.add };
        draw_full_screen(encoder, &self.sums[next].view, pipeline, &self.groups[1 - next]);
        self.count += 1;
    }

    /// Develops the image, over what is in the target.
    pub(crate) fn develop(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, has_tone_map: bool) {
        let uniform = DevelopUniform {
            weight: 1.0 / self.count.max(1) as f32,
            tone: f32::from(u8::from(has_tone_map)),
            pad: [0.0; 2],
        };
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        draw_full_screen(encoder, &self.developed.view, &self.develop, &self.groups[self.newest()]);
    }

    /// The image that was developed last.
    pub(crate) fn developed(&self) -> &wgpu::Texture {
        &self.developed.texture
    }

    /// Writes the light of the frame that was developed last, before the tone map and multiplied by alpha. Returns its texture, which the next
    /// frame overwrites.
    pub(crate) fn write_linear(&self, encoder: &mut wgpu::CommandEncoder) -> &wgpu::Texture {
        let newest = self.newest();
        let free = &self.sums[1 - newest];
        draw_full_screen(encoder, &free.view, &self.linear, &self.groups[newest]);
        &free.texture
    }

    /// Index of the texture with the sum of all sub-frames.
    fn newest(&self) -> usize {
        (self.count.saturating_sub(1) % 2) as usize
    }
}

impl SumTexture {
    fn new(gpu: &Gpu, label: &str, format: wgpu::TextureFormat, [width, height]: [u32; 2]) -> Self {
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC;
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        });
        Self { view: texture.create_view(&Default::default()), texture }
    }
}
