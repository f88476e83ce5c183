//! Matrices and vertices agree with those of an independent evaluator, and with the same model in another format.

use super::made::import;
use crate::m3d::agreement::{matrices, numbers, pairs};
use crate::takes::difference;
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{ModelData, Transform};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{AxisMap, m3d, x};
use dragonfly_anim::sample::sample_take;
use glam::{Mat4, Vec3};
use serde_json::Value;
use std::collections::HashMap;
use std::sync::Arc;

/// Largest difference, relative to the largest number of the pose or 1.
const TOLERANCE: f32 = 1e-4;

/// Returns the matrices of all bones at a time in ticks. The evaluator interpolates matrices number by number, which is done here
/// between the poses at the two keys around the time; `step` is the number of ticks between keys.
fn by_numbers(model: &ModelData, take: usize, tick: f64, step: f64, rate: f64) -> Vec<Mat4> {
    let skeleton = &model.animation.skeleton;
    let locals = |tick: f64| -> Vec<Mat4> {
        let mut poses = vec![Transform::IDENTITY; skeleton.len()];
        sample_take(Some(&model.animation.takes[take]), skeleton, (tick / rate) as f32, &mut poses);
        poses.into_iter().map(Transform::to_matrix).collect()
    };
    let before = (tick / step).floor() * step;
    let (from, to, part) = (locals(before), locals(before + step), ((tick - before) / step) as f32);
    let mut matrices: Vec<Mat4> = Vec::new();
    for ((bone, from), to) in skeleton.bones.iter().zip(from).zip(to) {
        let local = from * (1.0 - part) + to * part;
        matrices.push(bone.parent.map_or(local, |parent| matrices[parent as usize] * local));
    }
    matrices
}

/// Returns the matrix that moves each vertex of a mesh, from those of the bones.
fn position(model: &ModelData, instance: usize, vertex: Vec3, at: (usize, usize), bones: &[Mat4]) -> Vec3 {
    let placed = &model.instances[instance];
    let vertices = &model.meshes[placed.mesh as usize].primitives[at.0].vertices;
    match placed.skin {
        None => placed.bone.map_or(vertex, |bone| bones[bone as usize].transform_point3(vertex)),
        Some(skin) => {
            let skin = &model.skins[skin as usize];
            let moved = vertices.influences_of(at.1).iter().map(|influence| {
                let joint = usize::from(influence.joint);
                let matrix = bones[skin.bones[joint] as usize] * skin.offsets[joint];
                matrix.transform_point3(vertex) * influence.weight
            });
            moved.sum()
        }
    }
}

fn compare(model: &ModelData, axes: &AxisMap, sample: &Value, bones: &[Mat4], frames: usize) -> f32 {
    let world = matrices(&sample["world"]);
    assert_eq!(world.len(), frames);
    let mut worst = 0.0_f32;
    let flat = |list: &mut dyn Iterator<Item = Mat4>| -> Vec<f32> {
        list.flat_map(|matrix| matrix.to_cols_array()).collect()
    };
    let theirs = flat(&mut world.iter().map(|&matrix| axes.matrix(matrix)));
    worst = worst.max(difference(&flat(&mut bones[..frames].iter().copied()), &theirs));
    for (mesh, list) in sample["verts"].as_array().unwrap().iter().enumerate() {
        // Vertices are split where they have several normals: each position is found among them.
        let mut known: HashMap<[u32; 3], (usize, usize)> = HashMap::new();
        let parts = &model.meshes[mesh].primitives;
        for (part, primitive) in parts.iter().enumerate() {
            for (vertex, position) in primitive.vertices.positions.iter().enumerate() {
                known.entry(position.to_array().map(f32::to_bits)).or_insert((part, vertex));
            }
        }
        let instance = model.instances.iter().position(|instance| instance.mesh as usize == mesh).unwrap();
        let positions: Vec<(Vec3, (usize, usize))> = {
            let mut all: Vec<_> = known.into_values().collect();
            all.sort_unstable();
            all.into_iter().map(|at| (parts[at.0].vertices.positions[at.1], at)).collect()
        };
        let ours: Vec<Vec3> =
            positions.iter().map(|&(vertex, at)| position(model, instance, vertex, at, bones)).collect();
        for vertex in list.as_array().unwrap() {
            let theirs = axes.position(Vec3::from_slice(&numbers(vertex)));
            let nearest = ours.iter().map(|ours| ours.distance(theirs)).fold(f32::INFINITY, f32::min);
            worst = worst.max(nearest / theirs.abs().max_element().max(1.0));
        }
    }
    worst
}

#[test]
fn frames_and_vertices_are_where_an_independent_evaluator_finds_them() {
    let mut compared = 0;
    for (file, expected) in pairs("x") {
        let name = file.file_name().unwrap().to_str().unwrap().to_owned();
        let imported = import(&std::fs::read(&file).unwrap()).unwrap();
        let axes = imported.conversion.axes();
        let expected: Value = serde_json::from_slice(&std::fs::read(expected).unwrap()).unwrap();
        let rate = expected["ticksPerSecond"].as_f64().unwrap();
        if let Some(found) = imported.conversion.frame_rate {
            assert_eq!(f64::from(found.value), rate, "{name}");
        }
        let model = imported.model;
        let frames = expected["frames"].as_array().unwrap();
        for (frame, bone) in frames.iter().zip(&model.animation.skeleton.bones) {
            let written = frame[0].as_str().unwrap();
            assert!(bone.name == written || written.is_empty(), "{name}");
            assert_eq!(bone.parent.map_or(-1, i64::from), frame[1].as_i64().unwrap());
        }
        let mut evaluator = Evaluator::new(Arc::new(model.clone()));
        let rest: Vec<Mat4> = {
            let skeleton = &model.animation.skeleton;
            let (mut poses, mut matrices) =
                (vec![Transform::IDENTITY; skeleton.len()], vec![Mat4::IDENTITY; skeleton.len()]);
            sample_take(None, skeleton, 0.0, &mut poses);
            to_root(skeleton, &poses, &mut matrices);
            matrices
        };
        let mut worst = compare(&model, &axes, &expected["rest"], &rest, frames.len());
        let clips = expected["clips"].as_array().unwrap();
        assert_eq!(clips.len(), model.animation.takes.len());
        for (take, clip) in clips.iter().enumerate() {
            assert_eq!(model.animation.takes[take].name, clip["name"].as_str().unwrap());
            for sample in clip["samples"].as_array().unwrap() {
                let tick = sample["tick"].as_f64().unwrap();
                let bones = if name == "tiny.x" {
                    by_numbers(&model, take, tick, 80.0, rate)
                } else {
                    evaluator.pose(Some(take), (tick / rate) as f32);
                    evaluator.to_root().to_vec()
                };
                worst = worst.max(compare(&model, &axes, sample, &bones, frames.len()));
                compared += 1;
            }
        }
        println!("{name}: {worst:.1e}");
        assert!(worst < TOLERANCE, "{name}: {worst}");
    }
    assert!(compared >= 8);
}

#[test]
fn a_model_has_the_same_vertices_as_x_and_as_m3d() {
    let path = crate::doors::data().join("m3d/RiggedSimple.m3d");
    let bytes = std::fs::read(path).unwrap();
    let original = crate::takes::imported(&m3d::M3D, &bytes);
    let as_x = crate::takes::imported(&x::X, &x::write(&original).unwrap().bytes);
    let as_m3d = crate::takes::imported(&m3d::M3D, &m3d::write(&as_x, m3d::M3dDialect::Dx11).unwrap().bytes);
    let models = [original, as_x, as_m3d].map(Arc::new);
    for time in [0.0, 0.31, 0.9, 1.7, 2.1] {
        let [a, b, c] = models.each_ref().map(|model| {
            let mut evaluator = Evaluator::new(Arc::clone(model));
            evaluator.pose(Some(0), time);
            let mut positions = evaluator.all_positions();
            positions.sort_by(|a, b| (a.x + a.y * 3.1 + a.z * 7.7).total_cmp(&(b.x + b.y * 3.1 + b.z * 7.7)));
            positions.dedup_by(|a, b| a.distance(*b) < 1e-5);
            positions
        });
        for other in [b, c] {
            let nearest = |position: &Vec3| {
                other.iter().map(|found| found.distance(*position)).fold(f32::INFINITY, f32::min)
            };
            let worst = a.iter().map(nearest).fold(0.0, f32::max);
            assert!(worst < 1e-3, "{worst} at {time}");
        }
    }
}
