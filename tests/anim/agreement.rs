//! Poses agree with those that independent programs computed from the same files.

use crate::doors::{FolderFs, data, shared};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{ReadOptions, read};
use glam::{Mat4, Vec3};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Differences allowed: relative, and absolute near zero.
const RELATIVE: f64 = 1e-4;
const ABSOLUTE: f64 = 1e-5;

/// Counts comparisons and remembers the worst.
#[derive(Default)]
struct Comparison {
    numbers: usize,
    /// Largest difference in units of what is allowed; at most 1 is agreement.
    worst: f64,
    place: String,
}

impl Comparison {
    fn compare(&mut self, got: &[f32], expected: &Value, place: impl Fn() -> String) {
        let expected: Vec<f64> = expected.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect();
        assert_eq!(got.len(), expected.len(), "{}", place());
        for (&got, expected) in got.iter().zip(expected) {
            self.numbers += 1;
            let off = (f64::from(got) - expected).abs() / (ABSOLUTE + RELATIVE * expected.abs());
            if !(off <= self.worst) {
                (self.worst, self.place) = (off, format!("{}: {got} instead of {expected}", place()));
            }
        }
    }
}

fn load(path: &Path) -> ModelData {
    let bytes = std::fs::read(path).unwrap();
    let name = path.file_name().unwrap().to_str().unwrap();
    let door = FolderFs(path.parent().unwrap().to_owned());
    let imported = read(name, &bytes, &door, &ReadOptions::default());
    imported.unwrap_or_else(|error| panic!("{}: {error}", path.display())).model
}

/// One pose of the expected file against ours.
fn compare_pose(evaluator: &Evaluator, expected: &Value, place: &str, comparison: &mut Comparison) {
    let model = evaluator.model().clone();
    for (bone, to_root) in model.animation.skeleton.bones.iter().zip(evaluator.to_root()) {
        let node = bone.node.unwrap();
        let world = &expected["world"][node.to_string()];
        comparison.compare(&to_root.to_cols_array(), world, || format!("{place} bone of node {node}"));
    }
    for (index, instance) in model.instances.iter().enumerate() {
        let node = instance.node.unwrap();
        let world = dragonfly_anim::skin::rigid(instance, evaluator.to_root());
        let expected_world = &expected["world"][node.to_string()];
        comparison.compare(&world.to_cols_array(), expected_world, || format!("{place} mesh node {node}"));
        if let Some(weights) = expected["weights"].get(node.to_string()) {
            comparison.compare(evaluator.morph_weights(index), weights, || format!("{place} weights of {node}"));
        }
    }
    for (skin, joints) in expected["skin"].as_array().into_iter().flatten().enumerate() {
        for (joint, matrix) in joints.as_array().unwrap().iter().enumerate() {
            let got: Mat4 = evaluator.final_poses(skin)[joint];
            comparison.compare(&got.to_cols_array(), matrix, || format!("{place} skin {skin} joint {joint}"));
        }
    }
    for (key, vertices) in expected["verts"].as_object().into_iter().flatten() {
        let (node, primitive) = key.split_once('/').unwrap();
        let node: u32 = node.parse().unwrap();
        let instance = model.instances.iter().position(|instance| instance.node == Some(node));
        let instance = instance.unwrap_or_else(|| panic!("{place}: node {node} shows no mesh"));
        let vertices = vertices.as_array().unwrap();
        let mut got = vec![Vec3::ZERO; vertices.len()];
        let count = evaluator.positions(instance, primitive.parse().unwrap(), &mut got);
        assert_eq!(count, vertices.len(), "{place} vertices {key}");
        for (vertex, (got, expected)) in got.iter().zip(vertices).enumerate() {
            comparison.compare(&got.to_array(), expected, || format!("{place} vertex {vertex} of {key}"));
        }
    }
}

/// A file against its expected poses: rest, and every sample of every clip there.
fn compare_file(model: &Path, expected: &Path) -> Comparison {
    let model = Arc::new(load(model));
    let expected: Value = serde_json::from_slice(&std::fs::read(expected).unwrap()).unwrap();
    let mut evaluator = Evaluator::new(model);
    let mut comparison = Comparison::default();
    compare_pose(&evaluator, &expected["rest"], "rest", &mut comparison);
    for clip in expected["clips"].as_array().unwrap() {
        let index = clip["index"].as_u64().unwrap() as usize;
        for sample in clip["samples"].as_array().unwrap() {
            let time = sample["t"].as_f64().unwrap() as f32;
            evaluator.pose(Some(index), time);
            compare_pose(&evaluator, sample, &format!("take {index} at {time}"), &mut comparison);
        }
    }
    comparison
}

/// Compares every `gltf__*.json` in `expected`, or its `.unitquat.json` where there is one; tells how many.
fn compare_folder(assets: &Path, expected: &Path) -> usize {
    let mut names: Vec<String> =
        std::fs::read_dir(expected).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let (mut files, mut numbers, mut failures) = (0, 0, Vec::new());
    for name in &names {
        let Some(file) = name.strip_prefix("gltf__").and_then(|name| name.strip_suffix(".json")) else { continue };
        // Files whose rotation keys are not unit have a second answer, for those who make them so.
        if names.contains(&format!("gltf__{file}.unitquat.json")) {
            continue;
        }
        let file = file.strip_suffix(".unitquat").unwrap_or(file);
        let model: PathBuf = assets.join(file.replace("__", "/"));
        let comparison = compare_file(&model, &expected.join(name));
        println!("{file}: {} numbers, worst {:.4} of what is allowed", comparison.numbers, comparison.worst);
        if comparison.worst > 1.0 {
            failures.push(format!("{file}: {:.2} times too far: {}", comparison.worst, comparison.place));
        }
        files += 1;
        numbers += comparison.numbers;
    }
    println!("{files} files, {numbers} numbers");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    files
}

#[test]
fn poses_of_small_files_agree_with_independent_ones() {
    assert!(compare_folder(&data().join("gltf"), &data().join("expected")) >= 5);
}

#[test]
fn poses_of_all_files_agree_with_independent_ones() {
    let (Some(assets), Some(expected)) = (shared("assets/gltf"), shared("expected")) else { return };
    assert!(compare_folder(&assets, &expected) >= 40);
}
