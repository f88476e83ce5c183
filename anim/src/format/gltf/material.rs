//! Materials: metallic-roughness values as in the file, and Phong values derived from them.

use super::accessor::{invalid, unresolved};
use super::check as code;
use crate::data::{AlphaMode, Filter, Material, Metallic, Phong, TextureRef, TextureTransform, Wrap};
use crate::format::{IMAGE_KINDS, ImportContext, ImportError, Place};
use glam::{Vec2, Vec3, Vec4};
use gltf::json;
use gltf::json::extensions::texture::TextureTransform as JsonTransform;
use gltf::json::texture::{MagFilter, MinFilter, WrappingMode};
use gltf::json::validation::Checked;

/// Returns all materials. `images` contains the number in the model for each image of the file.
pub(super) fn materials(
    root: &json::Root,
    images: &[u32],
    context: &ImportContext<'_>,
) -> Result<Vec<Material>, ImportError> {
    let mut materials = context.vec(&Place::Pointer("/materials".to_owned()), root.materials.len())?;
    for (index, material) in root.materials.iter().enumerate() {
        context.work(1)?;
        let reader = MaterialReader { root, images, context, path: format!("/materials/{index}") };
        materials.push(reader.material(material)?);
    }
    Ok(materials)
}

/// Returns Phong values that look similar to metallic-roughness values.
///
/// * diffuse = base × (1 − metallic): metals have no diffuse color;
/// * specular = 0.04 × (1 − metallic) + base × metallic: reflectance of a dielectric or a metal, seen from the front;
/// * ambient = a fifth of diffuse and specular together;
/// * power = (2 / α² − 2) / 4 with α = roughness², 1..1000: the lobe of Blinn's exponent 2 / α² − 2 (Walter 2007) about
///   the reflected ray is as wide as that of a Phong exponent a quarter as large.
pub fn phong(base: Vec3, metallic: f32, roughness: f32) -> Phong {
    let diffuse = base * (1.0 - metallic);
    let specular = Vec3::splat(0.04 * (1.0 - metallic)) + base * metallic;
    let alpha = (roughness * roughness).max(1e-3);
    let specular_power = ((2.0 / (alpha * alpha) - 2.0) / 4.0).clamp(1.0, 1000.0);
    Phong { ambient: (diffuse + specular) * 0.2, diffuse, specular, specular_power }
}

struct MaterialReader<'a> {
    root: &'a json::Root,
    images: &'a [u32],
    context: &'a ImportContext<'a>,
    path: String,
}

impl MaterialReader<'_> {
    fn material(&self, material: &json::Material) -> Result<Material, ImportError> {
        let pbr = &material.pbr_metallic_roughness;
        self.finite(&pbr.base_color_factor.0, "pbrMetallicRoughness/baseColorFactor")?;
        self.finite(&[pbr.metallic_factor.0], "pbrMetallicRoughness/metallicFactor")?;
        self.finite(&[pbr.roughness_factor.0], "pbrMetallicRoughness/roughnessFactor")?;
        self.finite(&material.emissive_factor.0, "emissiveFactor")?;
        let base_color = Vec4::from(pbr.base_color_factor.0).clamp(Vec4::ZERO, Vec4::ONE);
        let metallic = pbr.metallic_factor.0.clamp(0.0, 1.0);
        let roughness = pbr.roughness_factor.0.clamp(0.0, 1.0);
        let normal = material.normal_texture.as_ref();
        let occlusion = material.occlusion_texture.as_ref();
        let normal_scale = normal.map_or(1.0, |texture| texture.scale);
        let occlusion_strength = occlusion.map_or(1.0, |texture| texture.strength.0);
        self.finite(&[normal_scale], "normalTexture/scale")?;
        self.finite(&[occlusion_strength], "occlusionTexture/strength")?;
        let extensions = material.extensions.as_ref();
        let strength = extensions.and_then(|extensions| extensions.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |strength| strength.emissive_strength.0);
        self.finite(&[strength], "extensions/KHR_materials_emissive_strength/emissiveStrength")?;
        Ok(Material {
            name: material.name.clone().unwrap_or_default(),
            base_color,
            base_color_texture: self
                .info(pbr.base_color_texture.as_ref(), "pbrMetallicRoughness/baseColorTexture")?,
            metallic: Metallic { metallic, roughness },
            metallic_roughness_texture: self.info(
                pbr.metallic_roughness_texture.as_ref(),
                "pbrMetallicRoughness/metallicRoughnessTexture",
            )?,
            phong: phong(base_color.truncate(), metallic, roughness),
            use_phong: false,
            normal_texture: match normal {
                Some(texture) => {
                    let others = texture.extensions.as_ref().map(|extensions| &extensions.others);
                    self.with_raw_transform(texture.index, texture.tex_coord, others, "normalTexture")?
                }
                None => None,
            },
            normal_scale,
            occlusion_texture: match occlusion {
                Some(texture) => {
                    let others = texture.extensions.as_ref().map(|extensions| &extensions.others);
                    self.with_raw_transform(texture.index, texture.tex_coord, others, "occlusionTexture")?
                }
                None => None,
            },
            occlusion_strength: occlusion_strength.clamp(0.0, 1.0),
            emissive: Vec3::from(material.emissive_factor.0).clamp(Vec3::ZERO, Vec3::ONE)
                * strength.clamp(0.0, 1e6),
            emissive_texture: self.info(material.emissive_texture.as_ref(), "emissiveTexture")?,
            alpha_mode: self.alpha_mode(material)?,
            double_sided: material.double_sided,
            unlit: extensions.is_some_and(|extensions| extensions.unlit.is_some()),
        })
    }

    fn alpha_mode(&self, material: &json::Material) -> Result<AlphaMode, ImportError> {
        let cutoff = material.alpha_cutoff.unwrap_or_default().0;
        self.finite(&[cutoff], "alphaCutoff")?;
        Ok(match material.alpha_mode {
            Checked::Valid(json::material::AlphaMode::Opaque) => AlphaMode::Opaque,
            Checked::Valid(json::material::AlphaMode::Mask) => AlphaMode::Mask(cutoff.max(0.0)),
            Checked::Valid(json::material::AlphaMode::Blend) => AlphaMode::Blend,
            Checked::Invalid => {
                self.context.warn(
                    self.at("alphaMode"),
                    code::VALUE_NOT_IN_LIST,
                    "the alpha mode is unknown; opaque is used instead",
                );
                AlphaMode::Opaque
            }
        })
    }

    fn info(
        &self,
        info: Option<&json::texture::Info>,
        member: &str,
    ) -> Result<Option<TextureRef>, ImportError> {
        let Some(info) = info else { return Ok(None) };
        let transform = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.as_ref());
        self.texture(info.index, info.tex_coord, transform, member)
    }

    /// Reads normal and occlusion textures, whose transform the document model leaves unparsed.
    fn with_raw_transform(
        &self,
        index: json::Index<json::Texture>,
        set: u32,
        others: Option<&serde_json::Map<String, serde_json::Value>>,
        member: &str,
    ) -> Result<Option<TextureRef>, ImportError> {
        let raw = others.and_then(|others| others.get("KHR_texture_transform"));
        let transform = raw.map(|raw| serde_json::from_value::<JsonTransform>(raw.clone())).transpose();
        let transform = transform.map_err(|error| {
            let at = self.at(&format!("{member}/extensions/KHR_texture_transform"));
            invalid(at, code::TYPE_MISMATCH, error.to_string())
        })?;
        self.texture(index, set, transform.as_ref(), member)
    }

    /// Returns a use of a texture; `None`, with a warning, if its image has a format that is not supported.
    fn texture(
        &self,
        index: json::Index<json::Texture>,
        set: u32,
        transform: Option<&JsonTransform>,
        member: &str,
    ) -> Result<Option<TextureRef>, ImportError> {
        let texture = self.root.textures.get(index.value());
        let texture =
            texture.ok_or_else(|| unresolved(&format!("{}/{member}/index", self.path), index.value()))?;
        let path = format!("/textures/{}", index.value());
        let sampler = match texture.sampler {
            Some(sampler) => Some(
                self.root
                    .samplers
                    .get(sampler.value())
                    .ok_or_else(|| unresolved(&format!("{path}/sampler"), sampler.value()))?,
            ),
            None => None,
        };
        let Some(source) = self.source(texture, &path) else { return Ok(None) };
        let image = *self.images.get(source).ok_or_else(|| unresolved(&format!("{path}/source"), source))?;
        let mut set = transform.and_then(|transform| transform.tex_coord).unwrap_or(set);
        if set > 1 {
            let text =
                format!("set {set} of the texture coordinates is not supported; set 0 is used instead");
            self.context.warn(self.at(member), code::TEXTURE_COORDINATES, text);
            set = 0;
        }
        let (minify, mip) = minify(sampler);
        Ok(Some(TextureRef {
            image,
            set,
            wrap: [sampler.map(|sampler| &sampler.wrap_s), sampler.map(|sampler| &sampler.wrap_t)].map(wrap),
            magnify: match sampler.and_then(|sampler| sampler.mag_filter.as_ref()) {
                Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
                _ => Filter::Linear,
            },
            minify,
            mip,
            transform: self.transform(transform, member)?,
        }))
    }

    /// Returns the number of the image of a texture: that of an extension where there is one, otherwise the plain one;
    /// `None`, with a warning, if there is neither.
    fn source(&self, texture: &json::Texture, path: &str) -> Option<usize> {
        let others = texture.extensions.as_ref().map(|extensions| &extensions.others);
        let extension = |name: &str| others?.get(name)?.get("source")?.as_u64();
        let of_extension = IMAGE_KINDS.iter().filter_map(|kind| kind.gltf_extension).find_map(extension);
        if let Some(source) = of_extension {
            return usize::try_from(source).ok();
        }
        // The document model's value for "no source".
        let source = Some(texture.source.value()).filter(|&source| source != u32::MAX as usize);
        if source.is_none() {
            let text = "the texture has no image that can be read, and is left out";
            self.context.warn(Place::Pointer(path.to_owned()), code::TEXTURE_NO_SOURCE, text);
        }
        source
    }

    fn transform(
        &self,
        transform: Option<&JsonTransform>,
        member: &str,
    ) -> Result<TextureTransform, ImportError> {
        let Some(transform) = transform else { return Ok(TextureTransform::IDENTITY) };
        let (offset, rotation, scale) = (transform.offset.0, transform.rotation.0, transform.scale.0);
        let numbers = [offset[0], offset[1], rotation, scale[0], scale[1]];
        self.finite(&numbers, &format!("{member}/extensions/KHR_texture_transform"))?;
        Ok(TextureTransform { offset: Vec2::from(offset), rotation, scale: Vec2::from(scale) })
    }

    fn finite(&self, numbers: &[f32], member: &str) -> Result<(), ImportError> {
        if numbers.iter().all(|number| number.is_finite()) {
            return Ok(());
        }
        Err(invalid(self.at(member), code::VALUE_NOT_IN_RANGE, "a number is not finite".to_owned()))
    }

    fn at(&self, member: &str) -> Place {
        Place::Pointer(format!("{}/{member}", self.path))
    }
}

fn wrap(mode: Option<&Checked<WrappingMode>>) -> Wrap {
    match mode {
        Some(Checked::Valid(WrappingMode::ClampToEdge)) => Wrap::ClampToEdge,
        Some(Checked::Valid(WrappingMode::MirroredRepeat)) => Wrap::MirroredRepeat,
        _ => Wrap::Repeat,
    }
}

/// Returns the minification filter and whether to use mip levels. The default is the best quality.
fn minify(sampler: Option<&json::texture::Sampler>) -> (Filter, bool) {
    match sampler.and_then(|sampler| sampler.min_filter.as_ref()) {
        Some(Checked::Valid(MinFilter::Nearest)) => (Filter::Nearest, false),
        Some(Checked::Valid(MinFilter::Linear)) => (Filter::Linear, false),
        Some(Checked::Valid(MinFilter::NearestMipmapNearest | MinFilter::NearestMipmapLinear)) => {
            (Filter::Nearest, true)
        }
        _ => (Filter::Linear, true),
    }
}
