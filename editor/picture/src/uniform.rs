//! What shaders read, byte for byte: each structure names its twin in WGSL.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec4};

/// WGSL twin: `Frame` in `shaders/common/frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FrameUniform {
    /// Scene → clip space.
    pub clip_from_world: Mat4,
    /// Scene → view space.
    pub view_from_world: Mat4,
    /// The eye and 1, or the direction to the viewer and 0.
    pub eye: Vec4,
    /// Width, height, and one over each.
    pub size: Vec4,
    /// Cosine and sine of the yaw, shading mode, unused.
    pub studio: Vec4,
    /// Linear, multiplied by its alpha.
    pub background_top: Vec4,
    /// Linear, multiplied by its alpha.
    pub background_bottom: Vec4,
    /// Linear RGB; w: how far the fine lines have appeared.
    pub grid_color: Vec4,
    /// Centre x and z, radius, distance between fine lines.
    pub grid: Vec4,
    /// Linear RGB.
    pub bone_color: Vec4,
    /// Linear RGB.
    pub accent: Vec4,
}

/// An affine matrix by rows, three quarters the size of a whole one. WGSL twin: `Affine` in `shaders/common/pose.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Affine {
    /// First row.
    pub x: Vec4,
    /// Second row.
    pub y: Vec4,
    /// Third row.
    pub z: Vec4,
}

impl From<Mat4> for Affine {
    fn from(matrix: Mat4) -> Self {
        Self { x: matrix.row(0), y: matrix.row(1), z: matrix.row(2) }
    }
}

/// WGSL twin: `Draw` in `shaders/common/pose.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DrawUniform {
    /// First matrix of the instance.
    pub palette: u32,
    /// 0, 4 or 8.
    pub influences: u32,
    /// Number of morph targets.
    pub morph_targets: u32,
    /// First of their weights.
    pub morph_weights: u32,
    /// Vertices of the primitive.
    pub vertices: u32,
    /// Four bytes, linear RGB and opacity: of ghosts.
    pub tint: u32,
    /// Fills up to 16 bytes.
    pub pad: [u32; 2],
}

/// WGSL twin: `TextureUse` in `shaders/model.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TextureUse {
    /// First row of the transformation; w: coordinate set.
    pub u: Vec4,
    /// Second row; w: 1 when there is a texture.
    pub v: Vec4,
}

/// WGSL twin: `Material` in `shaders/model.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MaterialUniform {
    /// Linear RGBA.
    pub base_color: Vec4,
    /// Linear RGB; w: cut of a mask.
    pub emissive: Vec4,
    /// 0..1.
    pub metallic: f32,
    /// 0..1.
    pub roughness: f32,
    /// 1 as painted.
    pub normal_scale: f32,
    /// 0..1.
    pub occlusion_strength: f32,
    /// Linear RGB.
    pub phong_ambient: Vec4,
    /// Linear RGB.
    pub phong_diffuse: Vec4,
    /// Linear RGB; w: exponent.
    pub phong_specular: Vec4,
    /// 0 or 1.
    pub use_phong: u32,
    /// 0 or 1.
    pub unlit: u32,
    /// 0 opaque, 1 mask, 2 blend.
    pub alpha_mode: u32,
    /// Fills up to 16 bytes.
    pub pad: u32,
    /// Base colour, metallic-roughness, normal, occlusion, emissive.
    pub uses: [TextureUse; 5],
}
