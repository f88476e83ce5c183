//! A model made in code: a tube with three bones that bends, and a pane of glass that the last bone carries.

use dragonfly_anim::bounds::bounds_of_pose;
use dragonfly_anim::data::*;
use dragonfly_document::LoadedModel;
use dragonfly_document::images::ImageSurvey;
use glam::{Mat4, Quat, Vec3, Vec4};
use std::sync::Arc;

/// Number of bones, from root to tip.
pub const BONES: usize = 3;
/// Length of the take in seconds.
pub const LENGTH: f32 = 1.0;

/// Returns the model as loaded.
pub fn loaded() -> Arc<LoadedModel> {
    let model = Arc::new(model());
    Arc::new(LoadedModel {
        conversion: Default::default(),
        bounds: bounds_of_pose(&model, None, 0.0),
        title: "Arm".to_owned(),
        path: None,
        format: None,
        model,
        images: ImageSurvey::default(),
        warnings: Vec::new(),
        notes: Vec::new(),
    })
}

fn model() -> ModelData {
    let material = |base_color: Vec4, alpha_mode| Material {
        base_color,
        metallic: Metallic { metallic: 0.0, roughness: 0.5 },
        alpha_mode,
        double_sided: alpha_mode == AlphaMode::Blend,
        ..Material::default()
    };
    ModelData {
        name: "arm".to_owned(),
        meshes: vec![tube(), pane()],
        instances: vec![instance(0, Some(0), None), instance(1, None, Some(BONES as u32 - 1))],
        skins: vec![Skin {
            name: String::new(),
            bones: (0..BONES as u32).collect(),
            offsets: (0..BONES).map(|bone| Mat4::from_translation(-Vec3::Y * bone as f32)).collect(),
        }],
        materials: vec![
            material(Vec4::new(0.8, 0.25, 0.1, 1.0), AlphaMode::Opaque),
            material(Vec4::new(0.2, 0.5, 0.9, 0.5), AlphaMode::Blend),
        ],
        images: Vec::new(),
        animation: AnimationData { skeleton: Arc::new(skeleton()), takes: vec![Arc::new(bend())] },
        ..ModelData::default()
    }
}

fn skeleton() -> Skeleton {
    let bone = |index: usize| Bone {
        name: format!("bone {index}"),
        parent: index.checked_sub(1).map(|parent| parent as u32),
        rest: Transform { translation: if index == 0 { Vec3::ZERO } else { Vec3::Y }, ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::from_translation(-Vec3::Y * index as f32),
        node: None,
    };
    Skeleton { bones: (0..BONES).map(bone).collect() }
}

/// Returns a take in which every bone except the root rotates by 40 degrees.
fn bend() -> Take {
    let track = |bone: u32| Track {
        bone,
        rotation: if bone == 0 {
            Channel::default()
        } else {
            let keys = vec![Quat::IDENTITY, Quat::from_rotation_z(-0.7)];
            Channel::new(vec![0.0, LENGTH], keys, Interpolation::Linear)
        },
        ..Track::default()
    };
    Take {
        name: "bend".to_owned(),
        start: 0.0,
        length: LENGTH,
        tracks: (0..BONES as u32).map(track).collect(),
        ..Take::default()
    }
}

fn instance(mesh: u32, skin: Option<u32>, bone: Option<u32>) -> MeshInstance {
    MeshInstance { mesh, node: None, skin, bone, to_bone: Mat4::IDENTITY, morph_weights: Vec::new() }
}

/// Returns rings along Y from 0 to 3, with each vertex bound to the two nearest bones.
fn tube() -> Mesh {
    const SIDES: u32 = 16;
    const RINGS: u32 = 13;
    let mut vertices = Vertices { influences_per_vertex: 4, ..Vertices::default() };
    let mut indices = Vec::new();
    for ring in 0..RINGS {
        let height = ring as f32 * 0.25;
        let share = (height - 0.5).clamp(0.0, (BONES - 1) as f32);
        let lower = (share.floor() as usize).min(BONES - 2);
        let upper_weight = share - lower as f32;
        for side in 0..SIDES {
            let (sin, cos) = (side as f32 / SIDES as f32 * std::f32::consts::TAU).sin_cos();
            vertices.positions.push(Vec3::new(cos * 0.25, height, sin * 0.25));
            vertices.normals.push(Vec3::new(cos, 0.0, sin));
            vertices.influences.extend([
                Influence { joint: lower as u16, weight: 1.0 - upper_weight },
                Influence { joint: lower as u16 + 1, weight: upper_weight },
                Influence::default(),
                Influence::default(),
            ]);
            if ring + 1 < RINGS {
                let next = (side + 1) % SIDES;
                let (a, b) = (ring * SIDES + side, ring * SIDES + next);
                indices.extend([a, a + SIDES, b, b, a + SIDES, b + SIDES]);
            }
        }
    }
    mesh(Primitive { vertices, indices, material: Some(0), morph_targets: Vec::new() })
}

fn pane() -> Mesh {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 0.0);
    let positions = vec![corner(-0.6, 0.6), corner(0.6, 0.6), corner(0.6, 1.4), corner(-0.6, 1.4)];
    let vertices = Vertices { normals: vec![Vec3::Z; 4], positions, ..Vertices::default() };
    mesh(Primitive {
        vertices,
        indices: vec![0, 1, 2, 0, 2, 3],
        material: Some(1),
        morph_targets: Vec::new(),
    })
}

fn mesh(primitive: Primitive) -> Mesh {
    Mesh { name: String::new(), primitives: vec![primitive], morph_weights: Vec::new() }
}
