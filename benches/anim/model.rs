//! What is measured on: a real rig of 67 bones where it is at hand, else a made one of the same shape; and a fox.

use dragonfly_anim::compressed::Exactness;
use dragonfly_anim::data::{
    Bone, Channel, Influence, Interpolation, Mesh, MeshInstance, ModelData, Primitive, Skeleton, Skin, Take,
    Track, Transform, Vertices,
};
use dragonfly_anim::format::{NoFiles, ReadOptions, read};
use glam::{Mat4, Quat, Vec3};
use std::path::Path;
use std::sync::Arc;

/// A model with a skin, and its name in the list of results.
pub(crate) struct Subject {
    pub(crate) name: &'static str,
    pub(crate) model: ModelData,
    /// 0.1 mm at 3 cm, in the unit of the model.
    pub(crate) exactness: Exactness,
    origin: &'static str,
}

impl Subject {
    /// A line over the results.
    pub(crate) fn about(&self) -> String {
        let takes: Vec<&str> = self.model.animation.takes.iter().map(|take| take.name.as_str()).collect();
        format!(
            "{}: {}, {} bones, {} in the skin, {} vertices, takes {}",
            self.name,
            self.origin,
            self.bones(),
            self.skin().bones.len(),
            self.primitive().vertices.len(),
            takes.join(", ")
        )
    }

    pub(crate) fn bones(&self) -> usize {
        self.model.animation.skeleton.len()
    }

    pub(crate) fn skin(&self) -> &Skin {
        &self.model.skins[0]
    }

    pub(crate) fn primitive(&self) -> &Primitive {
        &self.model.meshes[0].primitives[0]
    }

    /// The first take, and the longest if that is another one.
    pub(crate) fn short_and_long(&self) -> Vec<(usize, &Take)> {
        let takes = || self.model.animation.takes.iter().map(|take| &**take).enumerate();
        let long = takes().max_by(|a, b| a.1.length.total_cmp(&b.1.length));
        let mut both: Vec<(usize, &Take)> = takes().take(1).chain(long).collect();
        both.dedup_by_key(|(index, _)| *index);
        both
    }
}

fn load(path: &Path) -> Option<ModelData> {
    let bytes = std::fs::read(path).ok()?;
    let name = path.file_name()?.to_str()?;
    Some(read(name, &bytes, &NoFiles, &ReadOptions::default()).ok()?.model)
}

/// The real rig, if the folder of shared assets is beside the repository.
pub(crate) fn bench_rig() -> Subject {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/assets/bench/pab.glb");
    let (model, origin) = match load(&path) {
        Some(model) => (model, "the real rig"),
        None => (made(), "a made rig of the shape of the real one, which is not there"),
    };
    Subject { name: "pab", model, exactness: Exactness::FINE, origin }
}

/// A small animal with takes whose keys are far apart, in centimetres.
pub(crate) fn fox() -> Subject {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/gltf/Fox.glb");
    let model = load(&path).expect("Fox.glb travels with the repository");
    let exactness = Exactness { tolerance: 0.01, shell: 3.0 };
    Subject { name: "fox", model, exactness, origin: "Fox.glb" }
}

const BONES: usize = 67;
const JOINTS: usize = 54;
const VERTICES: usize = 3_934;

/// 67 bones in limbs of seven, 54 of them in the skin; takes of 41, 25, 21 and 451 keys at 30 a second.
fn made() -> ModelData {
    let bones = (0..BONES).map(|index| Bone {
        name: format!("bone {index}"),
        parent: index
            .checked_sub(1)
            .map(|before| if index % 7 == 1 { (index / 21) as u32 } else { before as u32 }),
        rest: Transform { translation: Vec3::new(0.01, 0.12, 0.02), ..Transform::IDENTITY },
        rest_matrix: None,
        offset: Mat4::from_translation(Vec3::new(0.0, -0.1 * index as f32, 0.0)),
        node: None,
    });
    let skeleton = Skeleton { bones: bones.collect() };
    let takes = [("walk", 41), ("jog", 25), ("run", 21), ("atlas", 451)];
    let takes = takes.map(|(name, keys)| Arc::new(made_take(name, keys))).to_vec();
    let skin = Skin {
        name: "skin".to_owned(),
        bones: (0..JOINTS as u32).collect(),
        offsets: skeleton.bones[..JOINTS].iter().map(|bone| bone.offset).collect(),
    };
    let mesh = Mesh { primitives: vec![made_primitive()], ..Mesh::default() };
    let instance = MeshInstance {
        mesh: 0,
        node: None,
        skin: Some(0),
        bone: None,
        to_bone: Mat4::IDENTITY,
        morph_weights: vec![],
    };
    ModelData {
        name: "made".to_owned(),
        meshes: vec![mesh],
        instances: vec![instance],
        skins: vec![skin],
        animation: dragonfly_anim::data::AnimationData { skeleton: Arc::new(skeleton), takes },
        ..ModelData::default()
    }
}

fn made_take(name: &str, keys: usize) -> Take {
    let times: Arc<[f32]> = (0..keys).map(|key| key as f32 / 30.0).collect();
    let turn = |bone: usize, key: usize| {
        let swing = (key as f32 * 0.15 + bone as f32).sin() * 0.4;
        Quat::from_rotation_x(swing) * Quat::from_rotation_y(0.3 * swing)
    };
    let tracks = (0..BONES).map(|bone| {
        let rotation: Vec<Quat> = (0..keys).map(|key| turn(bone, key)).collect();
        let moves = bone < 2;
        let step = |key: usize| Vec3::new(0.0, 1.0 + (key as f32 * 0.2).sin() * 0.03, 0.0);
        let translation: Vec<Vec3> = (0..keys).map(step).collect();
        Track {
            bone: bone as u32,
            translation: if moves {
                Channel::new(times.clone(), translation, Interpolation::Linear)
            } else {
                Channel::default()
            },
            rotation: Channel::new(times.clone(), rotation, Interpolation::Linear),
            scale: Channel::default(),
        }
    });
    let length = (keys - 1) as f32 / 30.0;
    Take { name: name.to_owned(), start: 0.0, length, tracks: tracks.collect(), morphs: vec![] }
}

fn made_primitive() -> Primitive {
    let place = |index: usize| Vec3::new((index % 40) as f32, (index / 40) as f32, (index % 7) as f32) * 0.01;
    let influences = |index: usize| {
        [0.5, 0.25, 0.15, 0.1]
            .into_iter()
            .enumerate()
            .map(move |(at, weight)| Influence { joint: ((index / 73 + at) % JOINTS) as u16, weight })
    };
    Primitive {
        vertices: Vertices {
            positions: (0..VERTICES).map(place).collect(),
            normals: (0..VERTICES).map(|index| (place(index) + Vec3::Y).normalize()).collect(),
            influences: (0..VERTICES).flat_map(influences).collect(),
            influences_per_vertex: 4,
            ..Vertices::default()
        },
        ..Primitive::default()
    }
}
