//! Prints everything that is wrong with a model: one from a file, or a broken one built here.

use dragonfly_anim::check::{RULES, Severity, check};
use dragonfly_anim::data::{Influence, Mesh, MeshInstance, ModelData, Primitive, Skin, Vertices};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use glam::{Mat4, Vec3};

/// A triangle whose second vertex has only the weight 0.5, and whose skin flattens everything.
fn broken() -> ModelData {
    let influence = |weight| [Influence { joint: 0, weight }; 1];
    let vertices = Vertices {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        influences: [influence(1.0), influence(0.5), influence(1.0)].concat(),
        influences_per_vertex: 1,
        ..Vertices::default()
    };
    let primitive = Primitive { vertices, indices: vec![0, 1, 2], ..Primitive::default() };
    let (mesh, skin) = (0, Some(0));
    let (to_bone, morph_weights) = (Mat4::IDENTITY, Vec::new());
    ModelData {
        meshes: vec![Mesh { primitives: vec![primitive], ..Mesh::default() }],
        instances: vec![MeshInstance { mesh, skin, node: None, bone: None, to_bone, morph_weights }],
        skins: vec![Skin { bones: vec![0], offsets: vec![Mat4::ZERO], ..Skin::default() }],
        ..ModelData::default()
    }
}

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = match std::env::args().nth(1).filter(|name| name.contains('.')) {
        Some(name) => read(&name, &std::fs::read(&name)?, &NoFiles, &ReadOptions::default())?.model,
        None => broken(),
    };
    let findings = check(&model);
    for finding in &findings {
        // The rule and its meaning.
        let meaning = RULES.iter().find(|rule| rule.id == finding.rule).map_or("", |rule| rule.meaning);
        println!("{finding}\n    {meaning}");
    }
    let errors = findings.iter().filter(|finding| finding.severity == Severity::Error).count();
    println!("{} findings, {errors} of them errors", findings.len());
    Ok(())
}
