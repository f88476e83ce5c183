//! Posing vertices once a frame, in a compute shader, for all passes that draw them.
//!
//! It costs a buffer of 40 bytes a vertex that is written once and read in each pass; the vertex shaders compute the same for nothing but
//! arithmetic. So it is used only where several passes draw the same vertices, which is while lamps cast shadows, and only for what more than one
//! matrix or morph targets move: a rigid mesh needs one matrix, and 10,000 copies of it no memory. Models that do not fit into the budget are posed
//! in the vertex shaders of each pass, which gives the same bits. Ghosts are drawn in one pass, and so are never posed before.

use super::geometry::GpuGeometry;
use super::groups::DrawGroups;
use super::pipeline::{ModelPipelines, storage};
use crate::batch::DrawBatches;
use crate::draw_set::DrawSet;
use crate::gpu::Gpu;
use crate::shaders;
use crate::uniform::{DrawInstance, NOT_POSED, POSED_BYTES};
use bytemuck::{Pod, Zeroable};
use std::collections::HashMap;

/// Largest number of bytes of posed vertices of all models of a scene together.
pub(super) const SKIN_BUDGET: u64 = 64 << 20;

/// Invocations in a workgroup. WGSL twin: `workgroup_size` in `shaders/skin.wgsl`.
const WORKGROUP: u64 = 64;

/// Largest number of workgroups in one direction of a dispatch, on any device.
const MOST_WORKGROUPS: u64 = 65_535;

/// Revision of an item that was never posed.
const NEVER: u64 = u64::MAX;

/// Distance between uniforms that are bound by their offset, bytes: the largest that a device may ask for.
const STRIDE: u64 = 256;

/// Uniform of a dispatch. WGSL twin: `SkinPart` in `shaders/skin.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
struct SkinPart {
    first: u32,
    vertices: u32,
    /// Padding to 16 bytes.
    pad: [u32; 2],
}

/// The compute pipeline.
pub(super) struct SkinPipeline {
    pipeline: wgpu::ComputePipeline,
    job_layout: wgpu::BindGroupLayout,
    source_layout: wgpu::BindGroupLayout,
}

impl SkinPipeline {
    /// Compiles the shader for models drawn with these pipelines.
    pub(super) fn new(gpu: &Gpu, pipelines: &ModelPipelines) -> Self {
        let compute = wgpu::ShaderStages::COMPUTE;
        let part = wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: compute,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: true,
                min_binding_size: wgpu::BufferSize::new(size_of::<SkinPart>() as u64),
            },
            count: None,
        };
        let posed = wgpu::BindGroupLayoutEntry {
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: false },
                has_dynamic_offset: false,
                min_binding_size: wgpu::BufferSize::new(POSED_BYTES),
            },
            ..storage(2, compute, POSED_BYTES)
        };
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some(label), entries };
            gpu.device.create_bind_group_layout(&descriptor)
        };
        let jobs = storage(1, compute, size_of::<DrawInstance>() as u64);
        let job_layout = layout("skin", &[part, jobs, posed]);
        let source_layout = layout("skin source", &[storage(0, compute, 4)]);
        let groups = [&job_layout, pipelines.draw_layout(), &source_layout].map(Some);
        let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("skin"),
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("skin"),
            layout: Some(&pipeline_layout),
            module: &shaders::SKIN.module(&gpu.device),
            entry_point: Some("cs_skin"),
            compilation_options: Default::default(),
            cache: None,
        });
        Self { pipeline, job_layout, source_layout }
    }
}

/// The posed vertices of all copies of a model.
pub(super) struct PosedVertices {
    /// Number of vertices that there is room for.
    room: u64,
    /// Bind group 1 of draws.
    group: wgpu::BindGroup,
    jobs: wgpu::Buffer,
    parts: wgpu::Buffer,
    /// Bind group 0 of dispatches.
    job_group: wgpu::BindGroup,
    /// Bind groups 2 of dispatches, by mesh and primitive.
    sources: HashMap<(u32, u32), wgpu::BindGroup>,
    /// For each item of the set the revision in which its vertices were posed last.
    stamps: Vec<u64>,
    /// The set that the stamps are of.
    set: u64,
    /// For each item whether the frame draws it.
    wanted: Vec<bool>,
    /// The instances to pose in this frame, and their parts.
    listed: Vec<DrawInstance>,
    dispatches: Vec<Dispatch>,
}

/// Instances of a part of a mesh to be posed together.
#[derive(Clone, Copy)]
struct Dispatch {
    part: (u32, u32),
    first: u32,
    instances: u32,
    vertices: u32,
}

impl PosedVertices {
    /// Allocates memory for the vertices of `set`.
    pub(super) fn new(gpu: &Gpu, skins: &SkinPipeline, pipelines: &ModelPipelines, set: &DrawSet) -> Self {
        let room = set.posed_vertices();
        let posed = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("posed vertices"),
            size: room * POSED_BYTES,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let items = set.items().len();
        let jobs = gpu.buffer("skin jobs", items * size_of::<DrawInstance>(), wgpu::BufferUsages::STORAGE);
        let parts = gpu.buffer("skin parts", items * STRIDE as usize, wgpu::BufferUsages::UNIFORM);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("posed draw"),
            layout: pipelines.posed_layout(),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: posed.as_entire_binding() }],
        });
        let part = wgpu::BufferBinding {
            buffer: &parts,
            offset: 0,
            size: wgpu::BufferSize::new(size_of::<SkinPart>() as u64),
        };
        let job_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("skin"),
            layout: &skins.job_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(part) },
                wgpu::BindGroupEntry { binding: 1, resource: jobs.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 2, resource: posed.as_entire_binding() },
            ],
        });
        Self {
            room,
            group,
            jobs,
            parts,
            job_group,
            sources: HashMap::new(),
            stamps: vec![NEVER; items],
            set: u64::MAX,
            wanted: vec![false; items],
            listed: Vec::with_capacity(items),
            dispatches: Vec::with_capacity(items),
        }
    }

    /// Returns whether there is room for the vertices of `set`.
    pub(super) fn has_room_for(&self, set: &DrawSet) -> bool {
        self.room >= set.posed_vertices() && self.stamps.len() == set.items().len()
    }

    /// Bind group 1 of draws of these vertices.
    pub(super) fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }

    /// Number of vertices that this frame poses.
    pub(super) fn count(&self) -> u64 {
        let vertices = |of: &Dispatch| u64::from(of.instances) * u64::from(of.vertices);
        self.dispatches.iter().map(vertices).sum()
    }

    /// Forgets what was posed, because the matrices or vertices are in other buffers now.
    pub(super) fn forget(&mut self) {
        self.stamps.fill(NEVER);
    }

    /// Lists what the frame draws and what has changed since it was posed last, and writes the list to the device. Allocates nothing after the
    /// first frames.
    pub(super) fn list(
        &mut self,
        gpu: &Gpu,
        skins: &SkinPipeline,
        geometries: &HashMap<(u32, u32), GpuGeometry>,
        set: &DrawSet,
    ) {
        let (of, revision) = set.revision();
        if self.set != of {
            self.set = of;
            self.forget();
        }
        self.wanted.fill(false);
        let lists = (0..).map_while(|map| set.casters(map)).chain([set.batches()]);
        for &item in lists.flat_map(DrawBatches::drawn) {
            self.wanted[item as usize] = true;
        }
        self.listed.clear();
        self.dispatches.clear();
        for &index in set.batches().by_part() {
            let item = &set.items()[index as usize];
            let index = index as usize;
            if item.instance.posed == NOT_POSED || !self.wanted[index] || self.stamps[index] == revision {
                continue;
            }
            self.stamps[index] = revision;
            let first = self.listed.len() as u32;
            self.listed.push(item.instance);
            match self.dispatches.last_mut() {
                Some(last) if last.part == item.part() && u64::from(last.instances) < MOST_WORKGROUPS => {
                    last.instances += 1;
                }
                _ => {
                    let vertices = item.instance.vertices;
                    self.dispatches.push(Dispatch { part: item.part(), first, instances: 1, vertices });
                }
            }
        }
        if self.listed.is_empty() {
            return;
        }
        gpu.queue.write_buffer(&self.jobs, 0, bytemuck::cast_slice(&self.listed));
        for (index, Dispatch { part, first, vertices, .. }) in (0..).zip(&self.dispatches) {
            let written = SkinPart { first: *first, vertices: *vertices, pad: [0; 2] };
            gpu.queue.write_buffer(&self.parts, index * STRIDE, bytemuck::bytes_of(&written));
            if let Some(geometry) = geometries.get(part)
                && !self.sources.contains_key(part)
            {
                self.sources.insert(*part, skins.source(gpu, geometry));
            }
        }
    }

    /// Records the dispatches of what was listed.
    pub(super) fn record(&self, groups: &DrawGroups, skins: &SkinPipeline, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_pipeline(&skins.pipeline);
        for (index, dispatch) in (0..).zip(&self.dispatches) {
            let Some(source) = self.sources.get(&dispatch.part) else { continue };
            let offset = index * STRIDE as u32;
            pass.set_bind_group(0, &self.job_group, &[offset]);
            pass.set_bind_group(1, groups.get(dispatch.part), &[]);
            pass.set_bind_group(2, source, &[]);
            // The budget allows fewer vertices than one dispatch does.
            let workgroups = u64::from(dispatch.vertices).div_ceil(WORKGROUP).min(MOST_WORKGROUPS);
            pass.dispatch_workgroups(workgroups as u32, dispatch.instances, 1);
        }
    }
}

impl SkinPipeline {
    /// Creates bind group 2 of the dispatches of a part.
    fn source(&self, gpu: &Gpu, geometry: &GpuGeometry) -> wgpu::BindGroup {
        let resource = geometry.vertices.as_entire_binding();
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("skin source"),
            layout: &self.source_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource }],
        })
    }
}
