//! Scenes that would need too much memory are drawn as far as they fit.

use super::{Scene, script, view_of};
use dragonfly_anim::data::{Mesh, MeshInstance, ModelData, MorphTarget, Primitive, Vertices};
use dragonfly_document::LoadedModel;
use dragonfly_kit::document::arm;
use glam::{Mat4, Vec3};
use std::sync::Arc;
use std::time::Instant;

/// Number of morph targets of the model, and of weights of each role.
const TARGETS: usize = 50_000;
/// Number of roles: together 4 GB of weights.
const ROLES: usize = 20_000;
/// Most bytes of weights that a scene may have.
const MOST: usize = 300 << 20;

#[test]
fn the_roles_of_a_model_with_many_morph_targets_are_limited_by_their_memory() {
    let vertices = Vertices { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], ..Vertices::default() };
    let morph_targets = vec![MorphTarget::default(); TARGETS];
    let primitive = Primitive { vertices, indices: vec![0, 1, 2], morph_targets, ..Primitive::default() };
    let mesh = Mesh { primitives: vec![primitive], ..Mesh::default() };
    let instance = MeshInstance {
        mesh: 0,
        node: None,
        skin: None,
        bone: None,
        to_bone: Mat4::IDENTITY,
        morph_weights: Vec::new(),
    };
    let model = ModelData { meshes: vec![mesh], instances: vec![instance], ..ModelData::default() };
    let loaded = Arc::new(LoadedModel { model: Arc::new(model), ..LoadedModel::clone(&arm::loaded()) });
    let roles: String =
        (0..ROLES).map(|role| format!("<role id=\"r{role}\" model=\"face\" at=\"{role} 0 0\"/>")).collect();
    let view = view_of(&script(&roles, "<wait dur=\"1\"/>"), &loaded);
    let mut scene = Scene::new(Instant::now());
    scene.show_scene(&view);
    let weights: usize = scene.draw_sets().map(|set| size_of_val(set.weights())).sum();
    let copies = weights / size_of::<f32>() / TARGETS;
    assert!(weights < MOST, "{weights} bytes");
    assert!(copies > 1_000, "those that fit are drawn, {copies} of them");
}
