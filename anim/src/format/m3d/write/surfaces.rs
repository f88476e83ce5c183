//! The materials of a file.

use super::super::check as code;
use super::super::dialect::M3dDialect;
use super::super::save::possible_name;
use super::numbers::row;
use crate::data::{AlphaMode, Material, ModelData, TextureRef};
use crate::format::losses::Losses;
use glam::Vec3;
use std::fmt::Write;

/// Name where a material has no texture.
const NONE: &str = "none";

/// Writes the block of a material; `None` is the default material.
pub(super) fn write(
    model: &ModelData,
    material: Option<u32>,
    dialect: M3dDialect,
    losses: &mut Losses,
    text: &mut String,
) {
    let plain = Material::default();
    let number = material.unwrap_or(0);
    let path = format!("/materials/{number}");
    let own = material.and_then(|material| model.materials.get(material as usize));
    if let Some(material) = own {
        list_losses(material, &path, losses);
    }
    let material = own.unwrap_or(&plain);
    let color = |color: Vec3| row(&color.to_array());
    let clips = u8::from(matches!(material.alpha_mode, AlphaMode::Mask(_)));
    let diffuse = color(material.base_color.truncate());
    match dialect {
        M3dDialect::Dx10 | M3dDialect::Dx11 => {
            let phong = &material.phong;
            let (ambient, specular) = (color(phong.ambient), color(phong.specular));
            let _ = write!(
                text,
                "Ambient: {ambient}\nDiffuse: {diffuse}\nSpecular: {specular}\nSpecPower: {}\nReflectivity: 0 0 0\nAlphaClip: {clips}\nEffect: Normal\n",
                row(&[phong.specular_power])
            );
        }
        M3dDialect::Dx12 => {
            let name = if material.name.is_empty() {
                format!("material{number}")
            } else {
                possible_name(&material.name)
            };
            if own.is_some() && name != material.name {
                let reason = format!("the material \"{}\" is called \"{name}\"", material.name);
                losses.add(format!("{path}/name"), code::NAME_NOT_STORED, reason);
            }
            let kind = if model.animation.skeleton.is_empty() { "Opaque" } else { "Skinned" };
            let reflectance = if material.use_phong { material.phong.specular } else { Vec3::splat(0.04) };
            let _ = write!(
                text,
                "Name: {name}\nDiffuse: {diffuse}\nFresnel0: {}\nRoughness: {}\nAlphaClip: {clips}\nMaterialTypeName: {kind}\n",
                color(reflectance),
                row(&[material.metallic.roughness])
            );
        }
    }
    let diffuse_map = texture(model, material.base_color_texture, &path, losses);
    let normal_map = texture(model, material.normal_texture, &path, losses);
    let _ = write!(text, "DiffuseMap: {diffuse_map}\nNormalMap: {normal_map}\n\n");
}

/// Returns the name of the file of a texture.
fn texture(model: &ModelData, texture: Option<TextureRef>, path: &str, losses: &mut Losses) -> String {
    let Some(texture) = texture else { return NONE.to_owned() };
    let file = model.images.get(texture.image as usize).and_then(|image| image.file_name.as_deref());
    match file {
        Some(file) if !file.contains(char::is_whitespace) => file.to_owned(),
        _ => {
            let text = "an image that is no file of its own, or whose name has blanks, is not stored";
            losses.add(format!("{path}/texture"), code::MATERIAL_NOT_STORED, text);
            NONE.to_owned()
        }
    }
}

fn list_losses(material: &Material, path: &str, losses: &mut Losses) {
    let is_lost = material.emissive != Vec3::ZERO
        || material.emissive_texture.is_some()
        || material.occlusion_texture.is_some()
        || material.metallic_roughness_texture.is_some()
        || material.alpha_mode == AlphaMode::Blend
        || material.metallic.metallic > 0.0 && !material.use_phong
        || material.double_sided
        || material.unlit;
    if is_lost {
        let text = "only colors, the highlight, the alpha test, a base color map and a normal map are stored";
        losses.add(path.to_owned(), code::MATERIAL_NOT_STORED, text);
    }
}
