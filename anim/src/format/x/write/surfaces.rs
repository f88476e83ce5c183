//! The materials of a file.

use super::super::check as code;
use super::{decimal, possible};
use crate::data::{AlphaMode, Material, ModelData};
use crate::format::losses::Losses;
use crate::format::names::UniqueNames;
use glam::Vec3;
use std::fmt::Write;

/// Writes all materials, and the default one. Returns their names.
pub(super) fn write(model: &ModelData, losses: &mut Losses, text: &mut String) -> Vec<String> {
    let mut names = UniqueNames::default();
    let mut written = Vec::with_capacity(model.materials.len() + 1);
    for (index, material) in model.materials.iter().enumerate() {
        let wanted =
            if material.name.is_empty() { format!("material{index}") } else { possible(&material.name) };
        let (name, _) = names.make(wanted);
        write_material(model, material, &name, &format!("/materials/{index}"), losses, text);
        written.push(name);
    }
    let needs_default =
        model.meshes.iter().flat_map(|mesh| &mesh.primitives).any(|primitive| primitive.material.is_none());
    let (name, _) = names.make("material".to_owned());
    if needs_default {
        let plain = Material { use_phong: true, ..Material::default() };
        write_material(model, &plain, &name, "/materials", &mut Losses::default(), text);
    }
    written.push(name);
    written
}

fn write_material(
    model: &ModelData,
    material: &Material,
    name: &str,
    path: &str,
    losses: &mut Losses,
    text: &mut String,
) {
    let color = |color: Vec3| color.to_array().map(decimal).join(";");
    let (base, alpha) = (material.base_color.truncate(), decimal(material.base_color.w));
    let phong = &material.phong;
    let _ = writeln!(
        text,
        "Material {name} {{\n {};{alpha};;\n {};\n {};;\n {};;",
        color(base),
        decimal(phong.specular_power),
        color(phong.specular),
        color(material.emissive)
    );
    if let Some(texture) = material.base_color_texture {
        let file = model.images.get(texture.image as usize).and_then(|image| image.file_name.as_deref());
        match file {
            Some(file) if !file.contains('"') => {
                let _ = writeln!(text, " TextureFilename {{\n  \"{file}\";\n }}");
            }
            _ => {
                let text = "an image that is no file of its own is not stored";
                losses.add(format!("{path}/texture"), code::MATERIAL_NOT_STORED, text);
            }
        }
    }
    *text += "}\n\n";
    let is_lost = material.normal_texture.is_some()
        || material.emissive_texture.is_some()
        || material.occlusion_texture.is_some()
        || material.metallic_roughness_texture.is_some()
        || matches!(material.alpha_mode, AlphaMode::Mask(_))
        || material.metallic.metallic > 0.0 && !material.use_phong
        || material.double_sided
        || material.unlit;
    if is_lost {
        let text = "only colors, the highlight and a base color map are stored";
        losses.add(path.to_owned(), code::MATERIAL_NOT_STORED, text);
    }
}
