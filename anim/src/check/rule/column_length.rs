//! Vertex columns whose lengths differ.

use crate::check::channels::primitives;
use crate::check::{Findings, ModelPath, PathKind};
use crate::data::ModelData;

pub(crate) fn check_rule(model: &ModelData, findings: &mut Findings) {
    for (number, primitive, path) in primitives(model) {
        let vertices = &primitive.vertices;
        let count = vertices.len();
        let [first, second] = &vertices.texture_coordinates;
        let mut channels = vec![
            ("normals", vertices.normals.len()),
            ("tangents", vertices.tangents.len()),
            ("texture coordinates", first.len()),
            ("texture coordinates", second.len()),
            ("colors", vertices.colors.len()),
        ];
        for target in &primitive.morph_targets {
            let lengths = [target.positions.len(), target.normals.len(), target.tangents.len()];
            channels.extend(lengths.map(|length| ("differences", length)));
        }
        for (what, length) in channels.into_iter().filter(|(_, length)| *length != 0 && *length != count) {
            findings.add(|| (path(), format!("{length} {what} for {count} vertices")));
        }
        let (influences, each) = (vertices.influences.len(), vertices.influences_per_vertex);
        if count.checked_mul(each) != Some(influences) {
            findings
                .add(|| (path(), format!("{influences} influences for {count} vertices with {each} each")));
        }
        if !primitive.indices.len().is_multiple_of(3) {
            findings.add(|| (path(), format!("{} indices are no whole triangles", primitive.indices.len())));
        }
        let (targets, weights) = (primitive.morph_targets.len(), model.meshes[number].morph_weights.len());
        if targets != weights {
            findings.add(|| (path(), format!("{targets} morph targets, {weights} weights")));
        }
    }
    for (number, skin) in model.skins.iter().enumerate() {
        let (joints, offsets) = (skin.bones.len(), skin.offsets.len());
        if joints != offsets {
            let path = || ModelPath::of(PathKind::Skin, number, &skin.name);
            findings.add(|| (path(), format!("{offsets} offsets for {joints} joints")));
        }
    }
    for (number, instance) in model.instances.iter().enumerate() {
        let Some(mesh) = model.meshes.get(instance.mesh as usize) else { continue };
        let (weights, targets) = (instance.morph_weights.len(), mesh.morph_weights.len());
        if weights != targets {
            let path = || ModelPath::of(PathKind::Instance, number, "");
            findings.add(|| (path(), format!("{weights} morph weights for {targets} targets")));
        }
    }
}
