//! Data that shaders read, byte for byte; each structure names its twin in WGSL.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec4};

/// Number of spots of the contact shadow. WGSL twin: `SPOTS` in `shaders/common/frame.wgsl`.
pub const SPOTS: usize = 64;

/// Number of lights of a scene. WGSL twin: `LIGHTS` in `shaders/common/frame.wgsl`.
pub const LIGHTS: usize = 8;

/// Uniform of a frame. WGSL twin: `Frame` in `shaders/common/frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FrameUniform {
    /// Matrix scene space → clip space.
    pub clip_from_world: Mat4,
    /// Matrix scene space → view space.
    pub view_from_world: Mat4,
    /// Position of the camera and 1, or for orthographic views the direction to the viewer and 0.
    pub eye: Vec4,
    /// Width and height of the viewport in pixels, and their reciprocals.
    pub size: Vec4,
    /// Cosine and sine of the camera's yaw, shading mode, 1 where the lines of the grid are drawn.
    pub studio: Vec4,
    /// Top of the background, linear, multiplied by its alpha.
    pub background_top: Vec4,
    /// Bottom of the background, linear, multiplied by its alpha.
    pub background_bottom: Vec4,
    /// Linear RGB of the grid; w: fade-in of the fine lines.
    pub grid_color: Vec4,
    /// Center x and z of the grid, radius, distance between fine lines.
    pub grid: Vec4,
    /// Color of bones, linear RGB.
    pub bone_color: Vec4,
    /// Color of selected bones, linear RGB.
    pub accent: Vec4,
    /// Of a sub-frame: 1 where the target takes light before the tone map, and the threshold of masks.
    pub sampling: Vec4,
    /// Spots of the contact shadow: center x and z, radius, strength.
    pub contact: [Vec4; SPOTS],
    /// Number of lights of the scene, which replace those of the studio if there are any; share of the studio's ambient light; number of
    /// spots; height of the ground.
    pub counts: Vec4,
    /// Lights of the scene.
    pub lights: [LightUniform; LIGHTS],
}

/// A light of a scene. WGSL twin: `SceneLight` in `shaders/common/frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct LightUniform {
    /// Meters; w: 0 for a sun, 1 for a point light, 2 for a spot light.
    pub position: Vec4,
    /// Direction in which it shines, unit length; w: 0 without a shadow, 1 for the sun that casts one, 2 and more for the spot lights that do.
    pub direction: Vec4,
    /// Linear RGB that a white matte surface reflects where it faces the light, for a point or spot light at a distance of 1.
    pub color: Vec4,
}

/// An affine matrix by rows, three quarters the size of a full matrix. WGSL twin: `Affine` in
/// `shaders/common/pose.wgsl`.
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

impl Affine {
    /// Returns `self * inner`: `inner` first.
    pub fn after(&self, inner: &Self) -> Self {
        let row = |row: Vec4| row.x * inner.x + row.y * inner.y + row.z * inner.z + row * Vec4::W;
        Self { x: row(self.x), y: row(self.y), z: row(self.z) }
    }
}

impl From<Mat4> for Affine {
    fn from(matrix: Mat4) -> Self {
        Self { x: matrix.row(0), y: matrix.row(1), z: matrix.row(2) }
    }
}

impl From<Affine> for Mat4 {
    fn from(matrix: Affine) -> Self {
        Self::from_cols(matrix.x, matrix.y, matrix.z, Vec4::W).transpose()
    }
}

/// An instance of a draw, in a vertex buffer. WGSL twin: `Draw` in `shaders/common/draw.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DrawInstance {
    /// Index of the first matrix of the instance.
    pub palette: u32,
    /// Number of influences per vertex: 0, 4 or 8.
    pub influences: u32,
    /// Number of morph targets.
    pub morph_targets: u32,
    /// Index of the first morph weight.
    pub morph_weights: u32,
    /// Number of vertices of the primitive.
    pub vertices: u32,
    /// Tint of a ghost: four bytes, linear RGB and opacity.
    pub tint: u32,
    /// Index of its first vertex among the posed ones of all instances; [`NOT_POSED`] where its vertices are never posed before they are drawn.
    pub posed: u32,
}

/// Value of [`DrawInstance::posed`] of an instance that one matrix moves: posing its vertices before drawing would gain nothing.
pub const NOT_POSED: u32 = u32::MAX;

/// Bytes of a posed vertex: position, normal and tangent. WGSL twin: `PosedVertex` in `shaders/common/draw.wgsl`.
pub const POSED_BYTES: u64 = 40;

/// Use of a texture by a material. WGSL twin: `TextureUse` in `shaders/model.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TextureUse {
    /// First row of the transformation; w: coordinate set.
    pub u: Vec4,
    /// Second row; w: 1 when there is a texture.
    pub v: Vec4,
}

/// Uniform of a material. WGSL twin: `Material` in `shaders/model.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MaterialUniform {
    /// Linear RGBA.
    pub base_color: Vec4,
    /// Linear RGB; w: alpha cutoff of a mask.
    pub emissive: Vec4,
    /// Metallic factor, 0..1.
    pub metallic: f32,
    /// Roughness factor, 0..1.
    pub roughness: f32,
    /// Scale of the normal map; 1 leaves it unchanged.
    pub normal_scale: f32,
    /// Strength of the occlusion map, 0..1.
    pub occlusion_strength: f32,
    /// Ambient color, linear RGB.
    pub phong_ambient: Vec4,
    /// Diffuse color, linear RGB.
    pub phong_diffuse: Vec4,
    /// Specular color, linear RGB; w: exponent.
    pub phong_specular: Vec4,
    /// Whether Phong shading is used: 0 or 1.
    pub use_phong: u32,
    /// Whether the material is unlit: 0 or 1.
    pub unlit: u32,
    /// 0 opaque, 1 mask, 2 blend.
    pub alpha_mode: u32,
    /// Padding to a multiple of 16 bytes.
    pub pad: u32,
    /// Uses of base color, metallic-roughness, normal, occlusion and emissive textures.
    pub uses: [TextureUse; 5],
}
