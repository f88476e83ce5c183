//! Poses agree with an independent evaluation of the same files by their parser: every node, every take, deformed vertices.

use crate::support::{InFileSpace, data, file, read_here, read_in_child};
use dragonfly_anim::data::{MeshInstance, Skeleton};
use dragonfly_anim::skin::rigid;
use dragonfly_kit::skip::models;
use glam::{DMat4, DVec3, Mat4};
use serde_json::Value;
use std::collections::HashMap;
use std::path::Path;

/// Largest difference, relative to the largest number of a matrix or to 1.
const TOLERANCE: f64 = 1e-4;

/// Returns the path of each bone, without the helpers that hold a scale, and the helper of each path.
fn paths(skeleton: &Skeleton) -> (HashMap<String, usize>, HashMap<String, usize>) {
    let mut paths: Vec<String> = Vec::new();
    let (mut bones, mut helpers) = (HashMap::new(), HashMap::new());
    for (index, bone) in skeleton.bones.iter().enumerate() {
        let parent = bone.parent.map_or(String::new(), |parent| paths[parent as usize].clone());
        let is_helper = bone
            .parent
            .is_some_and(|parent| bone.name == format!("{} scale", skeleton.bones[parent as usize].name));
        if is_helper {
            helpers.insert(parent.clone(), index);
            paths.push(parent);
        } else {
            let path = format!("{parent}/{}", bone.name);
            bones.insert(path.clone(), index);
            paths.push(path);
        }
    }
    (bones, helpers)
}

/// Returns the path of each node of the expected results.
fn expected_paths(nodes: &[Value]) -> Vec<String> {
    let mut paths: Vec<String> = Vec::new();
    for node in nodes {
        let parent = node["parent"].as_i64().and_then(|parent| usize::try_from(parent).ok());
        // The root of the scene is not a bone.
        paths.push(match parent {
            None => String::new(),
            Some(parent) => format!("{}/{}", paths[parent], node["name"].as_str().unwrap()),
        });
    }
    paths
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap_or(f64::NAN)).collect()
}

fn relative(found: DMat4, expected: &[f64]) -> f64 {
    let largest = expected.iter().fold(1.0_f64, |largest, number| largest.max(number.abs()));
    let found = found.to_cols_array();
    found.iter().zip(expected).map(|(a, b)| (a - b).abs() / largest).fold(0.0, f64::max)
}

/// The largest difference, and where it is.
#[derive(Default)]
struct Worst(f64, String);

impl Worst {
    fn add(&mut self, difference: f64, place: impl FnOnce() -> String) {
        // Not a number is the worst.
        if difference > self.0 || difference.is_nan() {
            *self = Self(difference, place());
        }
    }
}

/// Compares one file. Returns the worst difference and the number of matrices and vertices that were compared.
fn compare(bytes: &[u8], expected: &Value) -> (Worst, usize) {
    let read = read_here(bytes).expect("a good file");
    let nodes = expected["nodes"].as_array().unwrap();
    let expected_paths = expected_paths(nodes);
    let mut scene = InFileSpace::new(read);
    let (bones, helpers) = paths(&scene.evaluator.model().animation.skeleton);
    let (mut worst, mut compared) = (Worst::default(), 0);
    for (take, clip) in expected["clips"].as_array().unwrap().iter().enumerate() {
        let name = clip["name"].as_str().unwrap();
        let takes = &scene.evaluator.model().animation.takes;
        if name != "(static)" {
            assert_eq!(takes[take].name, name);
        }
        for sample in clip["samples"].as_array().unwrap() {
            let time = sample["t"].as_f64().unwrap();
            scene.evaluator.pose(Some(take), time as f32);
            for (node, world) in sample["world"].as_array().unwrap().iter().enumerate() {
                let path = &expected_paths[node];
                let to_root = scene.evaluator.to_root();
                let mesh = nodes[node]["mesh"].as_u64();
                let model = scene.evaluator.model();
                let candidates: Vec<Mat4> = match helpers.get(path).or_else(|| bones.get(path)) {
                    Some(&bone) => vec![to_root[bone]],
                    // A mesh that nothing moves; instances of one mesh look alike.
                    None => {
                        let of_mesh = |instance: &&MeshInstance| Some(u64::from(instance.mesh)) == mesh;
                        let placed = model.instances.iter().filter(of_mesh);
                        placed
                            .filter(|instance| instance.skin.is_none())
                            .map(|instance| rigid(instance, to_root))
                            .collect()
                    }
                };
                let world = numbers(world);
                let differences = candidates.iter().map(|&matrix| relative(scene.matrix(matrix), &world));
                let Some(difference) = differences.reduce(f64::min) else { continue };
                compared += 1;
                worst.add(difference, || format!("take {name} at {time} s: {path}"));
            }
            for mesh in sample["deformed"].as_array().unwrap() {
                let node = mesh["node"].as_u64().unwrap() as usize;
                let positions = scene.positions(nodes[node]["mesh"].as_u64().unwrap() as u32);
                let points: Vec<DVec3> = mesh["worldPositions"]
                    .as_array()
                    .unwrap()
                    .iter()
                    .map(|point| DVec3::from_slice(&numbers(point)))
                    .collect();
                for point in points {
                    let distance = |position: &DVec3| position.distance(point);
                    let nearest = positions.iter().map(distance).fold(f64::MAX, f64::min);
                    compared += 1;
                    let size = point.abs().max_element().max(1.0);
                    worst.add(nearest / size, || {
                        format!("take {name} at {time} s: a vertex of {}", expected_paths[node])
                    });
                }
            }
        }
    }
    (worst, compared)
}

fn expected_in(folder: &Path, file: &str) -> Value {
    let path = folder.join(format!("fbx__{file}.json"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn every_node_take_and_vertex_of_the_files_here_agrees_with_the_reference() {
    for (name, least) in [
        ("maya_scale_no_inherit_6100_ascii.fbx", 20),
        ("maya_blend_shape_cube_7700_binary.fbx", 20),
        ("max_transformed_skin_7500_binary.fbx", 50),
        ("maya_interpolation_modes_7500_ascii.fbx", 5),
    ] {
        let (worst, compared) = compare(&file(name), &expected_in(&data().join("expected"), name));
        println!("{name}: {compared} compared, {:.1e} at {}", worst.0, worst.1);
        assert!(worst.0 <= TOLERANCE, "{name}: {:e} at {}", worst.0, worst.1);
        assert!(compared >= least, "{name}: only {compared} compared");
    }
}

#[test]
fn every_file_of_the_collection_agrees_with_the_reference() {
    let Some(folder) = models() else { return };
    let mut failed = Vec::new();
    let mut files = 0;
    for entry in std::fs::read_dir(folder.join("fbx")).expect("the folder of FBX files") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if !name.ends_with(".fbx") {
            continue;
        }
        let bytes = std::fs::read(&path).expect("a file");
        let (worst, compared) = compare(&bytes, &expected_in(&folder.join("../expected"), &name));
        println!("{name}: {compared} compared, {:.1e} at {}", worst.0, worst.1);
        files += 1;
        if worst.0 > TOLERANCE || worst.0.is_nan() {
            failed.push(format!("{name}: {:e} at {}", worst.0, worst.1));
        }
    }
    assert!(files >= 22, "only {files} files");
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn the_child_gives_the_same_model_as_this_process() {
    for name in ["max_transformed_skin_7500_binary.fbx", "maya_blend_shape_cube_7700_binary.fbx"] {
        let bytes = file(name);
        let (here, there) =
            (read_here(&bytes).expect("a good file"), read_in_child(&bytes).expect("a good file"));
        assert_eq!(here.model, there.model, "{name}");
        assert_eq!(here.conversion, there.conversion);
        assert_eq!(here.warnings, there.warnings);
    }
}
