//! Poses agree with those that independent programs computed from the same files, on the open path and on the fast
//! path.

use crate::doors::{TestFolder, data};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::fast::matrix::{self, mat4};
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_anim::fast::{KeyedTake, Pose, Rig, RootPoses, SkinBinding, final_poses, sample, to_root};
use dragonfly_anim::format::{ReadOptions, read};
use glam::{Mat4, Vec3};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Allowed difference, relative to the largest number of the matrix or point, or to 1 if that is smaller.
const RELATIVE: f64 = 1e-4;

/// Counts comparisons and keeps the largest difference.
#[derive(Default)]
struct Comparison {
    numbers: usize,
    /// Largest difference as a multiple of the allowed difference; the results agree if it is at most 1.
    worst: f64,
    place: String,
}

impl Comparison {
    fn compare(&mut self, got: &[f32], expected: &Value, place: impl Fn() -> String) {
        let expected: Vec<f64> =
            expected.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect();
        assert_eq!(got.len(), expected.len(), "{}", place());
        let largest = expected.iter().copied().map(f64::abs).fold(1.0, f64::max);
        for (&got, expected) in got.iter().zip(expected) {
            self.numbers += 1;
            let off = (f64::from(got) - expected).abs() / (RELATIVE * largest);
            assert!(!off.is_nan(), "{}: {got}", place());
            if off > self.worst {
                (self.worst, self.place) = (off, format!("{}: {got} instead of {expected}", place()));
            }
        }
    }
}

fn load(path: &Path) -> ModelData {
    let bytes = std::fs::read(path).unwrap();
    let name = path.file_name().unwrap().to_str().unwrap();
    let door = TestFolder(path.parent().unwrap().to_owned());
    let imported = read(name, &bytes, &door, &ReadOptions::default());
    imported.unwrap_or_else(|error| panic!("{}: {error}", path.display())).model
}

/// Compares one pose of the expected file with ours.
fn compare_pose(evaluator: &Evaluator, expected: &Value, place: &str, comparison: &mut Comparison) {
    let model = evaluator.model().clone();
    for (node, world) in expected["world"].as_object().unwrap() {
        let number: u32 = node.parse().unwrap();
        let bone = model.animation.skeleton.bones.iter().position(|bone| bone.node == Some(number));
        if let Some(bone) = bone {
            let to_root = evaluator.to_root()[bone].to_cols_array();
            comparison.compare(&to_root, world, || format!("{place} bone of node {node}"));
        }
        if let Some(instance) = model.instances.iter().find(|instance| instance.node == Some(number)) {
            let to_root = dragonfly_anim::skin::rigid(instance, evaluator.to_root()).to_cols_array();
            comparison.compare(&to_root, world, || format!("{place} mesh of node {node}"));
        }
    }
    for (node, weights) in expected["weights"].as_object().into_iter().flatten() {
        let instance = instance_of(&model, node);
        comparison
            .compare(evaluator.morph_weights(instance), weights, || format!("{place} weights of {node}"));
    }
    for (skin, joints) in expected["skin"].as_array().into_iter().flatten().enumerate() {
        for (joint, matrix) in joints.as_array().unwrap().iter().enumerate() {
            let got: Mat4 = evaluator.final_poses(skin)[joint];
            comparison.compare(&got.to_cols_array(), matrix, || format!("{place} skin {skin} joint {joint}"));
        }
    }
    for (key, vertices) in expected["verts"].as_object().into_iter().flatten() {
        let (node, primitive) = key.split_once('/').unwrap();
        let instance = instance_of(&model, node);
        let vertices = vertices.as_array().unwrap();
        let mut got = vec![Vec3::ZERO; vertices.len()];
        let count = evaluator.positions(instance, primitive.parse().unwrap(), &mut got);
        assert_eq!(count, vertices.len(), "{place} vertices {key}");
        for (vertex, (got, expected)) in got.iter().zip(vertices).enumerate() {
            comparison.compare(&got.to_array(), expected, || format!("{place} vertex {vertex} of {key}"));
        }
    }
}

/// Returns the instance of a node.
fn instance_of(model: &ModelData, node: &str) -> usize {
    let number = Some(node.parse().unwrap());
    model
        .instances
        .iter()
        .position(|instance| instance.node == number)
        .expect("every node with a mesh is shown")
}

/// A model on the fast path.
struct Fast<'a> {
    model: &'a ModelData,
    rig: Rig,
    takes: Vec<KeyedTake>,
    skins: Vec<SkinBinding>,
    pose: Pose,
    roots: RootPoses,
}

impl<'a> Fast<'a> {
    fn new(model: &'a ModelData) -> Self {
        let skeleton = &model.animation.skeleton;
        let rig = Rig::new(skeleton);
        let takes = model.animation.takes.iter().map(|take| KeyedTake::new(skeleton, take)).collect();
        let skins = model.skins.iter().map(|skin| SkinBinding::new(&rig, skin)).collect();
        let (pose, roots) = (Pose::new(skeleton.len()), RootPoses::new(&rig));
        Self { model, rig, takes, skins, pose, roots }
    }

    /// Compares bones and joints of one pose of the expected file with those of the fast path.
    fn compare(&mut self, level: SimdLevel, take: usize, expected: &Value, comparison: &mut Comparison) {
        let time = expected["t"].as_f64().unwrap() as f32;
        sample(level, &self.takes[take], time, self.pose.blocks_mut());
        to_root(level, &self.rig, self.pose.blocks(), &mut self.roots);
        let place = format!("{} take {take} at {time}", level.name());
        for (node, world) in expected["world"].as_object().unwrap() {
            let number: u32 = node.parse().unwrap();
            let bones = &self.model.animation.skeleton.bones;
            if let Some(bone) = bones.iter().position(|bone| bone.node == Some(number)) {
                let got = mat4(self.roots.get(bone)).to_cols_array();
                comparison.compare(&got, world, || format!("{place} bone of node {node}"));
            }
        }
        for (skin, joints) in expected["skin"].as_array().into_iter().flatten().enumerate() {
            let joints = joints.as_array().unwrap();
            let mut finals = vec![matrix::IDENTITY; joints.len()];
            final_poses(level, &self.skins[skin], &self.roots, &mut finals);
            for (joint, (got, expected)) in finals.iter().zip(joints).enumerate() {
                let got = mat4(got).to_cols_array();
                comparison.compare(&got, expected, || format!("{place} skin {skin} joint {joint}"));
            }
        }
    }
}

/// Compares a file with its expected poses: the rest pose, and every sample of every clip.
fn compare_file(model: &Path, expected: &Path) -> Comparison {
    let model = Arc::new(load(model));
    let expected: Value = serde_json::from_slice(&std::fs::read(expected).unwrap()).unwrap();
    let mut fast = Fast::new(&model);
    let mut evaluator = Evaluator::new(Arc::clone(&model));
    let mut comparison = Comparison::default();
    compare_pose(&evaluator, &expected["rest"], "rest", &mut comparison);
    for clip in expected["clips"].as_array().unwrap() {
        let index = clip["index"].as_u64().unwrap() as usize;
        for sample in clip["samples"].as_array().unwrap() {
            let time = sample["t"].as_f64().unwrap() as f32;
            evaluator.pose(Some(index), time);
            compare_pose(&evaluator, sample, &format!("take {index} at {time}"), &mut comparison);
            for level in SimdLevel::all() {
                fast.compare(level, index, sample, &mut comparison);
            }
        }
    }
    comparison
}

/// Compares every `gltf__*.json` in `expected`, or its `.unitquat.json` if there is one, and returns their number.
///
/// Programs that do not normalize rotation keys give different results for files with keys rounded to three digits. For
/// those files a second result was computed from normalized keys.
fn compare_folder(assets: &Path, expected: &Path) -> usize {
    let mut names: Vec<String> = std::fs::read_dir(expected)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let (mut files, mut numbers, mut failures) = (0, 0, Vec::new());
    for name in &names {
        let Some(file) = name.strip_prefix("gltf__").and_then(|name| name.strip_suffix(".json")) else {
            continue;
        };
        let unit = format!("gltf__{file}.unitquat.json");
        if names.contains(&unit) {
            continue;
        }
        let own = data().join("expected").join(unit);
        let path = if own.exists() { own } else { expected.join(name) };
        let file = file.strip_suffix(".unitquat").unwrap_or(file);
        let model: PathBuf = assets.join(file.replace("__", "/"));
        let comparison = compare_file(&model, &path);
        println!(
            "{file}: {} numbers, worst {:.4} of the allowed difference",
            comparison.numbers, comparison.worst
        );
        if comparison.worst > 1.0 {
            failures.push(format!(
                "{file}: {:.2} times the allowed difference: {}",
                comparison.worst, comparison.place
            ));
        }
        files += 1;
        numbers += comparison.numbers;
    }
    println!("{files} files, {numbers} numbers");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    files
}

/// Checks a long rig at every bone and vertex: local poses, matrices of three rows, and skinned vertices.
#[test]
fn a_rig_of_67_joints_agrees_with_exact_poses() {
    let model = Arc::new(load(&data().join("bench/pab.glb")));
    let golden = std::fs::read(data().join("bench/pab.golden.json")).unwrap();
    let golden: Value = serde_json::from_slice(&golden).unwrap();
    let nodes: Vec<u32> =
        golden["joints"].as_array().unwrap().iter().map(|node| node.as_u64().unwrap() as u32).collect();
    let bone_of =
        |node: u32| model.animation.skeleton.bones.iter().position(|bone| bone.node == Some(node)).unwrap();
    let bones: Vec<usize> = nodes.into_iter().map(bone_of).collect();
    let mut evaluator = Evaluator::new(model.clone());
    let mut comparison = Comparison::default();
    for clip in golden["clips"].as_array().unwrap() {
        let name = clip["name"].as_str().unwrap();
        let take = model.animation.takes.iter().position(|take| take.name == name).unwrap();
        for pose in clip["poses"].as_array().unwrap() {
            let time = pose["t"].as_f64().unwrap() as f32;
            evaluator.pose(Some(take), time);
            for (&bone, rows) in bones.iter().zip(pose["global"].as_array().unwrap()) {
                let got: [f32; 16] = evaluator.to_root()[bone].transpose().to_cols_array();
                comparison.compare(&got[..12], rows, || format!("{name} at {time} bone {bone}"));
            }
            let mut positions = vec![Vec3::ZERO; model.meshes[0].primitives[0].vertices.len()];
            evaluator.positions(0, 0, &mut positions);
            for vertex in pose["skinned"].as_array().unwrap() {
                let index = vertex[0].as_u64().unwrap() as usize;
                let expected = Value::Array(vertex.as_array().unwrap()[1..].to_vec());
                comparison.compare(&positions[index].to_array(), &expected, || {
                    format!("{name} at {time} vertex {index}")
                });
            }
        }
    }
    println!("{} numbers, worst {:.4} of the allowed difference", comparison.numbers, comparison.worst);
    assert!(comparison.numbers > 10_000 && comparison.worst <= 1.0, "{}", comparison.place);
}

#[test]
fn poses_of_the_files_in_the_repository_agree_with_independent_results() {
    assert!(compare_folder(&data().join("gltf"), &data().join("expected")) >= 5);
}

#[test]
fn poses_of_the_collection_agree_with_independent_ones() {
    let collection = data().join("collection");
    assert!(compare_folder(&collection, &collection.join("expected")) >= 30);
}
