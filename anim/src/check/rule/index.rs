//! Indices out of range.

use crate::check::channels::primitives;
use crate::check::{Findings, ModelPath, PathKind};
use crate::data::ModelData;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (_, primitive, path) in primitives(model) {
        let count = primitive.vertices.len();
        for (at, &index) in
            primitive.indices.iter().enumerate().filter(|(_, index)| **index as usize >= count)
        {
            let text = || format!("index {index} is out of range for {count} vertices");
            findings.add(|| (path().then(PathKind::Triangle, at / 3, ""), text()));
        }
        missing(primitive.material, model.materials.len(), "material", path, findings);
    }
    let bones = model.animation.skeleton.len();
    for (number, skin) in model.skins.iter().enumerate() {
        for (joint, &bone) in skin.bones.iter().enumerate() {
            let path = || ModelPath::of(PathKind::Skin, number, &skin.name).then(PathKind::Joint, joint, "");
            missing(Some(bone), bones, "bone", path, findings);
        }
    }
    for (number, instance) in model.instances.iter().enumerate() {
        let path = || ModelPath::of(PathKind::Instance, number, "");
        missing(Some(instance.mesh), model.meshes.len(), "mesh", path, findings);
        missing(instance.skin, model.skins.len(), "skin", path, findings);
        missing(instance.bone, bones, "bone", path, findings);
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
            let path = || ModelPath::of(PathKind::Material, number, &material.name);
            missing(Some(texture.image), model.images.len(), "image", path, findings);
        }
    }
}

fn missing(
    index: Option<u32>,
    count: usize,
    what: &str,
    path: impl Fn() -> ModelPath,
    findings: &mut Findings,
) {
    if let Some(index) = index.filter(|&index| index as usize >= count) {
        findings.add(|| (path(), format!("{what} {index} does not exist; the model has {count}")));
    }
}
