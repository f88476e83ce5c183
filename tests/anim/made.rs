//! Random models: skeletons that bend, meshes that several bones share, and invalid weights.

use crate::doors::{TestFolder, data};
use crate::support::{animation_data, bone};
use dragonfly_anim::data::{
    Channel, Influence, Interpolation, Mesh, MeshInstance, ModelData, MorphTarget, Primitive, Skin, Take,
    Track, Vertices,
};
use dragonfly_anim::format::{ReadOptions, read};
use dragonfly_kit::random::Random;
use glam::{Mat4, Quat, Vec2, Vec3};
use std::path::Path;
use std::sync::Arc;

/// Weights of random vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Weights {
    /// Not negative, with a sum of 1.
    Healthy,
    /// Anything: negative, all zero, too many, not finite, of missing joints.
    Wild,
}

/// Returns a vector with each component in `-size..size`.
pub(crate) fn vector(random: &mut Random, size: f32) -> Vec3 {
    Vec3::from_array([(); 3].map(|()| random.between(-size, size)))
}

/// Returns a direction, every one about equally likely.
pub(crate) fn direction(random: &mut Random) -> Vec3 {
    vector(random, 1.0).normalize_or(Vec3::X)
}

/// Returns a rotation by any angle.
pub(crate) fn rotation(random: &mut Random) -> Quat {
    Quat::from_axis_angle(direction(random), random.between(-3.1, 3.1))
}

/// Returns a model of some bones, with a skinned tube, a tube that a bone carries and a tube that does not move.
pub(crate) fn model(random: &mut Random, weights: Weights) -> Arc<ModelData> {
    let bones = 1 + random.below(7);
    let list = (0..bones).map(|index| {
        let parent = (index > 0).then(|| random.below(index) as u32);
        bone("", parent, vector(random, 1.0))
    });
    let list = list.collect();
    let tracks = (0..bones).map(|_| track(random)).collect();
    let offsets = (0..bones).map(|_| {
        let scale = Vec3::new(random.between(0.5, 2.0), 1.0, random.choice(&[1.0, -1.0, 0.3]));
        Mat4::from_scale_rotation_translation(scale, rotation(random), vector(random, 1.0))
    });
    let skin = Skin { name: String::new(), bones: (0..bones as u32).collect(), offsets: offsets.collect() };
    let meshes: Vec<Mesh> = [bones, 0, 0].map(|joints| tube(random, joints, weights)).into();
    let place = Mat4::from_rotation_translation(rotation(random), vector(random, 2.0));
    let instances = (0..3).map(|mesh| MeshInstance {
        mesh,
        node: None,
        skin: (mesh == 0).then_some(0),
        bone: (mesh == 1).then_some(bones as u32 - 1),
        to_bone: place,
        morph_weights: (0..meshes[mesh as usize].morph_weights.len())
            .map(|_| random.between(-1.0, 1.0))
            .collect(),
    });
    let instances = instances.collect();
    let take: Take = crate::support::take(tracks);
    let animation = animation_data(list, vec![take]);
    Arc::new(ModelData { meshes, instances, skins: vec![skin], animation, ..ModelData::default() })
}

/// Returns a track with three keys in each channel, a second apart.
fn track(random: &mut Random) -> Track {
    let times = [0.0, 1.0, 2.0];
    let rotations = times.map(|_| rotation(random));
    let translations = times.map(|_| vector(random, 1.0));
    let scales = times.map(|_| Vec3::ONE + vector(random, 0.4));
    Track {
        bone: 0,
        translation: Channel::new(times, translations, Interpolation::Linear),
        rotation: Channel::new(times, rotations, Interpolation::Linear),
        scale: Channel::new(times, scales, Interpolation::Step),
    }
}

/// Returns a tube along y of `7 × 9` vertices, closed around, with a seam in the texture coordinates.
fn tube(random: &mut Random, joints: usize, weights: Weights) -> Mesh {
    let (around, along) = (7, 9);
    let mut vertices =
        Vertices { influences_per_vertex: if joints > 0 { 4 } else { 0 }, ..Vertices::default() };
    for row in 0..along {
        for column in 0..=around {
            let angle = (column % around) as f32 / around as f32 * std::f32::consts::TAU;
            let height = row as f32 / (along - 1) as f32;
            let out = Vec3::new(angle.cos(), 0.0, angle.sin());
            vertices.positions.push(out * 0.4 + Vec3::Y * height * 3.0);
            vertices.normals.push(out);
            vertices.texture_coordinates[0].push(Vec2::new(column as f32 / around as f32, height));
        }
    }
    let mut along_bones: Vec<Influence> = Vec::new();
    for row in 0..along {
        // One random value per row, so that both sides of the seam move in the same way.
        let height = row as f32 / (along - 1) as f32;
        let shares = influences(random, joints, height, weights);
        (0..=around).for_each(|_| along_bones.extend(shares));
    }
    if joints > 0 {
        vertices.influences = along_bones;
    }
    let mut indices = Vec::new();
    for row in 0..along as u32 - 1 {
        for column in 0..around as u32 {
            let [a, b] = [row, row + 1].map(|row| row * (around as u32 + 1) + column);
            indices.extend([a, b, a + 1, a + 1, b, b + 1]);
        }
    }
    let targets = random.below(3);
    let morph_targets = (0..targets).map(|_| {
        let push = vector(random, 0.5);
        // The same on both sides of the seam.
        let column = |index: usize| index % (around + 1) % around;
        let positions =
            (0..vertices.len()).map(|index| if column(index) % 3 == 0 { push } else { Vec3::ZERO });
        MorphTarget { positions: positions.collect(), ..MorphTarget::default() }
    });
    let morph_targets = morph_targets.collect();
    let primitive = Primitive { vertices, indices, material: None, morph_targets };
    Mesh { name: String::new(), primitives: vec![primitive], morph_weights: vec![0.0; targets] }
}

/// Returns four influences at a height of 0..1 along the chain.
fn influences(random: &mut Random, joints: usize, height: f32, weights: Weights) -> [Influence; 4] {
    let mut out = [Influence::default(); 4];
    if joints == 0 {
        return out;
    }
    if weights == Weights::Wild && random.below(4) == 0 {
        for influence in &mut out[..random.below(5)] {
            let weight = random.choice(&[0.5, -0.7, 1.5, 0.0, 3.0, f32::NAN, f32::INFINITY, -0.01]);
            *influence = Influence { joint: random.below(joints + 2) as u16, weight };
        }
        return out;
    }
    let mut shares = [(); 4].map(|()| random.unit());
    shares[random.below(4)] += 1.0;
    let sum: f32 = shares.iter().sum();
    for (index, (influence, share)) in out.iter_mut().zip(shares).enumerate() {
        let joint = (height * (joints - 1) as f32) as usize + index;
        *influence = Influence { joint: (joint % joints) as u16, weight: share / sum };
    }
    out
}

/// Returns `each` random times of every take, and the rest pose.
pub(crate) fn times(random: &mut Random, model: &ModelData, each: usize) -> Vec<(Option<usize>, f32)> {
    let mut times = vec![(None, 0.0)];
    for (index, take) in model.animation.takes.iter().enumerate() {
        times.extend((0..each).map(|_| (Some(index), take.start + take.length * random.unit())));
    }
    times
}

/// Reads a model from a file.
pub(crate) fn load(path: &Path) -> Arc<ModelData> {
    let bytes = std::fs::read(path).unwrap();
    let name = path.file_name().unwrap().to_str().unwrap();
    let door = TestFolder(path.parent().unwrap().to_owned());
    Arc::new(read(name, &bytes, &door, &ReadOptions::default()).unwrap().model)
}

/// Reads the fox: 24 bones, three takes.
pub(crate) fn fox() -> Arc<ModelData> {
    load(&data().join("gltf/Fox.glb"))
}
