//! Recording draws into a render pass: only what differs from the previous draw is set.

use super::geometry::GpuGeometry;
use std::ops::{Add, Range};

/// Number of commands recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct DrawCounts {
    /// Draw calls.
    pub(super) draws: usize,
    /// Pipelines and bind groups set.
    pub(super) state_changes: usize,
}

impl Add for DrawCounts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { draws: self.draws + other.draws, state_changes: self.state_changes + other.state_changes }
    }
}

/// Records draws of surfaces.
pub(super) struct DrawRecorder<'a, 'p> {
    pass: &'a mut wgpu::RenderPass<'p>,
    pipeline: Option<&'a wgpu::RenderPipeline>,
    groups: [Option<&'a wgpu::BindGroup>; 4],
    vertices: Option<&'a wgpu::Buffer>,
    counts: DrawCounts,
}

impl<'a, 'p> DrawRecorder<'a, 'p> {
    /// Starts with `frame` as bind group 0 and nothing else set.
    pub(super) fn new(pass: &'a mut wgpu::RenderPass<'p>, frame: &'a wgpu::BindGroup) -> Self {
        Self::at(pass, frame, &[])
    }

    /// Starts with a part of `group` as bind group 0, from these bytes on, and nothing else set.
    pub(super) fn at(
        pass: &'a mut wgpu::RenderPass<'p>,
        group: &'a wgpu::BindGroup,
        offsets: &[u32],
    ) -> Self {
        pass.set_bind_group(0, group, offsets);
        let counts = DrawCounts { draws: 0, state_changes: 1 };
        Self { pass, pipeline: None, groups: [Some(group), None, None, None], vertices: None, counts }
    }

    /// Number of commands recorded so far.
    pub(super) fn counts(&self) -> DrawCounts {
        self.counts
    }

    /// Sets the buffer with the instances of all draws.
    pub(super) fn instances(&mut self, instances: &wgpu::Buffer) {
        self.instances_from(instances, 0);
    }

    /// Sets the buffer with the instances of all draws, which start at this byte of it.
    pub(super) fn instances_from(&mut self, instances: &wgpu::Buffer, start: u64) {
        self.pass.set_vertex_buffer(1, instances.slice(start..));
    }

    /// Sets a bind group.
    pub(super) fn group(&mut self, index: usize, group: &'a wgpu::BindGroup) {
        if self.groups[index] != Some(group) {
            self.groups[index] = Some(group);
            self.pass.set_bind_group(index as u32, group, &[]);
            self.counts.state_changes += 1;
        }
    }

    /// Draws instances of `geometry`.
    pub(super) fn draw(
        &mut self,
        pipeline: &'a wgpu::RenderPipeline,
        geometry: &'a GpuGeometry,
        instances: Range<u32>,
    ) {
        if self.pipeline != Some(pipeline) {
            self.pipeline = Some(pipeline);
            self.pass.set_pipeline(pipeline);
            self.counts.state_changes += 1;
        }
        if self.vertices != Some(&geometry.vertices) {
            self.vertices = Some(&geometry.vertices);
            self.pass.set_vertex_buffer(0, geometry.vertices.slice(..));
            self.pass.set_index_buffer(geometry.indices.slice(..), wgpu::IndexFormat::Uint32);
        }
        self.pass.draw_indexed(0..geometry.count, 0, instances);
        self.counts.draws += 1;
    }
}
