//! The maps of shadows on the device, and bind group 3 of the shaders that read them.

use super::SceneShadows;
use super::frame::{CASCADES, SPOT_SHADOWS, SPOT_SIDE, ShadowMap};
use crate::full_screen::{fragment_layout, uniform_entry};
use crate::gpu::{DEPTH_FORMAT, Gpu};
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec4};

/// Data of the shadows of a frame. WGSL twin: `Shadows` in `shaders/common/shadowed.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct ShadowUniform {
    sun: [Mat4; CASCADES],
    spots: [Mat4; SPOT_SHADOWS],
    texels: Vec4,
    counts: Vec4,
}

/// The maps of the shadows of a frame; none while there are no shadows.
#[derive(Default)]
pub(crate) struct ShadowMaps {
    /// `None` without a device.
    layout: Option<wgpu::BindGroupLayout>,
    made: Option<MadeMaps>,
}

/// The textures and the bind group.
struct MadeMaps {
    sun: MapArray,
    spots: MapArray,
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl ShadowMaps {
    /// Drops everything of a lost device.
    pub(crate) fn on_lost(&mut self) {
        (self.layout, self.made) = (None, None);
    }

    /// Creates the layout; maps are created when they are first drawn.
    pub(crate) fn on_reset(&mut self, gpu: &Gpu) {
        (self.layout, self.made) = (Some(layout(gpu)), None);
    }

    /// Layout of bind group 3.
    pub(crate) fn layout(&self) -> Option<&wgpu::BindGroupLayout> {
        self.layout.as_ref()
    }

    /// Bind group 3 with the maps of this frame; `None` without shadows.
    pub(crate) fn group(&self) -> Option<&wgpu::BindGroup> {
        self.made.as_ref().map(|made| &made.group)
    }

    /// Drops the maps.
    pub(crate) fn clear(&mut self) {
        self.made = None;
    }

    /// Makes maps for the shadows of a frame, unless those of the last one suffice, and writes the data of the shaders.
    pub(crate) fn write(&mut self, gpu: &Gpu, shadows: &SceneShadows) {
        let Some(layout) = &self.layout else { return };
        let (cascades, spots) = (shadows.cascades().len() as u32, shadows.spots().len() as u32);
        let suffices = |made: &MadeMaps| {
            made.sun.suffices(shadows.side(), cascades) && made.spots.suffices(SPOT_SIDE, spots)
        };
        if !self.made.as_ref().is_some_and(suffices) {
            // The old ones first, because both together may be too large.
            self.made = None;
            self.made = Some(MadeMaps::new(gpu, layout, shadows));
        }
        if let Some(made) = &self.made {
            gpu.queue.write_buffer(&made.uniform, 0, bytemuck::bytes_of(&uniform(shadows)));
        }
    }

    /// Returns the view into which map number `map` of these shadows is drawn.
    pub(crate) fn target(&self, shadows: &SceneShadows, map: usize) -> Option<&wgpu::TextureView> {
        let made = self.made.as_ref()?;
        let cascades = shadows.cascades().len();
        if map < cascades { made.sun.layers.get(map) } else { made.spots.layers.get(map - cascades) }
    }
}

impl MadeMaps {
    fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, shadows: &SceneShadows) -> Self {
        let sun = MapArray::new(gpu, "shadows of the sun", shadows.side(), shadows.cascades().len());
        let spots = MapArray::new(gpu, "shadows of spot lights", SPOT_SIDE, shadows.spots().len());
        let uniform = gpu.buffer("shadows", size_of::<ShadowUniform>(), wgpu::BufferUsages::UNIFORM);
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadows"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            // Reversed depth: in the light is what is at least as near to the lamp as what is drawn there.
            compare: Some(wgpu::CompareFunction::GreaterEqual),
            ..Default::default()
        });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadows"),
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&sun.whole) },
                wgpu::BindGroupEntry {
                    binding: 2,
                    resource: wgpu::BindingResource::TextureView(&spots.whole),
                },
                wgpu::BindGroupEntry { binding: 3, resource: wgpu::BindingResource::Sampler(&sampler) },
            ],
        });
        Self { sun, spots, uniform, group }
    }
}

/// Maps of one size. Without any there is one texel, because a bind group needs a texture.
struct MapArray {
    side: u32,
    whole: wgpu::TextureView,
    /// A view of each map.
    layers: Vec<wgpu::TextureView>,
}

impl MapArray {
    fn new(gpu: &Gpu, label: &str, side: u32, maps: usize) -> Self {
        let is_used = maps > 0;
        let (side, layers) = if is_used { (side, maps as u32) } else { (1, 1) };
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: layers },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: DEPTH_FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let whole = texture.create_view(&wgpu::TextureViewDescriptor {
            label: Some(label),
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let layer = |layer| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                label: Some(label),
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let layers = if is_used { (0..layers).map(layer).collect() } else { Vec::new() };
        Self { side, whole, layers }
    }

    /// Returns whether there is room for this many maps of this size.
    fn suffices(&self, side: u32, maps: u32) -> bool {
        maps == 0 || self.side == side && self.layers.len() >= maps as usize
    }
}

fn uniform(shadows: &SceneShadows) -> ShadowUniform {
    // Clip space → place in the texture, whose first row is the upper one.
    let map_from_clip = Mat4::from_cols(
        Vec4::new(0.5, 0.0, 0.0, 0.0),
        Vec4::new(0.0, -0.5, 0.0, 0.0),
        Vec4::new(0.0, 0.0, 1.0, 0.0),
        Vec4::new(0.5, 0.5, 0.0, 1.0),
    );
    let matrix = |map: &ShadowMap| map_from_clip * map.clip_from_world;
    let mut uniform = ShadowUniform::zeroed();
    for (index, map) in shadows.cascades().iter().enumerate() {
        (uniform.sun[index], uniform.texels[index]) = (matrix(map), map.texel);
    }
    for (index, map) in shadows.spots().iter().enumerate() {
        (uniform.spots[index], uniform.texels.w) = (matrix(map), map.texel);
    }
    let is_studio = f32::from(u8::from(shadows.is_studio()));
    let [sun, spot] = [shadows.side(), SPOT_SIDE].map(|side| side as f32);
    uniform.counts = Vec4::new(shadows.cascades().len() as f32, is_studio, sun, spot);
    uniform
}

fn layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let map = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
    fragment_layout(&gpu.device, "shadows", &[uniform_entry::<ShadowUniform>(), map, map, sampler])
}
