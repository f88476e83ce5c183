//! Edits of a take cost what the take has, also with tens of thousands of bones.

use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{CreateTake, Edit};
use dragonfly_document::history::Edited;
use dragonfly_document::{Cancel, Editable, Source};
use dragonfly_kit::counting::peak;
use dragonfly_kit::folder::Folder;
use serde_json::{Value, json};

/// Returns a file with a skin of `count` joints, a hundred under each root.
fn rig(folder: &Folder, count: usize) -> Editable {
    let node = |node: usize| match node % 100 {
        0 => json!({"children": (node + 1..node + 100).collect::<Vec<_>>()}),
        _ => json!({}),
    };
    let nodes: Vec<Value> = (0..count).map(node).collect();
    let skins = json!([{"joints": (0..count).collect::<Vec<_>>()}]);
    let path = folder.join("rig.gltf");
    std::fs::write(&path, json!({"asset": {"version": "2.0"}, "nodes": nodes, "skins": skins}).to_string())
        .unwrap();
    Editable::open(&Source::File(path), &Cancel::default()).unwrap()
}

/// Returns the memory for creating a take and for planning its save.
fn memory_of_a_new_take(count: usize) -> (u64, u64) {
    let folder = Folder::new("many-bones");
    let rig = rig(&folder, count);
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
