//! The controls of the scene, drawn over everything (the thesis's ControlRender, §3.2.9.2): lines with a width in
//! points, and triangles, in the colors of the theme.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings};
use crate::device::DeviceListener;
use crate::gizmo::{GizmoRole, GizmoVertex};
use crate::gpu::{DEPTH_FORMAT, Gpu, uniform_binding};
use crate::message::Look;
use crate::shaders;

/// Width of lines, points.
const WIDTH: f32 = 2.4;

/// Draws the controls.
#[derive(Default)]
pub(super) struct ControlRender {
    resources: Option<ControlResources>,
}

struct ControlResources {
    line: wgpu::RenderPipeline,
    fill: wgpu::RenderPipeline,
    style: wgpu::Buffer,
    group: wgpu::BindGroup,
    lines: Corners,
    triangles: Corners,
}

/// A buffer that grows, and the number of bytes in use.
#[derive(Default)]
struct Corners {
    buffer: Option<wgpu::Buffer>,
    count: u32,
}

impl Corners {
    fn write(&mut self, gpu: &Gpu, corners: &[GizmoVertex]) {
        self.count = corners.len() as u32;
        let bytes: &[u8] = bytemuck::cast_slice(corners);
        if bytes.is_empty() {
            return;
        }
        if self.buffer.as_ref().is_none_or(|buffer| buffer.size() < bytes.len() as u64) {
            self.buffer = Some(gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("controls"),
                size: (bytes.len() as u64).next_power_of_two(),
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
        }
        if let Some(buffer) = &self.buffer {
            gpu.queue.write_buffer(buffer, 0, bytes);
        }
    }
}

impl DeviceListener for ControlRender {
    fn on_lost(&mut self) {
        self.resources = None;
    }

    fn on_reset(&mut self, gpu: &Gpu) {
        let (layout, group, style) = uniform_binding::<ControlStyle>(&gpu.device, "controls");
        self.resources = Some(ControlResources {
            line: pipeline(gpu, &layout, ControlPrimitive::Line),
            fill: pipeline(gpu, &layout, ControlPrimitive::Triangle),
            style,
            group,
            lines: Corners::default(),
            triangles: Corners::default(),
        });
    }
}

impl Pass for ControlRender {
    fn name(&self) -> &'static str {
        "controls"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Scene
    }

    fn prepare(&mut self, around: &Surroundings<'_>, _: &mut FrameCommands) {
        let Some(resources) = &mut self.resources else { return };
        let shape = around.scene.controls.shape();
        resources.lines.write(around.gpu, shape.lines());
        resources.triangles.write(around.gpu, shape.triangles());
        let style = ControlStyle::of(&around.scene.look);
        around.gpu.queue.write_buffer(&resources.style, 0, bytemuck::bytes_of(&style));
    }

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        let Some(resources) = &self.resources else { return };
        // Faces are drawn under their outlines.
        for (corners, pipeline) in
            [(&resources.triangles, &resources.fill), (&resources.lines, &resources.line)]
        {
            let Some(buffer) = corners.buffer.as_ref().filter(|_| corners.count > 0) else { continue };
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &around.gpu.frame_group, &[]);
            pass.set_bind_group(1, &resources.group, &[]);
            pass.set_vertex_buffer(0, buffer.slice(..));
            if std::ptr::eq(corners, &resources.lines) {
                pass.draw(0..6, 0..corners.count / 2);
            } else {
                pass.draw(0..corners.count, 0..1);
            }
        }
    }
}

/// The uniform of the pass. WGSL twin: `ControlStyle` in `shaders/controls.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
struct ControlStyle {
    /// Colors by role, linear RGB.
    colors: [[f32; 4]; GizmoRole::COUNT],
    /// Half the width of a line, pixels.
    half_width: f32,
    /// Pixels of a point.
    pixels: f32,
    pad: [f32; 2],
}

impl ControlStyle {
    fn of(look: &Look) -> Self {
        let colors = GizmoRole::ALL.map(|role| {
            let [red, green, blue] = look.handles.get(role);
            [red, green, blue, 1.0]
        });
        let pixels = look.pixels_per_point.max(0.1);
        Self { colors, half_width: WIDTH * pixels / 2.0, pixels, pad: [0.0; 2] }
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum ControlPrimitive {
    Line,
    Triangle,
}

/// Creates a pipeline without a depth test: handles must be reachable whatever is in front of them.
fn pipeline(gpu: &Gpu, layout: &wgpu::BindGroupLayout, shape: ControlPrimitive) -> wgpu::RenderPipeline {
    let module = shaders::CONTROLS.module(&gpu.device);
    let size = size_of::<GizmoVertex>() as u64;
    let corner = wgpu::vertex_attr_array![0 => Float32x3, 1 => Uint32, 2 => Float32];
    let ends = wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Uint32, 2 => Float32, 3 => Float32x3, 4 => Uint32, 5 => Float32
    ];
    let (entry, stride, step_mode, attributes) = match shape {
        ControlPrimitive::Triangle => ("vs_fill", size, wgpu::VertexStepMode::Vertex, &corner[..]),
        ControlPrimitive::Line => ("vs_line", 2 * size, wgpu::VertexStepMode::Instance, &ends[..]),
    };
    let buffer = wgpu::VertexBufferLayout { array_stride: stride, step_mode, attributes };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("controls"),
        layout: Some(&gpu.pipeline_layout("controls", &[layout])),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            buffers: &[Some(buffer)],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(false),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: gpu.scene_samples(false),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(if shape == ControlPrimitive::Line { "fs_line" } else { "fs_fill" }),
            compilation_options: Default::default(),
            targets: &gpu.scene_target(true),
        }),
        multiview_mask: None,
        cache: None,
    })
}
