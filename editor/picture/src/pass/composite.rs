//! Copies the finished scene into the window: encoded for the screen exactly once, and only within the viewport.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings};
use crate::device::DeviceListener;
use crate::full_screen::{fragment_layout, full_screen_pipeline, image_entry, uniform_entry};
use crate::gpu::Gpu;
use crate::shaders;

/// Copies the scene into the window.
#[derive(Default)]
pub(super) struct CompositePass {
    resources: Option<CompositeResources>,
}

struct CompositeResources {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    /// The scene in the viewport, and the second view.
    images: [CompositeImage; 2],
}

/// A finished image, and its place in the window.
struct CompositeImage {
    place: wgpu::Buffer,
    /// Bind group for the texture, and the texture view it was created for.
    group: Option<(wgpu::TextureView, wgpu::BindGroup)>,
}

/// Returns the images of a frame with their rectangles in the window, pixels.
fn images<'a>(around: &Surroundings<'a>) -> [(Option<&'a wgpu::TextureView>, [u32; 4]); 2] {
    let look = &around.scene.look;
    let second = look.second.as_ref().map_or([0; 4], |second| second.viewport);
    [(around.scene_view, look.viewport), (around.second_view, second)]
}

impl DeviceListener for CompositePass {
    fn on_lost(&mut self) {
        self.resources = None;
    }

    fn on_reset(&mut self, gpu: &Gpu) {
        let layout =
            fragment_layout(&gpu.device, "composite", &[image_entry(false), uniform_entry::<[f32; 4]>()]);
        let image = || CompositeImage {
            place: gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("place"),
                size: 16,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            group: None,
        };
        let images = [image(), image()];
        self.resources = Some(CompositeResources { pipeline: pipeline(gpu, &layout), layout, images });
    }
}

impl Pass for CompositePass {
    fn name(&self) -> &'static str {
        "composite"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Window
    }

    fn prepare(&mut self, around: &Surroundings<'_>, _: &mut FrameCommands) {
        let Some(resources) = &mut self.resources else { return };
        let layout = &resources.layout;
        for (image, (view, [x, y, ..])) in resources.images.iter_mut().zip(images(around)) {
            let Some(view) = view else {
                image.group = None;
                continue;
            };
            // WGSL twin: `Place` in `shaders/composite.wgsl`.
            let place = [x as f32, y as f32, 0.0, 0.0];
            around.gpu.queue.write_buffer(&image.place, 0, bytemuck::bytes_of(&place));
            if image.group.as_ref().is_none_or(|(known, _)| known != view) {
                let group = around.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some("composite"),
                    layout,
                    entries: &[
                        wgpu::BindGroupEntry {
                            binding: 0,
                            resource: wgpu::BindingResource::TextureView(view),
                        },
                        wgpu::BindGroupEntry { binding: 1, resource: image.place.as_entire_binding() },
                    ],
                });
                image.group = Some((view.clone(), group));
            }
        }
    }

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        let Some(resources) = &self.resources else { return };
        let [window_width, window_height] = around.window_size;
        for (image, (view, [x, y, width, height])) in resources.images.iter().zip(images(around)) {
            let (Some((_, group)), Some(_)) = (&image.group, view) else { continue };
            // The window may have become smaller than the viewport was laid out for.
            let width = width.min(window_width.saturating_sub(x));
            let height = height.min(window_height.saturating_sub(y));
            if width > 0 && height > 0 {
                pass.set_pipeline(&resources.pipeline);
                pass.set_bind_group(0, group, &[]);
                pass.set_scissor_rect(x, y, width, height);
                pass.draw(0..3, 0..1);
                pass.set_scissor_rect(0, 0, window_width, window_height);
            }
        }
    }
}

fn pipeline(gpu: &Gpu, layout: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    let module = shaders::COMPOSITE.module(&gpu.device);
    let encode = if gpu.window_format.is_srgb() { "fs_plain" } else { "fs_encode" };
    full_screen_pipeline(&gpu.device, &module, layout, ["vs_composite", encode], gpu.window_format)
}
