//! The panels over the scene, as the main thread painted them.
//!
//! egui sends each of its textures once. A copy stays here, so that they come back with a new device; and what belongs to
//! frames that were never drawn is applied all the same.

use super::{Commands, Layer, Pass, Surroundings};
use crate::device::DeviceListener;
use crate::gpu::Gpu;
use crate::message::PanelsFrame;
use egui::epaint::ImageDelta;
use egui::{ColorImage, ImageData, TextureId, TextureOptions, TexturesDelta};
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use std::collections::HashMap;

/// Draws them.
#[derive(Default)]
pub struct PanelsPass {
    renderer: Option<Renderer>,
    frame: Option<Box<PanelsFrame>>,
    mirror: HashMap<TextureId, (ColorImage, TextureOptions)>,
    /// In the mirror, not yet on the device.
    pending: TexturesDelta,
    /// Used by the frame drawn last, not by the next.
    outdated: Vec<TextureId>,
}

impl PanelsPass {
    /// Shows `frame` from now on, instead of any that was not drawn yet.
    pub fn show(&mut self, mut frame: Box<PanelsFrame>) {
        let textures = std::mem::take(&mut frame.textures);
        for (&id, deltas) in &textures.set {
            for delta in deltas {
                self.remember(id, delta);
            }
        }
        self.pending.append(textures);
        self.frame = Some(frame);
    }

    /// Size of the window for which the panels were laid out.
    pub fn size(&self) -> Option<[u32; 2]> {
        self.frame.as_ref().map(|frame| frame.size)
    }

    fn remember(&mut self, id: TextureId, delta: &ImageDelta) {
        let ImageData::Color(image) = &delta.image;
        match delta.pos {
            None => {
                self.mirror.insert(id, (ColorImage::clone(image), delta.options));
            }
            Some([x, y]) => {
                let Some((whole, options)) = self.mirror.get_mut(&id) else { return };
                *options = delta.options;
                let ([width, _], [whole_width, _]) = (image.size, whole.size);
                for (row, pixels) in image.pixels.chunks_exact(width.max(1)).enumerate() {
                    let start = (y + row) * whole_width + x;
                    if let Some(target) = whole.pixels.get_mut(start..start + width) {
                        target.copy_from_slice(pixels);
                    }
                }
            }
        }
    }
}

impl DeviceListener for PanelsPass {
    fn on_lost(&mut self) {
        self.renderer = None;
    }

    fn on_reset(&mut self, gpu: &Gpu) {
        let mut renderer = Renderer::new(&gpu.device, gpu.window_format, RendererOptions::default());
        for (&id, (image, options)) in &self.mirror {
            let delta = ImageDelta::full(image.clone(), *options);
            renderer.update_texture(&gpu.device, &gpu.queue, id, &delta);
        }
        self.pending.set.clear();
        self.renderer = Some(renderer);
    }
}

impl Drop for PanelsPass {
    /// egui insists that no texture is forgotten by mistake; this is on purpose.
    fn drop(&mut self) {
        self.pending.clear();
    }
}

impl Pass for PanelsPass {
    fn name(&self) -> &'static str {
        "panels"
    }

    fn layer(&self) -> Layer {
        Layer::Window
    }

    fn prepare(&mut self, around: &Surroundings<'_>, commands: &mut Commands) {
        let (Some(renderer), Some(frame)) = (&mut self.renderer, &self.frame) else { return };
        for id in self.outdated.drain(..) {
            renderer.free_texture(&id);
            self.mirror.remove(&id);
        }
        for (&id, deltas) in &self.pending.set {
            for delta in deltas {
                renderer.update_texture(&around.gpu.device, &around.gpu.queue, id, delta);
            }
        }
        self.pending.set.clear();
        self.outdated.extend(self.pending.free.drain());
        let screen = screen(around, frame);
        let (device, queue) = (&around.gpu.device, &around.gpu.queue);
        let buffers = renderer.update_buffers(device, queue, &mut commands.encoder, &frame.jobs, &screen);
        commands.before.extend(buffers);
    }

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        if let (Some(renderer), Some(frame)) = (&self.renderer, &self.frame) {
            renderer.render(pass, &frame.jobs, &screen(around, frame));
        }
    }
}

/// The window as it is, which need not be what the panels were laid out for: drawing outside of it would be an error.
fn screen(around: &Surroundings<'_>, frame: &PanelsFrame) -> ScreenDescriptor {
    ScreenDescriptor { size_in_pixels: around.window_size, pixels_per_point: frame.pixels_per_point }
}
