//! Materials, as the Phong values that all programs read.

use super::images::WrittenImages;
use super::losses::FbxLosses;
use super::node::{FbxNode, setting};
use super::scene::{ObjectId, SceneWriter};
use dragonfly_anim::data::{AlphaMode, Material};
use glam::Vec3;

/// Specular color of a material that has none, as most surfaces that are no metal.
const DIELECTRIC: f32 = 0.25;

/// Adds all materials. Returns their objects.
pub(super) fn add_materials(
    scene: &mut SceneWriter,
    materials: &[Material],
    images: &WrittenImages,
    losses: &mut FbxLosses,
) -> Vec<ObjectId> {
    let mut objects = Vec::with_capacity(materials.len());
    for (number, material) in materials.iter().enumerate() {
        let place = format!("/materials/{number}");
        list_losses(material, &place, losses);
        let object = add_material(scene, material);
        let textures = [
            ("DiffuseColor", &material.base_color_texture),
            ("EmissiveColor", &material.emissive_texture),
            ("NormalMap", &material.normal_texture),
        ];
        for (property, texture) in textures {
            let Some(texture) = texture else { continue };
            if let Some(texture) = images.add_texture(scene, texture, &place, losses) {
                scene.connect_property(texture, object, property);
            }
        }
        objects.push(object);
    }
    objects
}

/// Adds the material of triangles that have none.
pub(super) fn add_default_material(scene: &mut SceneWriter) -> ObjectId {
    add_material(scene, &Material { name: "Default".to_owned(), ..Material::default() })
}

fn list_losses(material: &Material, place: &str, losses: &mut FbxLosses) {
    let mut lose = |is_lost: bool, text: &str| {
        if is_lost {
            losses.add(place, format!("material \"{}\": {text}", material.name));
        }
    };
    lose(
        !material.use_phong && material.metallic.metallic > 0.0,
        "the metallic value is stored as the strength of reflections, which few programs read as metal",
    );
    lose(material.metallic_roughness_texture.is_some(), "the texture of metal and roughness is not stored");
    lose(material.occlusion_texture.is_some(), "the texture of occlusion is not stored");
    lose(material.normal_texture.is_some() && material.normal_scale != 1.0, "the normal scale is not stored");
    let color = material.base_color.truncate();
    let is_tinted = material.base_color_texture.is_some() && color != Vec3::splat(color.x);
    lose(is_tinted, "most programs ignore the color of a material that has a texture");
    lose(matches!(material.alpha_mode, AlphaMode::Mask(_)), "the alpha threshold is not stored");
    let is_clear = material.alpha_mode == AlphaMode::Blend && material.base_color.w >= 1.0;
    lose(is_clear, "that the alpha of its texture is blended is not stored");
    let hidden = material.alpha_mode != AlphaMode::Blend && material.base_color.w < 1.0;
    lose(hidden, "an alpha that is ignored is not stored");
    lose(material.double_sided, "that both sides are drawn is not stored");
    lose(material.unlit, "that it is not lit is not stored");
}

fn add_material(scene: &mut SceneWriter, material: &Material) -> ObjectId {
    let color = |name: &str, color: Vec3| {
        let color = color.as_dvec3();
        setting(name, "Color", "", "A").with(color.x).with(color.y).with(color.z)
    };
    let number = |name: &str, number: f64| setting(name, "Number", "", "A").with(number);
    let base = material.base_color.truncate();
    let is_gray = base == Vec3::splat(base.x);
    // Of a texture, most programs take the product with the factor, but not with the color.
    let (base, factor) = match material.base_color_texture {
        Some(_) if is_gray => (Vec3::ONE, f64::from(base.x)),
        _ => (base, 1.0),
    };
    let dull = 10.0 * (1.0 - f64::from(material.metallic.roughness).clamp(0.0, 1.0));
    let (specular, shininess, reflection) = match material.use_phong {
        true => (material.phong.specular, f64::from(material.phong.specular_power), 0.0),
        false => (Vec3::splat(DIELECTRIC), dull * dull, f64::from(material.metallic.metallic)),
    };
    // The color is the product. Of programs with physical materials, Blender reads twice the factor, and no color.
    let strength = specular.max_element();
    let tint = if strength > 0.0 { specular / strength } else { Vec3::ONE };
    let ambient = if material.use_phong { material.phong.ambient } else { Vec3::ZERO };
    let alpha = match material.alpha_mode {
        AlphaMode::Blend => f64::from(material.base_color.w).clamp(0.0, 1.0),
        AlphaMode::Opaque | AlphaMode::Mask(_) => 1.0,
    };
    let properties = FbxNode::new("Properties70").containing([
        setting("ShadingModel", "KString", "", "").with("Phong"),
        setting("MultiLayer", "bool", "", "").with(0),
        color("EmissiveColor", material.emissive),
        number("EmissiveFactor", 1.0),
        color("AmbientColor", ambient),
        number("AmbientFactor", 1.0),
        color("DiffuseColor", base),
        number("DiffuseFactor", factor),
        color("TransparentColor", Vec3::ONE),
        number("TransparencyFactor", 1.0 - alpha),
        number("Opacity", alpha),
        color("SpecularColor", tint),
        number("SpecularFactor", f64::from(strength)),
        number("Shininess", shininess),
        number("ShininessExponent", shininess),
        color("ReflectionColor", Vec3::ONE),
        number("ReflectionFactor", reflection),
    ]);
    let children = [
        FbxNode::new("Version").with(102),
        FbxNode::new("ShadingModel").with("Phong"),
        FbxNode::new("MultiLayer").with(0),
        properties,
    ];
    scene.object("Material", &material.name, ("Material", ""), children)
}
