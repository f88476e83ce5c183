//! Models of any size: trees of bones that move one surface, many small meshes, and many instances of one.

use dragonfly_anim::bounds::bounds_of_pose;
use dragonfly_anim::data::{
    AnimationData, Bone, Channel, Influence, Interpolation, Material, Mesh, MeshInstance, ModelData,
    Primitive, Skeleton, Skin, Take, Track, Transform, Vertices,
};
use dragonfly_document::LoadedModel;
use dragonfly_document::images::ImageSurvey;
use glam::{Mat4, Quat, Vec3, Vec4};
use std::sync::Arc;

/// Keys of each bone: two seconds at 30 frames per second.
const KEYS: usize = 61;

/// Returns a tree of bones with one skin: four vertices around each bone.
pub fn tree(count: u32) -> Arc<LoadedModel> {
    let mut model = ModelData { animation: animation(count), ..ModelData::default() };
    let places = places(&model.animation.skeleton);
    let mut primitive = Primitive { material: Some(0), ..tetrahedra(&places) };
    primitive.vertices.influences_per_vertex = 4;
    for index in 0..places.len() {
        for _ in 0..4 {
            let joint = |joint, weight| Influence { joint: joint as u16, weight };
            let before = index.saturating_sub(1) / 2;
            let of_vertex = [joint(index, 0.7), joint(before, 0.3), joint(0, 0.0), joint(0, 0.0)];
            primitive.vertices.influences.extend(of_vertex);
        }
    }
    let offsets = places.iter().map(|&place| Mat4::from_translation(-place)).collect();
    model.skins = vec![Skin { bones: (0..count).collect(), offsets, ..Skin::default() }];
    model.meshes = vec![Mesh { primitives: vec![primitive], ..Mesh::default() }];
    model.materials = vec![Material::default()];
    model.instances = vec![MeshInstance { skin: Some(0), ..instance(0) }];
    loaded(model)
}

/// Returns a tree of nodes, each with a mesh and a material of its own.
pub fn meshes(count: u32) -> Arc<LoadedModel> {
    let mut model = ModelData { animation: animation(count), ..ModelData::default() };
    for index in 0..count {
        let primitive = Primitive { material: Some(index), ..tetrahedra(&[Vec3::ZERO]) };
        model.meshes.push(Mesh { primitives: vec![primitive], ..Mesh::default() });
        let base_color = Vec4::new(index as f32 / count as f32, 0.5, 0.5, 1.0);
        model.materials.push(Material { base_color, ..Material::default() });
        model.instances.push(MeshInstance { bone: Some(index), ..instance(index) });
    }
    loaded(model)
}

/// Returns a tree of nodes that all place the same mesh.
pub fn instances(count: u32) -> Arc<LoadedModel> {
    let primitive = Primitive { material: Some(0), ..tetrahedra(&[Vec3::ZERO]) };
    loaded(ModelData {
        animation: animation(count),
        meshes: vec![Mesh { primitives: vec![primitive], ..Mesh::default() }],
        materials: vec![Material::default()],
        instances: (0..count).map(|index| MeshInstance { bone: Some(index), ..instance(0) }).collect(),
        ..ModelData::default()
    })
}

fn instance(mesh: u32) -> MeshInstance {
    let to_bone = Mat4::IDENTITY;
    MeshInstance { mesh, node: None, skin: None, bone: None, to_bone, morph_weights: Vec::new() }
}

fn loaded(model: ModelData) -> Arc<LoadedModel> {
    let model = Arc::new(model);
    Arc::new(LoadedModel {
        conversion: Default::default(),
        title: "made.glb".to_owned(),
        path: None,
        format: Some(dragonfly_anim::format::gltf::GLB),
        bounds: bounds_of_pose(&model, None, 0.0),
        model,
        images: ImageSurvey::default(),
        warnings: Vec::new(),
        notes: Vec::new(),
    })
}

/// Returns a binary tree of bones that turn slowly.
fn animation(count: u32) -> AnimationData {
    let bone = |index: u32| Bone {
        name: format!("bone {index}"),
        parent: index.checked_sub(1).map(|before| before / 2),
        rest: Transform {
            translation: Vec3::new((index % 2) as f32 - 0.5, 0.5, 0.1 * (index % 3) as f32),
            ..Transform::IDENTITY
        },
        rest_matrix: None,
        offset: Mat4::IDENTITY,
        node: None,
    };
    let times: Arc<[f32]> = (0..KEYS).map(|key| key as f32 / 30.0).collect();
    let track = |bone: u32| {
        let turn = |time: &f32| Quat::from_rotation_z((time * 3.0 + bone as f32).sin() * 0.2);
        let values = times.iter().map(turn).collect::<Vec<_>>();
        let rotation = Channel::new(Arc::clone(&times), values, Interpolation::Linear);
        Track { bone, rotation, ..Track::default() }
    };
    let take = Take {
        name: "Sway".to_owned(),
        length: 2.0,
        tracks: (0..count).map(track).collect(),
        ..Take::default()
    };
    AnimationData {
        skeleton: Arc::new(Skeleton { bones: (0..count).map(bone).collect() }),
        takes: vec![Arc::new(take)],
    }
}

/// Returns the positions of the joints at rest.
fn places(skeleton: &Skeleton) -> Vec<Vec3> {
    let mut places: Vec<Vec3> = Vec::with_capacity(skeleton.len());
    for bone in &skeleton.bones {
        let above = bone.parent.map_or(Vec3::ZERO, |parent| places[parent as usize]);
        places.push(above + bone.rest.translation);
    }
    places
}

/// Returns a small tetrahedron around each position.
fn tetrahedra(places: &[Vec3]) -> Primitive {
    let corners = [Vec3::ZERO, Vec3::X * 0.1, Vec3::Y * 0.1, Vec3::Z * 0.1];
    let faces = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];
    let mut vertices = Vertices::default();
    let mut indices = Vec::new();
    for (at, &place) in places.iter().enumerate() {
        vertices.positions.extend(corners.map(|corner| place + corner));
        vertices.normals.extend([Vec3::Y; 4]);
        indices.extend(faces.map(|corner| at as u32 * 4 + corner));
    }
    Primitive { vertices, indices, material: None, morph_targets: Vec::new() }
}
