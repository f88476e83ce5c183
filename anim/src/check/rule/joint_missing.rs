//! Influences of a skinned mesh whose joint is missing in the skin.

use crate::check::{Findings, ModelPath, PathKind};
use crate::data::ModelData;

pub(crate) fn check(model: &ModelData, findings: &mut Findings) {
    for (number, instance) in model.instances.iter().enumerate() {
        let mesh = model.meshes.get(instance.mesh as usize);
        let skin = instance.skin.and_then(|skin| model.skins.get(skin as usize));
        let (Some(mesh), Some(skin)) = (mesh, skin) else { continue };
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            let vertices = &primitive.vertices;
            let each = vertices.influences_per_vertex.max(1);
            let missing = |joint: u16| usize::from(joint) >= skin.bones.len();
            for (at, influence) in vertices.influences.iter().enumerate().filter(|(_, i)| missing(i.joint)) {
                let path = || {
                    let path = ModelPath::of(PathKind::Instance, number, "");
                    let path = path.then(PathKind::Mesh, instance.mesh as usize, &mesh.name);
                    path.then(PathKind::Primitive, index, "").then(PathKind::Vertex, at / each, "")
                };
                let text =
                    || format!("joint {} does not exist; the skin has {}", influence.joint, skin.bones.len());
                findings.add(|| (path(), text()));
            }
        }
    }
}
