//! Influences of a skinned mesh whose joint is missing in the skin.

use crate::check::{Findings, Kind, Place};
use crate::data::ModelData;

pub(crate) fn look(model: &ModelData, findings: &mut Findings) {
    for (number, instance) in model.instances.iter().enumerate() {
        let mesh = model.meshes.get(instance.mesh as usize);
        let skin = instance.skin.and_then(|skin| model.skins.get(skin as usize));
        let (Some(mesh), Some(skin)) = (mesh, skin) else { continue };
        for (index, primitive) in mesh.primitives.iter().enumerate() {
            let vertices = &primitive.vertices;
            let each = vertices.influences_per_vertex.max(1);
            let missing = |joint: u16| usize::from(joint) >= skin.bones.len();
            for (at, influence) in vertices.influences.iter().enumerate().filter(|(_, i)| missing(i.joint)) {
                let place = || {
                    let place = Place::of(Kind::Instance, number, "");
                    let place = place.then(Kind::Mesh, instance.mesh as usize, &mesh.name);
                    place.then(Kind::Primitive, index, "").then(Kind::Vertex, at / each, "")
                };
                let text = || format!("names joint {}, the skin has {}", influence.joint, skin.bones.len());
                findings.add(|| (place(), text()));
            }
        }
    }
}
