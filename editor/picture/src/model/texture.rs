//! Images on the device, with all mip levels.

use crate::full_screen::{draw_full_screen, fragment_layout, full_screen_pipeline, image_entry};
use crate::gpu::Gpu;
use crate::shaders;
use crate::texture_memory::STAGING;
use dragonfly_document::DecodedImage;

/// Creates textures, and keeps the pipeline that makes mip levels.
pub(super) struct TextureMaker {
    layout: wgpu::BindGroupLayout,
    module: wgpu::ShaderModule,
    sampler: wgpu::Sampler,
    pipelines: [Option<wgpu::RenderPipeline>; 2],
    /// Bytes that the device may not have copied yet.
    staged: u64,
}

impl TextureMaker {
    /// Creates a maker on `gpu`.
    pub(super) fn new(gpu: &Gpu) -> Self {
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let layout = fragment_layout(&gpu.device, "mip", &[image_entry(true), sampler]);
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("mip"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self { layout, module: shaders::MIP.module(&gpu.device), sampler, pipelines: [None, None], staged: 0 }
    }

    /// Uploads `image` as a texture; `encoded` for sRGB colors. `None` for an image that is empty, truncated or
    /// larger than the device supports.
    pub(super) fn texture(
        &mut self,
        gpu: &Gpu,
        image: &DecodedImage,
        encoded: bool,
    ) -> Option<wgpu::TextureView> {
        let DecodedImage { width, height, .. } = *image;
        let bytes = u64::from(width) * u64::from(height) * 4;
        if bytes == 0 || width.max(height) > gpu.max_side || bytes != image.pixels.len() as u64 {
            return None;
        }
        let format =
            if encoded { wgpu::TextureFormat::Rgba8UnormSrgb } else { wgpu::TextureFormat::Rgba8Unorm };
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let levels = width.max(height).ilog2() + 1;
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("image"),
            size,
            mip_level_count: levels,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_DST
                | wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        });
        self.write(gpu, &texture, image);
        self.fill_levels(gpu, &texture, levels, format, encoded);
        Some(texture.create_view(&wgpu::TextureViewDescriptor::default()))
    }

    /// Writes the largest level, a part after the other: until the device has copied a part, its pixels exist once more.
    fn write(&mut self, gpu: &Gpu, texture: &wgpu::Texture, image: &DecodedImage) {
        let row = image.width * 4;
        let rows = (STAGING / u64::from(row)).max(1) as u32;
        let parts = image.pixels.chunks((rows * row) as usize);
        for (first, part) in (0..image.height).step_by(rows as usize).zip(parts) {
            let height = rows.min(image.height - first);
            if self.staged + part.len() as u64 > STAGING {
                gpu.queue.submit([]);
                // A lost device is reported by the next frame.
                let _ = crate::guard::caught(|| drop(gpu.device.poll(wgpu::PollType::wait_indefinitely())));
                self.staged = 0;
            }
            self.staged += part.len() as u64;
            let origin = wgpu::Origin3d { y: first, ..wgpu::Origin3d::ZERO };
            gpu.queue.write_texture(
                wgpu::TexelCopyTextureInfo { origin, ..texture.as_image_copy() },
                part,
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
                wgpu::Extent3d { width: image.width, height, depth_or_array_layers: 1 },
            );
        }
    }

    /// Computes every mip level from the one above it. The device filters in linear light, whatever the format.
    fn fill_levels(
        &mut self,
        gpu: &Gpu,
        texture: &wgpu::Texture,
        levels: u32,
        format: wgpu::TextureFormat,
        encoded: bool,
    ) {
        let pipeline = self.pipelines[usize::from(encoded)].get_or_insert_with(|| {
            full_screen_pipeline(&gpu.device, &self.module, &self.layout, ["vs_mip", "fs_mip"], format)
        });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let view = |level| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                base_mip_level: level,
                mip_level_count: Some(1),
                ..Default::default()
            })
        };
        for level in 1..levels {
            let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("mip"),
                layout: &self.layout,
                entries: &[
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: wgpu::BindingResource::TextureView(&view(level - 1)),
                    },
                    wgpu::BindGroupEntry {
                        binding: 1,
                        resource: wgpu::BindingResource::Sampler(&self.sampler),
                    },
                ],
            });
            draw_full_screen(&mut encoder, &view(level), pipeline, &group);
        }
        gpu.queue.submit([encoder.finish()]);
    }
}
