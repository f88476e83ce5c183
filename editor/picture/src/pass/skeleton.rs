//! The bones in their pose, in front of the surface or hidden by it.

use super::definition::{FrameCommands, Pass, PassLayer, Surroundings, scene_pipeline};
use crate::body::{BodyMesh, BodyVertex};
use crate::device::DeviceListener;
use crate::gpu::Gpu;
use crate::shaders;
use crate::shape::{Body, BoneInstance};
use wgpu::util::DeviceExt;

/// Depth range of bones that are drawn in front: nearer than everything else, but still ordered among themselves.
const IN_FRONT: std::ops::Range<f32> = 0.9..1.0;

/// Draws the bones.
#[derive(Default)]
pub(super) struct SkeletonPass {
    resources: Option<SkeletonResources>,
}

struct SkeletonResources {
    outline: wgpu::RenderPipeline,
    solid: wgpu::RenderPipeline,
    line: wgpu::RenderPipeline,
    /// Mesh of each body, in the order of [`Body::ALL`].
    bodies: [GpuBody; 4],
    /// Instance buffers, in the order of [`Body::ALL`]; they grow with the skeleton.
    instances: [Option<wgpu::Buffer>; 4],
}

/// A body on the device.
struct GpuBody {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    /// Number of indices.
    count: u32,
}

impl GpuBody {
    fn new(gpu: &Gpu, body: Body) -> Self {
        let BodyMesh { vertices, indices } = BodyMesh::of(body);
        let buffer = |label, contents, usage| {
            let descriptor = wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage };
            gpu.device.create_buffer_init(&descriptor)
        };
        Self {
            vertices: buffer("body", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            indices: buffer("body's triangles", bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX),
            count: indices.len() as u32,
        }
    }
}

impl DeviceListener for SkeletonPass {
    fn on_lost(&mut self) {
        self.resources = None;
    }

    fn on_reset(&mut self, gpu: &Gpu) {
        let module = shaders::SKELETON.module(&gpu.device);
        let corner = wgpu::VertexBufferLayout {
            array_stride: size_of::<BodyVertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x3, 2 => Float32x3],
        };
        let bone = wgpu::VertexBufferLayout {
            array_stride: size_of::<BoneInstance>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &wgpu::vertex_attr_array![
                3 => Float32x3, 4 => Float32, 5 => Float32x3, 6 => Uint32, 7 => Float32x3, 8 => Float32
            ],
        };
        let without = |face| wgpu::PrimitiveState { cull_mode: Some(face), ..Default::default() };
        let (inside, outside) = (without(wgpu::Face::Front), without(wgpu::Face::Back));
        let buffers = [Some(corner), Some(bone.clone())];
        let outline = scene_pipeline(gpu, &module, ["vs_outline", "fs_outline"], &buffers, inside, false);
        let solid = scene_pipeline(gpu, &module, ["vs_bone", "fs_bone"], &buffers, outside, false);
        let line =
            scene_pipeline(gpu, &module, ["vs_line", "fs_line"], &[Some(bone)], Default::default(), true);
        let bodies = Body::ALL.map(|body| GpuBody::new(gpu, body));
        self.resources =
            Some(SkeletonResources { outline, solid, line, bodies, instances: [const { None }; 4] });
    }
}

impl Pass for SkeletonPass {
    fn name(&self) -> &'static str {
        "skeleton"
    }

    fn layer(&self) -> PassLayer {
        PassLayer::Scene
    }

    fn prepare(&mut self, around: &Surroundings<'_>, _: &mut FrameCommands) {
        let model = around.scene.model_in_view().filter(|_| around.scene.look.skeleton);
        let (Some(resources), Some(model)) = (&mut self.resources, model) else { return };
        for (body, buffer) in Body::ALL.into_iter().zip(&mut resources.instances) {
            let bytes: &[u8] = bytemuck::cast_slice(model.shape().instances(body));
            if bytes.is_empty() {
                continue;
            }
            if buffer.as_ref().is_none_or(|buffer| buffer.size() < bytes.len() as u64) {
                let room = model.shape().capacity() * size_of::<BoneInstance>();
                *buffer = Some(around.gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("bones"),
                    size: room as u64,
                    usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                }));
            }
            if let Some(buffer) = buffer {
                around.gpu.queue.write_buffer(buffer, 0, bytes);
            }
        }
    }

    fn draw(&mut self, around: &Surroundings<'_>, pass: &mut wgpu::RenderPass<'static>) {
        let (Some(resources), Some(model)) = (&self.resources, around.scene.model_in_view()) else { return };
        let look = &around.scene.look;
        if !look.skeleton {
            return;
        }
        let size = around.scene.size();
        if look.bones_in_front {
            pass.set_viewport(0.0, 0.0, size.x, size.y, IN_FRONT.start, IN_FRONT.end);
        }
        pass.set_bind_group(0, &around.gpu.frame_group, &[]);
        for (index, body) in Body::ALL.into_iter().enumerate() {
            let count = model.shape().instances(body).len() as u32;
            let mesh = &resources.bodies[index];
            let Some(instances) = resources.instances[index].as_ref().filter(|_| count > 0) else { continue };
            if body == Body::Line {
                pass.set_pipeline(&resources.line);
                pass.set_vertex_buffer(0, instances.slice(..));
                pass.draw(0..6, 0..count);
            } else {
                pass.set_vertex_buffer(0, mesh.vertices.slice(..));
                pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint16);
                pass.set_vertex_buffer(1, instances.slice(..));
                for pipeline in [&resources.outline, &resources.solid] {
                    pass.set_pipeline(pipeline);
                    pass.draw_indexed(0..mesh.count, 0, 0..count);
                }
            }
        }
        pass.set_viewport(0.0, 0.0, size.x, size.y, 0.0, 1.0);
    }
}
