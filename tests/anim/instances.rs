//! A mesh that a small file places very often costs what the file costs, not what its vertices cost.

use crate::doors::MemoryFs;
use crate::fixture::Fixture;
use dragonfly_anim::bounds::AxisBox;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::format::{ImportError, ReadOptions, read};
use dragonfly_anim::hit::HitTree;
use dragonfly_kit::counting::peak;
use glam::Vec3;
use serde_json::{Value, json};
use std::sync::Arc;

/// Memory that measuring such a model may take.
const MOST_MEMORY: u64 = 32 << 20;

fn imported(bytes: &[u8]) -> ModelData {
    read("forest.glb", bytes, &MemoryFs::default(), &ReadOptions::default()).unwrap().model
}

/// A file with one mesh of `vertices` vertices, without data, in each of `count` nodes.
fn empty_mesh(vertices: usize, count: usize, primitives: usize) -> Vec<u8> {
    let primitives: Vec<Value> = (0..primitives).map(|_| json!({"attributes": {"POSITION": 0}})).collect();
    let nodes: Vec<Value> = (0..count).map(|_| json!({"mesh": 0})).collect();
    json!({
        "asset": {"version": "2.0"},
        "accessors": [{"componentType": 5126, "count": vertices, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}],
        "meshes": [{"primitives": primitives}],
        "nodes": nodes,
        "scenes": [{"nodes": (0..count).collect::<Vec<_>>()}],
    })
    .to_string()
    .into_bytes()
}

/// A forest: one tree of `vertices` vertices in the unit cube, `count` times, a step of two apart along x.
fn forest(vertices: usize, count: usize) -> Vec<u8> {
    let mut fixture = Fixture::new();
    let place = |vertex: usize| [vertex % 2, vertex / 2 % 2, vertex / 4 % 2].map(|axis| axis as f32);
    let positions: Vec<u8> = (0..vertices).flat_map(place).flat_map(|number| number.to_le_bytes()).collect();
    let accessor = fixture.accessor("VEC3", 5126, vertices, &positions);
    let nodes: Vec<Value> =
        (0..count).map(|node| json!({"mesh": 0, "translation": [2 * node, 0, 0]})).collect();
    fixture
        .set("/meshes", json!([{"primitives": [{"attributes": {"POSITION": accessor}}]}]))
        .set("/skins", json!([]))
        .set("/animations", json!([]))
        .set("/nodes", json!(nodes))
        .set("/scenes", json!([{"nodes": (0..count).collect::<Vec<_>>()}]))
        .set("/scene", json!(0));
    fixture.glb()
}

#[test]
fn a_mesh_placed_three_thousand_times_is_measured_with_the_memory_of_one() {
    let model = Arc::new(imported(&empty_mesh(65_536, 3_000, 1)));
    let (memory, bounds) = peak(|| Evaluator::new(Arc::clone(&model)).bounds());
    assert!(memory < MOST_MEMORY, "{memory} bytes");
    assert!(bounds.sphere.radius < 1e-6);
    let (memory, points) = peak(|| Evaluator::new(Arc::clone(&model)).outline());
    assert!(memory < MOST_MEMORY, "{memory} bytes");
    assert_eq!(points.len(), 3_000 * 8);
}

#[test]
fn the_box_of_a_forest_is_that_of_its_trees() {
    let model = Arc::new(imported(&forest(100_000, 2_000)));
    let (memory, bounds) = peak(|| Evaluator::new(Arc::clone(&model)).bounds());
    assert!(memory < MOST_MEMORY, "{memory} bytes");
    let exact = AxisBox { min: Vec3::ZERO, max: Vec3::new(2.0 * 1_999.0 + 1.0, 1.0, 1.0) };
    assert!(bounds.contains(exact.min) && bounds.contains(exact.max));
    assert!(
        (bounds.min - exact.min).length() < 0.02 && (bounds.max - exact.max).length() < 0.02,
        "{bounds:?}"
    );
    for corner in exact.corners() {
        assert!(bounds.sphere.contains(corner), "{corner} {bounds:?}");
    }
    assert!(bounds.sphere.radius < 2_000.1, "{bounds:?}");
}

#[test]
fn a_few_trees_are_measured_on_their_vertices() {
    let bounds = Evaluator::new(Arc::new(imported(&forest(1_000, 3)))).bounds();
    assert_eq!((bounds.min, bounds.max), (Vec3::ZERO, Vec3::new(5.0, 1.0, 1.0)));
}

#[test]
fn a_skinned_mesh_placed_often_is_measured_once() {
    let mut fixture = Fixture::new();
    let skinned = fixture.json["nodes"].as_array().unwrap().iter().find(|node| node["skin"].is_number());
    let node = json!({"mesh": skinned.unwrap()["mesh"], "skin": skinned.unwrap()["skin"]});
    let first = fixture.json["nodes"].as_array().unwrap().len();
    let once = Evaluator::new(Arc::new(imported(&fixture.glb()))).bounds();
    let count = 300_000;
    fixture.json["nodes"].as_array_mut().unwrap().extend((0..count).map(|_| node.clone()));
    let roots: Vec<usize> = (first..first + count).collect();
    fixture.json["scenes"][0]["nodes"].as_array_mut().unwrap().extend(roots.into_iter().map(Value::from));
    let often = Evaluator::new(Arc::new(imported(&fixture.glb()))).bounds();
    assert!(often.min.cmple(once.min).all() && often.max.cmpge(once.max).all(), "{once:?} {often:?}");
    assert!(often.sphere.radius < once.sphere.radius * 2.0, "{once:?} {often:?}");
}

#[test]
fn many_meshes_in_many_nodes_that_no_machine_could_draw_are_refused() {
    let bytes = empty_mesh(4, 4_000, 4_000);
    let (memory, result) =
        peak(|| read("a.gltf", &bytes, &MemoryFs::default(), &ReadOptions::default()).map(|_| ()));
    assert!(matches!(result, Err(ImportError::TooLarge { .. })), "{result:?}");
    assert!(memory < (256 << 20) + 32 * bytes.len() as u64, "{memory} bytes");
}

/// Returns the model with more vertices in every primitive, which no triangle uses.
fn with_unused_vertices(model: &ModelData, more: usize) -> ModelData {
    let mut model = model.clone();
    for primitive in model.meshes.iter_mut().flat_map(|mesh| &mut mesh.primitives) {
        let vertices = &mut primitive.vertices;
        assert!(primitive.morph_targets.is_empty());
        let influences = vertices.influences_per_vertex * more;
        vertices.positions.resize(vertices.positions.len() + more, Vec3::splat(1e3));
        vertices.influences.resize(vertices.influences.len() + influences, Default::default());
    }
    model
}

#[test]
fn vertices_that_no_triangle_uses_change_nothing_in_a_hit_tree_and_need_no_memory() {
    let fox = crate::made::fox();
    let tree = HitTree::of(&fox).unwrap();
    let more = with_unused_vertices(&fox, 20_000);
    assert_eq!(HitTree::of(&more).unwrap().parts(), tree.parts());
    let memory = |model: &ModelData| {
        let (copy, _) = peak(|| model.clone());
        peak(|| HitTree::of(model).map(|_| ())).0 - copy
    };
    let (few, many) = (memory(&fox), memory(&with_unused_vertices(&fox, 1_000_000)));
    assert!(many < few + 1_000_000, "{few} {many}");
}

#[test]
fn a_hit_tree_over_few_triangles_does_not_pose_the_other_vertices() {
    let mut bytes: Value = serde_json::from_slice(&empty_mesh(65_536, 3_000, 1)).unwrap();
    bytes["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"componentType": 5123, "count": 3, "type": "SCALAR"}));
    bytes["meshes"][0]["primitives"][0]["indices"] = json!(1);
    let model = imported(bytes.to_string().as_bytes());
    let (memory, tree) = peak(|| HitTree::of(&model).map(|tree| tree.parts().triangles.len()));
    assert_eq!(tree, Ok(3_000));
    assert!(memory < MOST_MEMORY, "{memory} bytes");
}
