//! Edits of a take cost what the take has, also with tens of thousands of bones.

use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::{CreateTake, Edit};
use dragonfly_document::history::Edited;
use dragonfly_document::{Cancel, Editable, Source};
use dragonfly_kit::folder::Folder;
use serde_json::json;
use std::time::Instant;

#[test]
fn a_take_of_many_bones_is_created_and_saved() {
    let scratch = Folder::new("many-bones");
    let path = scratch.join("many.gltf");
    let count = 60_000;
    let nodes: Vec<_> = (0..count)
        .map(|node| match node % 100 {
            0 => json!({"name": format!("b{node}"), "children": (node + 1..node + 100).collect::<Vec<_>>()}),
            _ => json!({"name": format!("b{node}")}),
        })
        .collect();
    let json = json!({"asset": {"version": "2.0"}, "nodes": nodes,
        "skins": [{"joints": (0..count).collect::<Vec<_>>()}]});
    std::fs::write(&path, json.to_string()).unwrap();
    let start = Instant::now();
    let editable = Editable::open(&Source::File(path), &Cancel::default()).unwrap();
    println!("open {:?}", start.elapsed());
    let mut edited = Edited::new(ModelAdapter::new(&editable.model.animation));
    let create = CreateTake { name: "all".to_owned(), copy: None, at: None };
    let start = Instant::now();
    edited.ask(Edit::CreateTake(create), None).unwrap();
    println!("create {:?}", start.elapsed());
    let start = Instant::now();
    let plan = editable.plan(edited.adapter()).unwrap();
    println!("plan {:?}", start.elapsed());
    assert!(!plan.files.is_empty());
}
