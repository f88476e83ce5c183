//! Materials. The parser translates every shading model of FBX to physically based values.

use crate::code::FBX_NOT_SHOWN;
use crate::write::CREATOR;
use dragonfly_anim::data::{AlphaMode, Filter, Material, Metallic, TextureRef, TextureTransform, Wrap};
use dragonfly_anim::format::gltf::phong;
use dragonfly_anim::format::{ImportContext, ImportError, Place};
use glam::{Vec2, Vec3};
use ufbx::MaterialMap;

/// Roughness of a material that states none: a dull surface.
const DULL: f32 = 0.8;

/// Returns all materials; `images` has the image of each texture file.
pub(super) fn materials(
    scene: &ufbx::Scene,
    images: &[u32],
    context: &ImportContext<'_>,
) -> Result<Vec<Material>, ImportError> {
    let mut materials = context.vec(&Place::Pointer("/materials".to_owned()), scene.materials.len())?;
    // The name of the second set of texture coordinates, which textures refer to.
    let second = scene.meshes.into_iter().find_map(|mesh| mesh.uv_sets.get(1)).map_or("", |set| &*set.name);
    for material in &scene.materials {
        context.work(1)?;
        let reader = FbxMaterials {
            images,
            second,
            is_own: &*scene.metadata.creator == CREATOR,
            context,
            place: format!("/materials/{}", material.element.typed_id),
        };
        context.charge(&Place::File, material.element.name.len() as u64)?;
        materials.push(reader.material(material));
    }
    Ok(materials)
}

struct FbxMaterials<'a> {
    images: &'a [u32],
    second: &'a str,
    /// Whether the file was written by this crate, which stores the metallic value as the strength of reflections.
    is_own: bool,
    context: &'a ImportContext<'a>,
    place: String,
}

/// Returns the value if it is there and finite, within 0..1.
fn fraction(map: &MaterialMap) -> Option<f32> {
    let value = map.value_vec4.x;
    (map.has_value && value.is_finite()).then(|| value.clamp(0.0, 1.0) as f32)
}

fn color(map: &MaterialMap) -> Option<Vec3> {
    let value = map.value_vec4;
    let color = Vec3::new(value.x as f32, value.y as f32, value.z as f32);
    (map.has_value && color.is_finite()).then(|| color.clamp(Vec3::ZERO, Vec3::ONE))
}

/// Returns the opacity that materials of Phong and Lambert have in addition to their transparency; the parser does not map it.
fn plain_opacity(material: &ufbx::Material) -> Option<f32> {
    let value = material.element.props.find_prop("Opacity")?.value_vec4.x;
    value.is_finite().then(|| value.clamp(0.0, 1.0) as f32)
}

impl FbxMaterials<'_> {
    fn material(&self, material: &ufbx::Material) -> Material {
        let (pbr, fbx) = (&material.pbr, &material.fbx);
        let base_color_texture = self.texture(&pbr.base_color);
        let factor = fraction(&pbr.base_factor).unwrap_or(1.0);
        let base = match color(&pbr.base_color) {
            // Exporters leave the color of a textured material at any value.
            Some(color) if base_color_texture.is_none() => color * factor,
            Some(_) => Vec3::splat(factor.max(1e-3)),
            None => Vec3::ONE,
        };
        // A material without any opacity is a known mistake of exporters.
        let opacity = fraction(&pbr.opacity).or_else(|| plain_opacity(material));
        let opacity = opacity.filter(|&opacity| opacity > 0.0).unwrap_or(1.0);
        let own_metallic = || fraction(&fbx.reflection_factor).filter(|_| self.is_own);
        let metallic = fraction(&pbr.metalness).or_else(own_metallic).unwrap_or(0.0);
        let roughness = fraction(&pbr.roughness).unwrap_or(DULL);
        let emissive_texture = self.texture(&pbr.emission_color);
        let emission = fraction(&pbr.emission_factor).unwrap_or(1.0);
        let emissive = color(&pbr.emission_color).unwrap_or_default() * emission;
        let is_clear = opacity < 1.0 || pbr.opacity.texture.is_some();
        Material {
            name: material.element.name.to_string(),
            base_color: base.extend(opacity),
            base_color_texture,
            metallic: Metallic { metallic, roughness },
            phong: phong(base, metallic, roughness),
            normal_texture: self.texture(&pbr.normal_map).or_else(|| self.texture(&fbx.normal_map)),
            occlusion_texture: self.texture(&pbr.ambient_occlusion),
            emissive,
            emissive_texture,
            alpha_mode: if is_clear { AlphaMode::Blend } else { AlphaMode::Opaque },
            double_sided: material.features.double_sided.enabled,
            unlit: material.features.unlit.enabled,
            ..Material::default()
        }
    }

    /// Returns the use of an image; of a texture in layers, the lowest one.
    fn texture(&self, map: &MaterialMap) -> Option<TextureRef> {
        let texture = map.texture.as_deref().filter(|_| map.texture_enabled)?;
        let texture = match texture.has_file {
            true => texture,
            false => texture.file_textures.into_iter().find(|texture| texture.has_file)?,
        };
        let image = *self.images.get(texture.file_index as usize)?;
        let wrap = [texture.wrap_u, texture.wrap_v].map(|mode| match mode {
            ufbx::WrapMode::Repeat => Wrap::Repeat,
            ufbx::WrapMode::Clamp => Wrap::ClampToEdge,
        });
        let set = u32::from(!self.second.is_empty() && &*texture.uv_set == self.second);
        let transform = self.transform(texture);
        let (magnify, minify) = (Filter::Linear, Filter::Linear);
        Some(TextureRef { image, set, wrap, magnify, minify, mip: true, transform })
    }

    /// Returns the transform of texture coordinates whose v points down.
    fn transform(&self, texture: &ufbx::Texture) -> TextureTransform {
        let matrix = &texture.uv_to_texture;
        if !texture.has_uv_transform {
            return TextureTransform::IDENTITY;
        }
        let numbers = [matrix.m00, matrix.m11, matrix.m03, matrix.m13].map(|number| number as f32);
        if matrix.m01.abs() > 1e-6
            || matrix.m10.abs() > 1e-6
            || numbers.iter().any(|number| !number.is_finite())
        {
            let text = "the rotation of a texture is not shown";
            self.context.warn(Place::Pointer(self.place.clone()), FBX_NOT_SHOWN, text);
            return TextureTransform::IDENTITY;
        }
        let [u_scale, v_scale, u, v] = numbers;
        TextureTransform {
            offset: Vec2::new(u, 1.0 - v_scale - v),
            rotation: 0.0,
            scale: Vec2::new(u_scale, v_scale),
        }
    }
}
