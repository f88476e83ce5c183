//! The panels over the scene, as laid out by the main thread.
//!
//! egui sends each of its textures once. A copy is kept here, so that the textures can be loaded on a new device; the
//! textures of frames that were never drawn are applied too.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings};
use crate::device::DeviceListener;
use crate::gpu::Gpu;
use crate::message::PanelsFrame;
use egui::epaint::ImageDelta;
use egui::{ColorImage, ImageData, TextureId, TextureOptions, TexturesDelta};
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use std::collections::HashMap;

/// Draws the panels.
#[derive(Default)]
pub struct PanelsPass {
    renderer: Option<Renderer>,
    frame: Option<Box<PanelsFrame>>,
    mirror: HashMap<TextureId, (ColorImage, TextureOptions)>,
    /// Textures in the mirror that are not yet on the device.
    pending: TexturesDelta,
    /// Textures that the last frame used and the next one does not.
    outdated: Vec<TextureId>,
}

impl PanelsPass {
    /// Shows `frame` from now on, replacing any frame that was not drawn yet.
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

    /// Size of the window that the panels were laid out for.
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
    /// Clears the textures deliberately, because egui panics when any are dropped.
    fn drop(&mut self) {
        self.pending.clear();
    }
}

impl Pass for PanelsPass {
    fn name(&self) -> &'static str {
        "panels"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Window
    }

    fn prepare(&mut self, around: &Surroundings<'_>, commands: &mut FrameCommands) {
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

/// The size of the window as it is, which may differ from the size the panels were laid out for: drawing outside of
/// it would be an error.
fn screen(around: &Surroundings<'_>, frame: &PanelsFrame) -> ScreenDescriptor {
    ScreenDescriptor { size_in_pixels: around.window_size, pixels_per_point: frame.pixels_per_point }
}
