//! Materials on the device: values, five textures, five samplers.

use super::image_plan::textures;
use super::images::ModelImages;
use crate::full_screen::{fragment_layout, image_entry, uniform_entry};
use crate::gpu::Gpu;
use crate::uniform::{MaterialUniform, TextureUse};
use dragonfly_anim::data::{AlphaMode, Filter, Material, TextureRef, Wrap};
use dragonfly_document::LoadedModel;
use glam::{Vec3, Vec4};
use std::collections::HashMap;
use wgpu::util::DeviceExt;

/// Device resources that the materials of all models share.
pub(super) struct GpuMaterials {
    /// Layout of the bind groups.
    pub(super) layout: wgpu::BindGroupLayout,
}

/// Bind groups 2 of the shader of models, one per material; the last is for surfaces without material.
pub(super) struct MaterialGroups(Vec<wgpu::BindGroup>);

/// Texture and sampler of a texture use.
type Bound = (wgpu::TextureView, wgpu::Sampler);

impl GpuMaterials {
    /// Creates the layout.
    pub(super) fn new(gpu: &Gpu) -> Self {
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let mut bindings = vec![uniform_entry::<MaterialUniform>()];
        bindings.extend([image_entry(true); 5]);
        bindings.extend([sampler; 5]);
        let layout = fragment_layout(&gpu.device, "material", &bindings);
        Self { layout }
    }

    /// Creates the bind groups of the materials of `loaded` with those of its `images` that are on the device; `None` only
    /// for a lost device.
    pub(super) fn bind(
        &self,
        gpu: &Gpu,
        loaded: &LoadedModel,
        images: &ModelImages,
    ) -> Option<MaterialGroups> {
        let white = images.white()?;
        let mut samplers = HashMap::new();
        let without = Material {
            metallic: dragonfly_anim::data::Metallic { metallic: 0.0, roughness: 0.8 },
            base_color: Vec4::new(0.7, 0.7, 0.7, 1.0),
            ..Material::default()
        };
        let materials = loaded.model.materials.iter().chain([&without]);
        let mut groups = Vec::with_capacity(loaded.model.materials.len() + 1);
        for material in materials {
            let bound: [(Bound, bool); 5] = textures(material).map(|(use_of, encoded)| {
                let view = use_of.and_then(|use_of| images.view(loaded, use_of.image, encoded));
                let key = use_of.map(sampler_key).unwrap_or_default();
                let sampler = samplers.entry(key).or_insert_with(|| sampler(gpu, key)).clone();
                ((view.unwrap_or(white).clone(), sampler), view.is_some())
            });
            let uniform = uniform(material, bound.each_ref().map(|(_, there)| *there));
            groups.push(self.group(gpu, &uniform, &bound.map(|(bound, _)| bound)));
        }
        Some(MaterialGroups(groups))
    }

    /// Creates the bind group of a material.
    pub(super) fn group(&self, gpu: &Gpu, uniform: &MaterialUniform, bound: &[Bound; 5]) -> wgpu::BindGroup {
        let buffer = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("material"),
            contents: bytemuck::bytes_of(uniform),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let mut entries = vec![wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }];
        for (index, (view, sampler)) in (1..).zip(bound) {
            let resource = wgpu::BindingResource::TextureView(view);
            entries.push(wgpu::BindGroupEntry { binding: index, resource });
            let resource = wgpu::BindingResource::Sampler(sampler);
            entries.push(wgpu::BindGroupEntry { binding: index + 5, resource });
        }
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("material"),
            layout: &self.layout,
            entries: &entries,
        })
    }
}

impl MaterialGroups {
    /// Returns the bind group of material number `index`; that of no material for `None` and for an index out of
    /// range.
    pub(super) fn get(&self, index: Option<u32>) -> Option<&wgpu::BindGroup> {
        let last = self.0.len().checked_sub(1)?;
        self.0.get(index.map_or(last, |index| (index as usize).min(last)))
    }
}

/// The uniform of a material; `there` is which textures could be created.
fn uniform(material: &Material, there: [bool; 5]) -> MaterialUniform {
    let mut rows = [TextureUse::default(); 5];
    for ((row, (use_of, _)), there) in rows.iter_mut().zip(textures(material)).zip(there) {
        if let Some(use_of) = use_of {
            let matrix = use_of.transform.to_matrix();
            row.u = matrix.row(0).extend(use_of.set as f32);
            row.v = matrix.row(1).extend(if there { 1.0 } else { 0.0 });
        }
    }
    let (cut, alpha_mode) = match material.alpha_mode {
        AlphaMode::Opaque => (0.0, 0),
        AlphaMode::Mask(cut) => (cut, 1),
        AlphaMode::Blend => (0.0, 2),
    };
    let phong = &material.phong;
    MaterialUniform {
        base_color: material.base_color,
        emissive: material.emissive.extend(cut),
        metallic: material.metallic.metallic,
        roughness: material.metallic.roughness,
        normal_scale: material.normal_scale,
        occlusion_strength: material.occlusion_strength,
        phong_ambient: phong.ambient.extend(0.0),
        phong_diffuse: phong.diffuse.extend(0.0),
        phong_specular: Vec3::extend(phong.specular, phong.specular_power),
        use_phong: u32::from(material.use_phong),
        unlit: u32::from(material.unlit),
        alpha_mode,
        pad: 0,
        uses: rows,
    }
}

/// Everything that distinguishes one sampler from another.
type SamplerKey = ([Wrap; 2], Filter, Filter, bool);

fn sampler_key(use_of: &TextureRef) -> SamplerKey {
    (use_of.wrap, use_of.magnify, use_of.minify, use_of.mip)
}

fn sampler(gpu: &Gpu, (wrap, magnify, minify, mip): SamplerKey) -> wgpu::Sampler {
    let address = |wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::MirroredRepeat => wgpu::AddressMode::MirrorRepeat,
        Wrap::ClampToEdge => wgpu::AddressMode::ClampToEdge,
    };
    let filter = |filter| match filter {
        Filter::Nearest => wgpu::FilterMode::Nearest,
        Filter::Linear => wgpu::FilterMode::Linear,
    };
    let all_linear = magnify == Filter::Linear && minify == Filter::Linear && mip;
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("image"),
        address_mode_u: address(wrap[0]),
        address_mode_v: address(wrap[1]),
        mag_filter: filter(magnify),
        min_filter: filter(minify),
        mipmap_filter: match minify {
            Filter::Nearest => wgpu::MipmapFilterMode::Nearest,
            Filter::Linear => wgpu::MipmapFilterMode::Linear,
        },
        lod_max_clamp: if mip { 32.0 } else { 0.0 },
        // Keeps surfaces seen at a flat angle sharp. Only allowed if all filters are linear.
        anisotropy_clamp: if all_linear { gpu.anisotropy } else { 1 },
        ..Default::default()
    })
}
