//! Vertex columns whose lengths differ.

use crate::check::channels::primitives;
use crate::check::{Findings, ModelPath, PathKind};
use crate::data::ModelData;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (number, primitive, path) in primitives(model) {
        let vertices = &primitive.vertices;
        let count = vertices.len();
        let [first, second] = &vertices.texture_coordinates;
        let mut columns = vec![
            ("normals", vertices.normals.len()),
            ("tangents", vertices.tangents.len()),
            ("texture coordinates", first.len()),
            ("texture coordinates", second.len()),
            ("colors", vertices.colors.len()),
        ];
        for target in &primitive.morph_targets {
            let lengths = [target.positions.len(), target.normals.len(), target.tangents.len()];
            columns.extend(lengths.map(|length| ("differences", length)));
        }
        for (what, length) in columns.into_iter().filter(|(_, length)| *length != 0 && *length != count) {
            findings.add(|| (path(), format!("{length} {what} for {count} vertices")));
        }
        let (influences, each) = (vertices.influences.len(), vertices.influences_per_vertex);
        if count.checked_mul(each) != Some(influences) {
            findings
                .add(|| (path(), format!("{influences} influences for {count} vertices with {each} each")));
        }
        if !primitive.indices.len().is_multiple_of(3) {
            findings.add(|| {
                (path(), format!("{} indices, which is not a multiple of 3", primitive.indices.len()))
            });
        }
        let (targets, weights) = (primitive.morph_targets.len(), model.meshes[number].morph_weights.len());
        if targets != weights {
            findings.add(|| (path(), format!("{weights} weights for {targets} morph targets")));
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
