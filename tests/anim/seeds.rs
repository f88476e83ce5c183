//! Small valid files, one for each feature: the starting point of damaged files.

use crate::doors::data;
use crate::fixture::Fixture;
use serde_json::{Value, json};

/// A valid file.
pub(crate) struct Seed {
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
}

/// Returns a document without content.
fn bare(members: Value) -> Fixture {
    let mut json = json!({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 0}], "bufferViews": [],
                          "accessors": [], "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}]});
    for (name, value) in members.as_object().unwrap() {
        json[name] = value.clone();
    }
    Fixture { json, bin: Vec::new() }
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

const TRIANGLE: [f32; 9] = [0., 0., 0., 1., 0., 0., 0., 1., 0.];

/// Returns a triangle with the given members in its primitive.
fn triangle(primitive: Value) -> Fixture {
    let mut fixture = bare(json!({"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]}));
    fixture.accessor("VEC3", 5126, 3, &floats(&TRIANGLE));
    for (name, value) in primitive.as_object().unwrap() {
        fixture.set(&format!("/meshes/0/primitives/0/{name}"), value.clone());
    }
    fixture
}

/// Returns a node that one channel animates.
fn animated(path: &str, interpolation: &str, shape: &str, values: &[f32]) -> Fixture {
    let mut fixture = bare(json!({"nodes": [{}], "animations": [{
        "samplers": [{"input": 0, "output": 1, "interpolation": interpolation}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}]}]}));
    fixture.accessor("SCALAR", 5126, 2, &floats(&[0., 1.]));
    let width = if shape == "VEC3" { 3 } else { 4 };
    fixture.accessor(shape, 5126, values.len() / width, &floats(values));
    fixture
}

fn skinned() -> Fixture {
    let mut fixture = triangle(json!({"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}));
    fixture.accessor("VEC4", 5121, 3, &[0, 1, 0, 0].repeat(3));
    fixture.accessor("VEC4", 5121, 3, &[200, 55, 0, 0].repeat(3));
    fixture.set("/accessors/2/normalized", json!(true));
    fixture.set("/nodes", json!([{"mesh": 0, "skin": 0}, {"children": [2]}, {"translation": [0, 1, 0]}]));
    fixture.set("/skins", json!([{"joints": [1, 2]}]));
    fixture
}

fn morphed() -> Fixture {
    let mut fixture = triangle(json!({"targets": [{"POSITION": 1}]}));
    let indices = fixture.view(&[2]);
    let values = fixture.view(&floats(&[1., 2., 3.]));
    fixture.set(
        "/accessors/1",
        json!({"componentType": 5126, "type": "VEC3", "count": 3, "sparse": {"count": 1,
        "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}}}),
    );
    fixture.set("/meshes/0/weights", json!([0.5]));
    fixture
}

fn quantized() -> Fixture {
    let mut fixture = triangle(json!({}));
    let shorts: Vec<u8> = [0i16, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0].map(i16::to_le_bytes).concat();
    let view = fixture.view(&shorts);
    fixture.set(&format!("/bufferViews/{view}/byteStride"), json!(8));
    fixture.set(
        "/accessors/0",
        json!({"bufferView": view, "componentType": 5122, "normalized": true,
                                       "type": "VEC3", "count": 3}),
    );
    fixture.set("/extensionsRequired", json!(["KHR_mesh_quantization"]));
    fixture
}

fn textured() -> Fixture {
    let mut fixture = triangle(json!({"material": 0}));
    let view = fixture.view(&crate::fixture::png(1, 1));
    fixture.set("/images", json!([{"bufferView": view, "mimeType": "image/png"}]));
    fixture.set("/textures", json!([{"source": 0}]));
    fixture.set(
        "/materials",
        json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {
        "KHR_texture_transform": {"offset": [0.5, 0], "rotation": 1, "scale": [2, 2], "texCoord": 1}}}},
        "normalTexture": {"index": 0, "scale": 0.5}, "extensions": {"KHR_materials_unlit": {}}}]),
    );
    fixture
}

fn indexed(mode: u32) -> Fixture {
    let mut fixture = triangle(json!({"indices": 1, "mode": mode}));
    fixture.accessor("SCALAR", 5121, 4, &[0, 1, 2, 0]);
    fixture
}

/// Returns each feature alone, and all of them together.
fn fixtures() -> Vec<(&'static str, Fixture)> {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turn = [0., 0., 0., 1., 0., 0., half, half];
    let spline: Vec<f32> = (0..18).map(|n| n as f32 / 8.).collect();
    vec![
        ("all", Fixture::new()),
        ("nothing", bare(json!({"scenes": [], "nodes": []}))),
        ("triangle", triangle(json!({}))),
        ("list", {
            let mut list = indexed(4);
            list.set("/accessors/1/count", json!(3));
            list
        }),
        ("strip", indexed(5)),
        ("fan", indexed(6)),
        ("lines", indexed(1)),
        ("skinned", skinned()),
        ("morphed", morphed()),
        ("quantized", quantized()),
        ("textured", textured()),
        ("turning", animated("rotation", "LINEAR", "VEC4", &turn)),
        ("stepping", animated("translation", "STEP", "VEC3", &TRIANGLE[..6])),
        ("growing", animated("scale", "CUBICSPLINE", "VEC3", &spline)),
        ("pointing", {
            let mut odd = animated("pointer", "LINEAR", "VEC4", &turn);
            odd.remove("/animations/0/channels/0/target/node");
            odd
        }),
        (
            "tree",
            bare(json!({"scene": 1, "scenes": [{}, {"name": "b", "nodes": [0, 3]}], "nodes": [
            {"children": [1, 2], "matrix": [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, -2, 0, 1, 2, 3, 1]},
            {"scale": [-1, 1, 1]}, {"rotation": [0, 0.6, 0, 0.8]}, {"translation": [1, 2, 3], "extras": {"a": [1]}}]})),
        ),
    ]
}

/// Returns every seed: each fixture in both containers, and the files in `tests/data`.
pub(crate) fn seeds() -> Vec<Seed> {
    let mut seeds = Vec::new();
    for (name, fixture) in fixtures() {
        seeds.push(Seed { name: format!("{name}.glb"), bytes: fixture.glb() });
        seeds.push(Seed { name: format!("{name}.gltf"), bytes: fixture.gltf() });
    }
    let mut paths: Vec<_> =
        std::fs::read_dir(data().join("gltf")).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let is_model =
        |path: &std::path::Path| path.extension().is_some_and(|ending| ending == "gltf" || ending == "glb");
    for path in paths.into_iter().filter(|path| is_model(path)) {
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        seeds.push(Seed { name, bytes: std::fs::read(path).unwrap() });
    }
    seeds
}

#[test]
fn every_seed_is_read_and_sound() {
    let seeds = seeds();
    assert!(seeds.len() >= 30);
    for seed in seeds {
        let answer = crate::trial::trial(&seed.name, &seed.bytes, &Default::default());
        assert_eq!(answer, Ok(true), "{} of {} bytes", seed.name, seed.bytes.len());
    }
}
