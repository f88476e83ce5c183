//! The textures that the scene is drawn into: as large as the viewport, created again when its size changes.

use super::gpu::{DEPTH_FORMAT, Gpu};

/// Multisampled color, depth, and the color that the samples are resolved to. With one sample per pixel there is nothing to
/// resolve.
pub struct SceneTarget {
    size: [u32; 2],
    samples: Option<wgpu::TextureView>,
    depth: wgpu::TextureView,
    resolved: wgpu::Texture,
    view: wgpu::TextureView,
}

impl SceneTarget {
    /// Creates textures of `size` pixels, both sides positive.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let format = gpu.encoding().format();
        let texture = |label, format, sample_count, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let nothing = wgpu::TextureUsages::empty();
        let readable = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let resolved = texture("scene", format, 1, readable);
        Self {
            size,
            samples: (gpu.samples > 1).then(|| view(&texture("scene samples", format, gpu.samples, nothing))),
            depth: view(&texture("scene depth", DEPTH_FORMAT, gpu.samples, nothing)),
            view: view(&resolved),
            resolved,
        }
    }

    /// Size in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The finished scene, for reading in a shader.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// The finished scene, for copying.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.resolved
    }

    /// Begins drawing the scene into a cleared target.
    pub fn begin(&self, encoder: &mut wgpu::CommandEncoder) -> wgpu::RenderPass<'static> {
        let color = wgpu::RenderPassColorAttachment {
            view: self.samples.as_ref().unwrap_or(&self.view),
            depth_slice: None,
            resolve_target: self.samples.as_ref().map(|_| &self.view),
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                // Only the resolved color is needed.
                store: if self.samples.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store },
            },
        };
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(0.0),
                store: wgpu::StoreOp::Discard,
            }),
            stencil_ops: None,
        };
        encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("scene"),
                color_attachments: &[Some(color)],
                depth_stencil_attachment: Some(depth),
                ..Default::default()
            })
            .forget_lifetime()
    }
}

/// Begins drawing into the window, or the texture that replaces it.
pub fn begin_window(
    encoder: &mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
) -> wgpu::RenderPass<'static> {
    let color = wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            // Visible for a moment where the panels have not caught up with a growing window.
            load: wgpu::LoadOp::Clear(wgpu::Color { r: 0.09, g: 0.095, b: 0.105, a: 1.0 }),
            store: wgpu::StoreOp::Store,
        },
    };
    encoder
        .begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("window"),
            color_attachments: &[Some(color)],
            ..Default::default()
        })
        .forget_lifetime()
}
