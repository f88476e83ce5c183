//! Indices out of range.

use crate::check::column::primitives;
use crate::check::{Findings, Kind, Place};
use crate::data::ModelData;

pub(crate) fn look(model: &ModelData, findings: &mut Findings) {
    for (_, primitive, place) in primitives(model) {
        let count = primitive.vertices.len();
        for (at, &index) in
            primitive.indices.iter().enumerate().filter(|(_, index)| **index as usize >= count)
        {
            let text = || format!("index {index} names none of {count} vertices");
            findings.add(|| (place().then(Kind::Triangle, at / 3, ""), text()));
        }
        missing(primitive.material, model.materials.len(), "material", place, findings);
    }
    let bones = model.animation.skeleton.len();
    for (number, skin) in model.skins.iter().enumerate() {
        for (joint, &bone) in skin.bones.iter().enumerate() {
            let place = || Place::of(Kind::Skin, number, &skin.name).then(Kind::Joint, joint, "");
            missing(Some(bone), bones, "bone", place, findings);
        }
    }
    for (number, instance) in model.instances.iter().enumerate() {
        let place = || Place::of(Kind::Instance, number, "");
        missing(Some(instance.mesh), model.meshes.len(), "mesh", place, findings);
        missing(instance.skin, model.skins.len(), "skin", place, findings);
        missing(instance.bone, bones, "bone", place, findings);
    }
    for (number, material) in model.materials.iter().enumerate() {
        let textures = [
            material.base_color_texture,
            material.metallic_roughness_texture,
            material.normal_texture,
            material.occlusion_texture,
            material.emissive_texture,
        ];
        for texture in textures.into_iter().flatten() {
            let place = || Place::of(Kind::Material, number, &material.name);
            missing(Some(texture.image), model.images.len(), "image", place, findings);
        }
    }
}

fn missing(index: Option<u32>, count: usize, what: &str, place: impl Fn() -> Place, findings: &mut Findings) {
    if let Some(index) = index.filter(|&index| index as usize >= count) {
        findings.add(|| (place(), format!("there is no {what} {index}, only {count}")));
    }
}
