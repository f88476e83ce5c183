//! Surface properties: the thesis's Phong values, glTF's metallic-roughness values, and images.

use glam::{Mat3, Vec2, Vec3, Vec4};
use std::sync::Arc;

/// Phong lighting (thesis §2.1.6.2): for files without physically based values, or as a replacement for them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    /// Linear RGB, reflected from light from all directions.
    pub ambient: Vec3,
    /// Linear RGB, reflected evenly in all directions.
    pub diffuse: Vec3,
    /// Linear RGB of the highlight.
    pub specular: Vec3,
    /// Exponent of the highlight, 1..1000; larger is smaller and sharper.
    pub specular_power: f32,
}

/// glTF 2.0 metallic-roughness values (§3.9.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metallic {
    /// 0 dielectric … 1 metal.
    pub metallic: f32,
    /// 0 mirror … 1 chalk.
    pub roughness: f32,
}

/// How transparent texels are treated.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Drawn where alpha is at least this.
    Mask(f32),
    /// Blended with the background.
    Blend,
}

/// Treatment of texture coordinates outside 0..1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Wrap {
    /// The image repeats.
    #[default]
    Repeat,
    /// The image repeats, mirrored every second time.
    MirroredRepeat,
    /// The edge texels are extended.
    ClampToEdge,
}

/// How texels are chosen between texel centers and mip levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Filter {
    /// The nearest texel.
    Nearest,
    /// A linear interpolation of the neighboring texels.
    #[default]
    Linear,
}

/// KHR_texture_transform: translates, rotates and scales texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureTransform {
    /// Added last.
    pub offset: Vec2,
    /// Radians, counter-clockwise about the origin.
    pub rotation: f32,
    /// Applied first.
    pub scale: Vec2,
}

impl TextureTransform {
    /// The identity.
    pub const IDENTITY: Self = Self { offset: Vec2::ZERO, rotation: 0.0, scale: Vec2::ONE };

    /// Returns the 3×3 matrix `translation · rotation · scale` as specified by the extension.
    pub fn to_matrix(self) -> Mat3 {
        let (sin, cos) = libm::sincosf(self.rotation);
        let rotation =
            Mat3::from_cols(Vec3::new(cos, -sin, 0.0), Vec3::new(sin, cos, 0.0), Vec3::new(0.0, 0.0, 1.0));
        Mat3::from_translation(self.offset) * rotation * Mat3::from_scale(self.scale)
    }
}

/// A use of an image by a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// Position in [`super::ModelData::images`].
    pub image: u32,
    /// Set of texture coordinates, 0 or 1.
    pub set: u32,
    /// Wrapping, horizontally and vertically.
    pub wrap: [Wrap; 2],
    /// Filter when magnified.
    pub magnify: Filter,
    /// Filter when minified, and between mip levels.
    pub minify: Filter,
    /// Whether mip levels are used.
    pub mip: bool,
    /// Transform that is applied to the coordinates first.
    pub transform: TextureTransform,
}

/// Values common to many vertices (thesis §2.1.6).
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// As in the file; may be empty.
    pub name: String,
    /// Linear RGBA, multiplied by the texture and by vertex colors.
    pub base_color: Vec4,
    /// sRGB image.
    pub base_color_texture: Option<TextureRef>,
    /// Physically based values; present in glTF.
    pub metallic: Metallic,
    /// G = roughness, B = metallic.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Phong values.
    pub phong: Phong,
    /// Whether to light with [`Self::phong`] rather than [`Self::metallic`].
    pub use_phong: bool,
    /// Tangent space, +Y up (OpenGL).
    pub normal_texture: Option<TextureRef>,
    /// Strength of the normal map, 1 = as stored.
    pub normal_scale: f32,
    /// R = fraction of the ambient light that arrives.
    pub occlusion_texture: Option<TextureRef>,
    /// Strength of the occlusion, 0..1.
    pub occlusion_strength: f32,
    /// Linear RGB of emitted light.
    pub emissive: Vec3,
    /// sRGB image.
    pub emissive_texture: Option<TextureRef>,
    /// How alpha is used.
    pub alpha_mode: AlphaMode,
    /// Whether back faces are drawn.
    pub double_sided: bool,
    /// KHR_materials_unlit: base color only, no lighting.
    pub unlit: bool,
}

impl Default for Material {
    /// Returns glTF's default material: white, fully metallic and rough.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::ONE,
            base_color_texture: None,
            metallic: Metallic { metallic: 1.0, roughness: 1.0 },
            metallic_roughness_texture: None,
            phong: Phong {
                ambient: Vec3::splat(0.2),
                diffuse: Vec3::splat(0.8),
                specular: Vec3::splat(0.2),
                specular_power: 16.0,
            },
            use_phong: false,
            normal_texture: None,
            normal_scale: 1.0,
            occlusion_texture: None,
            occlusion_strength: 1.0,
            emissive: Vec3::ZERO,
            emissive_texture: None,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
        }
    }
}

/// Encoded image data (thesis §2.1.6.3), to be decoded by the renderer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Image {
    /// As in the file; may be empty.
    pub name: String,
    /// The relative path when the image is a file of its own, so that it can be stored separately.
    pub file_name: Option<String>,
    /// As declared or detected from the first bytes: one of [`IMAGE_KINDS`](crate::format::IMAGE_KINDS), such as "image/png"; empty when unknown.
    pub mime: String,
    /// Encoded bytes; empty when the image could not be read (a warning gives the reason).
    pub bytes: Arc<[u8]>,
    /// Width in pixels, from the header of the encoded data; zero when unknown.
    pub width: u32,
    /// Height in pixels, from the header of the encoded data; zero when unknown.
    pub height: u32,
}
