//! Edits of a take cost what the take has, also with tens of thousands of bones.

use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{CreateTake, Edit};
use dragonfly_document::history::Edited;
use dragonfly_document::{Cancel, Editable, Source};
use dragonfly_kit::counting::peak;
use dragonfly_kit::folder::Folder;
use serde_json::{Value, json};

/// Returns a file with skins of at most 30,000 of `count` joints, a hundred under each root. If `is_animated`, it has a take with one
/// key already.
fn rig(folder: &Folder, count: usize, is_animated: bool) -> Editable {
    let node = |node: usize| match node % 100 {
        0 => json!({"children": (node + 1..node + 100).collect::<Vec<_>>()}),
        _ => json!({}),
    };
    let nodes: Vec<Value> = (0..count).map(node).collect();
    let joints: Vec<usize> = (0..count).collect();
    let skins: Vec<Value> = joints.chunks(30_000).map(|joints| json!({"joints": joints})).collect();
    let mut file = json!({"asset": {"version": "2.0"}, "nodes": nodes, "skins": skins});
    if is_animated {
        file["buffers"] = json!([{"byteLength": 16, "uri": "data:;base64,AAAAAAAAAAAAAAAAAAAAAA=="}]);
        file["bufferViews"] = json!([{"buffer": 0, "byteLength": 16}]);
        file["accessors"] = json!([
            {"bufferView": 0, "componentType": 5126, "count": 1, "type": "SCALAR", "min": [0], "max": [0]},
            {"bufferView": 0, "componentType": 5126, "count": 1, "type": "VEC3"},
        ]);
        let target = json!({"node": 0, "path": "translation"});
        let (channel, sampler) = (json!({"sampler": 0, "target": target}), json!({"input": 0, "output": 1}));
        file["animations"] = json!([{"channels": [channel], "samplers": [sampler]}]);
    }
    let path = folder.join("rig.gltf");
    std::fs::write(&path, file.to_string()).unwrap();
    Editable::open(&Source::File(path), &Cancel::default()).unwrap()
}

/// Returns the memory for creating a take and for planning its save.
fn memory_of_a_new_take(count: usize) -> (u64, u64) {
    let folder = Folder::new("many-bones");
    let rig = rig(&folder, count, false);
    let mut edited = Edited::new(ModelAdapter::new(&rig.model.animation));
    let create = CreateTake { name: "all".to_owned(), copy: None, at: None };
    let (created, done) = peak(|| edited.ask(Edit::CreateTake(create), None));
    done.unwrap();
    assert_eq!(edited.adapter().slots()[0].original.keys(), 3 * count);
    let (planned, plan) = peak(|| rig.plan(edited.adapter()));
    assert!(!plan.unwrap().files.is_empty());
    (created, planned)
}

#[test]
fn the_memory_for_a_new_take_grows_with_the_bones_and_not_faster() {
    let (few, many) = (memory_of_a_new_take(2_000), memory_of_a_new_take(20_000));
    println!("2,000 bones: {few:?} bytes, 20,000 bones: {many:?} bytes");
    assert!(many.0 < 11 * few.0 && many.0 < 20_000 * 1_024, "{few:?} {many:?}");
    assert!(many.1 < 14 * few.1, "{few:?} {many:?}");
}

#[test]
fn the_channels_of_all_bones_are_saved_within_the_memory_of_their_file() {
    for is_animated in [false, true] {
        let folder = Folder::new("many-bones-saved");
        let rig = rig(&folder, 60_000, is_animated);
        let mut edited = Edited::new(ModelAdapter::new(&rig.model.animation));
        let create = CreateTake { name: "all".to_owned(), copy: None, at: None };
        edited.ask(Edit::CreateTake(create), None).unwrap();
        let file = std::fs::metadata(folder.join("rig.gltf")).unwrap().len();
        let (memory, plan) = peak(|| rig.plan(edited.adapter()));
        let promise = (256 << 20) + 32 * file;
        let written = plan.unwrap().files[0].bytes.len();
        println!("{memory} bytes of {promise} for {written} bytes");
        assert!(memory <= promise, "{memory} of {promise}");
    }
}
