//! Numbers of the model that are NaN or infinite.

use crate::check::channels::primitives;
use crate::check::{Findings, ModelPath, PathKind};
use crate::data::{Material, ModelData, Primitive};

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (_, primitive, path) in primitives(model) {
        for vertex in 0..primitive.vertices.len() {
            if !vertex_is_finite(primitive, vertex) {
                let text = "a number of the vertex is NaN or infinite".to_owned();
                findings.add(|| (path().then(PathKind::Vertex, vertex, ""), text));
            }
        }
        for (number, target) in primitive.morph_targets.iter().enumerate() {
            let mut channels = [&target.positions, &target.normals, &target.tangents].into_iter().flatten();
            if channels.any(|difference| !difference.is_finite()) {
                let text = "a difference is NaN or infinite".to_owned();
                findings.add(|| (path().then(PathKind::MorphTarget, number, &target.name), text));
            }
        }
    }
    let mut add = |finite: bool, kind: PathKind, number: usize, name: &str| {
        if !finite {
            findings.add(|| (ModelPath::of(kind, number, name), "a number is NaN or infinite".to_owned()));
        }
    };
    let all = |weights: &[f32]| weights.iter().all(|weight| weight.is_finite());
    for (number, mesh) in model.meshes.iter().enumerate() {
        add(all(&mesh.morph_weights), PathKind::Mesh, number, &mesh.name);
    }
    for (number, instance) in model.instances.iter().enumerate() {
        add(instance.to_bone.is_finite() && all(&instance.morph_weights), PathKind::Instance, number, "");
    }
    for (number, skin) in model.skins.iter().enumerate() {
        add(skin.offsets.iter().all(|offset| offset.is_finite()), PathKind::Skin, number, &skin.name);
    }
    for (number, material) in model.materials.iter().enumerate() {
        add(material_is_finite(material), PathKind::Material, number, &material.name);
    }
    for (number, bone) in model.animation.skeleton.bones.iter().enumerate() {
        let matrices = bone.offset.is_finite() && bone.rest_matrix.is_none_or(|matrix| matrix.is_finite());
        add(bone.rest.is_finite() && matrices, PathKind::Bone, number, &bone.name);
    }
}

fn vertex_is_finite(primitive: &Primitive, vertex: usize) -> bool {
    let vertices = &primitive.vertices;
    let [first, second] = &vertices.texture_coordinates;
    vertices.positions.get(vertex).is_none_or(|value| value.is_finite())
        && vertices.normals.get(vertex).is_none_or(|value| value.is_finite())
        && vertices.tangents.get(vertex).is_none_or(|value| value.is_finite())
        && vertices.colors.get(vertex).is_none_or(|value| value.is_finite())
        && first.get(vertex).is_none_or(|value| value.is_finite())
        && second.get(vertex).is_none_or(|value| value.is_finite())
        && vertices.influences_of(vertex).iter().all(|influence| influence.weight.is_finite())
}

fn material_is_finite(material: &Material) -> bool {
    let phong = &material.phong;
    let numbers = [
        phong.specular_power,
        material.metallic.metallic,
        material.metallic.roughness,
        material.normal_scale,
        material.occlusion_strength,
    ];
    let colors = [phong.ambient, phong.diffuse, phong.specular, material.emissive];
    numbers.iter().all(|number| number.is_finite())
        && colors.iter().all(|color| color.is_finite())
        && material.base_color.is_finite()
}
