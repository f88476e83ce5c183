//! Meshes that Draco compressed: the same triangles as without, errors for damaged data, and saves that keep their bytes.

use crate::doors::data;
use crate::fixture::Fixture;
use crate::save_support::{OpenedFile, bin_of, json_of};
use crate::soundness::faults;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{ImportError, NoFiles, ReadOptions, read};
use dragonfly_kit::counting::peak;
use dragonfly_kit::mutate::Mutator;
use dragonfly_kit::random::seed;
use glam::{Vec2, Vec3};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::Arc;

const EXTENSION: &str = "KHR_draco_mesh_compression";

/// Largest memory for a damaged file, bytes.
const MOST_MEMORY: u64 = 64 << 20;

/// A corner of a triangle: position in the scene, texture coordinates, normal, and weights by the names of bones.
#[derive(Clone, Debug)]
struct Corner {
    position: Vec3,
    texture: Vec2,
    normal: Vec3,
    weights: BTreeMap<String, f32>,
}

/// Returns the triangles of a model in the pose of rest, with the weights of morph targets that are given.
fn triangles(model: &ModelData, weights: &[f32]) -> Vec<[Corner; 3]> {
    let mut model = model.clone();
    model.animation.takes.clear();
    for mesh in &mut model.meshes {
        mesh.morph_weights = weights.to_vec();
    }
    let mut evaluator = Evaluator::new(Arc::new(model));
    evaluator.pose(None, 0.0);
    let model = evaluator.model().clone();
    let mut triangles = Vec::new();
    for (number, instance) in model.instances.iter().enumerate() {
        for (at, primitive) in evaluator.primitives(number).iter().enumerate() {
            let vertices = &primitive.vertices;
            let mut positions = vec![Vec3::ZERO; vertices.len()];
            evaluator.positions(number, at, &mut positions);
            let corner = |&vertex: &u32| {
                let vertex = vertex as usize;
                let mut weights = BTreeMap::new();
                let per = vertices.influences_per_vertex;
                for influence in vertices.influences.iter().skip(vertex * per).take(per) {
                    let Some(skin) = instance.skin else { break };
                    let bone = model.skins[skin as usize].bones[influence.joint as usize];
                    let name = model.animation.skeleton.bones[bone as usize].name.clone();
                    *weights.entry(name).or_insert(0.0) += influence.weight;
                }
                let texture = vertices.texture_coordinates[0].get(vertex).copied().unwrap_or_default();
                Corner { position: positions[vertex], texture, normal: vertices.normals[vertex], weights }
            };
            triangles.extend(
                primitive.indices.chunks_exact(3).map(|triangle| [0, 1, 2].map(|at| corner(&triangle[at]))),
            );
        }
    }
    triangles
}

/// Returns the largest differences of positions, texture coordinates and weights between the triangles of two models.
fn differences(expected: &[[Corner; 3]], found: &[[Corner; 3]]) -> (f32, f32, f32) {
    assert_eq!(expected.len(), found.len());
    let mut worst = (0.0_f32, 0.0_f32, 0.0_f32);
    for triangle in expected {
        let turned = |other: &[Corner; 3], by: usize| [0, 1, 2].map(|at| other[(at + by) % 3].clone());
        let distance = |other: &[Corner; 3]| {
            let corners = triangle.iter().zip(other);
            corners
                .map(|(a, b)| a.position.distance(b.position).max(a.texture.distance(b.texture)))
                .fold(0.0, f32::max)
        };
        let all = found.iter().flat_map(|other| [0, 1, 2].map(|by| turned(other, by)));
        let nearest = all.min_by(|a, b| distance(a).total_cmp(&distance(b))).expect("a triangle");
        for (a, b) in triangle.iter().zip(&nearest) {
            worst.0 = worst.0.max(a.position.distance(b.position));
            worst.1 = worst.1.max(a.texture.distance(b.texture));
            for (name, weight) in &a.weights {
                worst.2 = worst.2.max((weight - b.weights.get(name).unwrap_or(&0.0)).abs());
            }
        }
    }
    worst
}

fn model(name: &str) -> ModelData {
    let bytes = std::fs::read(data().join(name)).expect("a file");
    let imported = read("a.glb", &bytes, &NoFiles, &ReadOptions::default()).expect("a good file");
    // Weights of few bits do not add up to one.
    let others = imported.warnings.iter().filter(|warning| warning.code != "ACCESSOR_WEIGHTS_NON_NORMALIZED");
    assert_eq!(others.count(), 0, "{name}: {:?}", imported.warnings);
    imported.model
}

#[test]
fn a_skinned_model_that_blender_compressed_has_the_triangles_and_weights_of_the_original() {
    let (plain, compressed) = (model("gltf/Fox.glb"), model("draco/Fox.glb"));
    let expected = triangles(&plain, &[]);
    let size = expected.iter().flatten().map(|corner| corner.position.length()).fold(0.0, f32::max);
    let (position, texture, weight) = differences(&expected, &triangles(&compressed, &[]));
    // Positions have 14 bits, texture coordinates and weights 12.
    println!("{position:e} of {size}, {texture:e}, {weight:e}");
    assert!(position < size * 2.0 / 16384.0 && texture < 2.0 / 4096.0 && weight < 4.0 / 4096.0);
    assert!(expected.iter().flatten().any(|corner| corner.weights.len() > 1));
}

#[test]
fn morph_targets_beside_compressed_data_move_the_vertices_that_they_belong_to() {
    let (plain, compressed) = (model("gltf/AnimatedMorphCube.glb"), model("draco/AnimatedMorphCube.glb"));
    for weights in [[0.0, 0.0], [1.0, 0.0], [0.3, 0.9]] {
        let expected = triangles(&plain, &weights);
        let found = triangles(&compressed, &weights);
        let (position, _, _) = differences(&expected, &found);
        let size = expected.iter().flatten().map(|corner| corner.position.length()).fold(0.0, f32::max);
        assert!(position < size * 4.0 / 16384.0, "{weights:?}: {position:e} of {size}");
        let normals = found.iter().flatten().map(|corner| corner.normal.length());
        assert!(normals.clone().all(|length| (length - 1.0).abs() < 1e-3));
    }
}

#[test]
fn a_save_without_an_edit_keeps_every_byte_of_a_compressed_file() {
    for name in ["draco/Fox.glb", "draco/AnimatedMorphCube.glb"] {
        let (opened, door) = OpenedFile::file(&data().join(name));
        let before = opened.source.bytes();
        assert!(opened.saved(&opened.takes(), &door).bytes() == &before[..], "{name}");
    }
}

/// A file with one compressed primitive and nothing else, whose compressed data can be exchanged.
struct CompressedFile {
    json: Value,
    data: Vec<u8>,
    /// Number of the buffer view of the data.
    view: usize,
}

impl CompressedFile {
    fn of(name: &str) -> Self {
        let bytes = std::fs::read(data().join(name)).expect("a file");
        let (mut json, bin) = (json_of(&bytes), bin_of(&bytes));
        let mut primitive = json["meshes"][0]["primitives"][0].clone();
        let view = primitive["extensions"][EXTENSION]["bufferView"].as_u64().expect("a number") as usize;
        let number = |name: &str| json["bufferViews"][view][name].as_u64().unwrap_or(0) as usize;
        let (start, length) = (number("byteOffset"), number("byteLength"));
        primitive.as_object_mut().expect("a primitive").remove("targets");
        primitive.as_object_mut().expect("a primitive").remove("material");
        let views = json["bufferViews"].as_array().expect("views").len();
        let accessors = json["accessors"].as_array_mut().expect("accessors");
        for accessor in accessors.iter_mut() {
            if accessor.get("bufferView").is_some() || accessor.get("sparse").is_some() {
                *accessor = json!({"componentType": 5121, "type": "SCALAR", "count": 1});
            }
        }
        let json = json!({
            "asset": {"version": "2.0"}, "extensionsUsed": [EXTENSION], "extensionsRequired": [EXTENSION],
            "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [primitive]}],
            "accessors": accessors, "bufferViews": vec![json!({"buffer": 0, "byteLength": 1}); views],
            "buffers": [{"byteLength": 1}],
        });
        Self { json, data: bin[start..start + length].to_vec(), view }
    }

    /// Reads the file with other compressed data.
    fn read(&self, data: &[u8]) -> Result<ModelData, ImportError> {
        let mut json = self.json.clone();
        json["buffers"][0]["byteLength"] = json!(data.len());
        json["bufferViews"][self.view]["byteLength"] = json!(data.len());
        let file = Fixture { json, bin: data.to_vec() }.glb();
        read("a.glb", &file, &NoFiles, &ReadOptions::default()).map(|imported| imported.model)
    }
}

#[test]
fn compressed_data_that_is_cut_is_an_error_with_its_place() {
    for name in ["draco/Fox.glb", "draco/AnimatedMorphCube.glb"] {
        let file = CompressedFile::of(name);
        assert!(file.read(&file.data).is_ok(), "{name}");
        for end in (1..file.data.len()).step_by(file.data.len() / 150 + 1) {
            let error = file.read(&file.data[..end]).expect_err("cut data");
            assert_eq!(error.code(), "DRACO_INVALID", "{name} cut at {end}: {error}");
            assert!(error.to_string().contains(&format!("/extensions/{EXTENSION}")), "{error}");
        }
    }
}

#[test]
fn damaged_compressed_data_is_an_error_or_a_sound_model_in_little_memory() {
    let first = seed(20_117);
    println!("DRAGONFLY_SEED={first}");
    let mut count = 0;
    for name in ["draco/Fox.glb", "draco/AnimatedMorphCube.glb"] {
        let file = CompressedFile::of(name);
        let mut mutator = Mutator::new(first, &[b"\xff\xff\xff\xff\x0f", b"\0\0\0\0", b"DRACO"]);
        for number in 0..300 {
            let damaged = mutator.mutant(std::slice::from_ref(&file.data));
            let (memory, read) = peak(|| file.read(&damaged));
            assert!(memory < MOST_MEMORY, "{name}, mutant {number}: {memory} bytes");
            if let Ok(model) = read {
                count += 1;
                assert_eq!(faults(&model), [""; 0], "{name}, mutant {number}");
            }
        }
    }
    println!("{count} of 600 were read");
}

#[test]
fn numbers_around_compressed_data_that_do_not_fit_are_refused() {
    let file = CompressedFile::of("draco/AnimatedMorphCube.glb");
    let extension = format!("/meshes/0/primitives/0/extensions/{EXTENSION}");
    for (path, value) in [
        (format!("{extension}/bufferView"), json!(99)),
        (format!("{extension}/bufferView"), json!(-1)),
        (format!("{extension}/attributes"), json!(3)),
        (format!("{extension}/attributes"), json!({})),
        (format!("{extension}/attributes/POSITION"), json!(77)),
        (format!("{extension}/attributes/POSITION"), json!("first")),
        (extension.clone(), json!([])),
        ("/meshes/0/primitives/0/mode".to_owned(), json!(5)),
        ("/accessors/0/count".to_owned(), json!(27)),
        ("/accessors/0/count".to_owned(), json!(1_u64 << 40)),
        ("/accessors/0/type".to_owned(), json!("VEC4")),
        ("/accessors/0/componentType".to_owned(), json!(5121)),
        ("/accessors/2/count".to_owned(), json!(33)),
        ("/accessors/2/count".to_owned(), json!(35)),
        ("/accessors/2/count".to_owned(), json!(3_u64 << 40)),
    ] {
        let mut json = file.json.clone();
        *json.pointer_mut(&path).expect("a member") = value.clone();
        let damaged = CompressedFile { json, ..CompressedFile::of("draco/AnimatedMorphCube.glb") };
        let (memory, read) = peak(|| damaged.read(&file.data));
        assert!(read.is_err() && memory < MOST_MEMORY, "{path} {value}: {memory} bytes");
    }
}

#[test]
fn uncompressed_data_is_read_where_a_primitive_has_both() {
    let mut fixture = Fixture::new();
    fixture.set("/extensionsUsed", json!([EXTENSION])).set("/extensionsRequired", json!([EXTENSION]));
    let object = json!({"bufferView": 0, "attributes": {"POSITION": 0}});
    fixture.set(&format!("/meshes/0/primitives/0/extensions/{EXTENSION}"), object);
    let read = |fixture: &Fixture| read("a.glb", &fixture.glb(), &NoFiles, &ReadOptions::default());
    let got = read(&fixture).expect("a model");
    assert_eq!(got.warnings, []);
    assert_eq!(got.model, read(&Fixture::new()).expect("a model").model);
}

#[test]
fn uncompressed_data_is_read_also_where_the_extension_beside_it_is_damaged() {
    let path = format!("/meshes/0/primitives/0/extensions/{EXTENSION}");
    let plain =
        read("a.glb", &Fixture::new().glb(), &NoFiles, &ReadOptions::default()).expect("a model").model;
    for object in [
        json!([]),
        json!({}),
        json!({"bufferView": 99, "attributes": {"POSITION": 0}}),
        json!({"bufferView": 0, "attributes": 3}),
        json!({"bufferView": 0, "attributes": {"POSITION": "first"}}),
    ] {
        let mut fixture = Fixture::new();
        fixture.set("/extensionsUsed", json!([EXTENSION])).set("/extensionsRequired", json!([EXTENSION]));
        fixture.set(&path, object.clone());
        let got = read("a.glb", &fixture.glb(), &NoFiles, &ReadOptions::default());
        assert_eq!(got.unwrap_or_else(|error| panic!("{object}: {error}")).model, plain);
    }
    // A strip, and a primitive without indices, cannot be compressed, but have data.
    for (member, value) in [("mode", json!(5)), ("indices", Value::Null)] {
        let with = |extension: bool| {
            let mut fixture = Fixture::new();
            let primitive = fixture.json.pointer_mut("/meshes/0/primitives/0").and_then(Value::as_object_mut);
            let primitive = primitive.expect("a primitive");
            match &value {
                Value::Null => drop(primitive.remove(member)),
                value => drop(primitive.insert(member.to_owned(), value.clone())),
            }
            if extension {
                fixture.set("/extensionsUsed", json!([EXTENSION]));
                fixture.set(&path, json!({"bufferView": 0, "attributes": {"POSITION": 0}}));
            }
            read("a.glb", &fixture.glb(), &NoFiles, &ReadOptions::default())
        };
        let (plain, got) = (with(false), with(true));
        let got = got.unwrap_or_else(|error| panic!("{member}: {error}"));
        assert_eq!(got.model, plain.expect("a model").model, "{member}");
    }
}
