//! The textures that the scene is drawn into: as large as the viewport, made anew when that changes.

use super::gpu::{DEPTH_FORMAT, Gpu, SAMPLES, SCENE_FORMAT};

/// Colour with many samples, depth, and the colour they are resolved to.
pub struct SceneTarget {
    size: [u32; 2],
    samples: wgpu::TextureView,
    depth: wgpu::TextureView,
    resolved: wgpu::Texture,
    view: wgpu::TextureView,
}

impl SceneTarget {
    /// Textures of `size` pixels, none zero.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
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
        let resolved = texture("scene", SCENE_FORMAT, 1, readable);
        Self {
            size,
            samples: view(&texture("scene samples", SCENE_FORMAT, SAMPLES, nothing)),
            depth: view(&texture("scene depth", DEPTH_FORMAT, SAMPLES, nothing)),
            view: view(&resolved),
            resolved,
        }
    }

    /// Pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The finished scene, to read from in a shader.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// The finished scene, to copy from.
    pub fn texture(&self) -> &wgpu::Texture {
        &self.resolved
    }

    /// Begins to draw the scene into an empty picture.
    pub fn begin(&self, encoder: &mut wgpu::CommandEncoder) -> wgpu::RenderPass<'static> {
        let color = wgpu::RenderPassColorAttachment {
            view: &self.samples,
            depth_slice: None,
            resolve_target: Some(&self.view),
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                // Only what they resolve to is wanted.
                store: wgpu::StoreOp::Discard,
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

/// Begins to draw into the window, or what stands for it.
pub fn begin_window(
    encoder: &mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
) -> wgpu::RenderPass<'static> {
    let color = wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            // Seen for a moment where panels have not caught up with a growing window.
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
