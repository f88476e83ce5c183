//! A save over another file of the folder replaces none that the project needs, and reads models only where one of them could need it.

use super::projects::{MAIN, PROJECT, project};
use dragonfly_document::{Cancel, Editable, Source};
use dragonfly_kit::folder::Folder;
use std::cell::Cell;
use std::fs;
use std::path::Path;

/// A model whose points are in a file with the ending of a script.
const BOX: &str = r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"points.xml","byteLength":36}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
    "min":[0,0,0],"max":[1,1,0]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],
    "scenes":[{"nodes":[0]}],"scene":0}"#;

/// Lists the files of a save as `output`. Returns why it is refused, if it is, and how often a model was read.
fn listed(editable: &Editable, output: &Path) -> (Option<String>, usize) {
    let plan = editable.plan(&editable.adapter()).expect("a plan");
    let read = Cell::new(0);
    let progress = |_: f32| read.set(read.get() + 1);
    let files = editable.files(&plan, output, &Cancel::default(), &progress);
    (files.err(), read.get())
}

#[test]
fn a_save_over_another_project_of_the_folder_reads_no_model() {
    let folder = Folder::new("over-project");
    let editable = Editable::open(&Source::File(project(&folder)), &Cancel::default()).expect("a project");
    for (name, text) in [("other.meproj", PROJECT), ("other.xml", MAIN)] {
        fs::write(folder.join(name), text).expect("a file");
        assert_eq!(listed(&editable, &folder.join(name)), (None, 0), "{name}");
    }
    let (reason, read) = listed(&editable, &folder.join("end.xml"));
    assert!(reason.is_some_and(|reason| reason.contains("another name")), "the project names it");
    assert_eq!(read, 0);
}

#[test]
fn a_save_over_a_file_that_is_no_scene_is_refused_where_a_model_needs_it() {
    let folder = Folder::new("over-points");
    let path = project(&folder);
    let prop = "<prop id=\"crate\" model=\"box.gltf\"/></cast>";
    fs::write(folder.join("main.xml"), MAIN.replace("</cast>", prop)).expect("a file");
    fs::write(folder.join("box.gltf"), BOX).expect("a file");
    let points = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes).concat();
    for name in ["points.xml", "other.xml"] {
        fs::write(folder.join(name), &points).expect("a file");
    }
    let editable = Editable::open(&Source::File(path), &Cancel::default()).expect("a project");
    let (reason, read) = listed(&editable, &folder.join("points.xml"));
    assert!(reason.is_some_and(|reason| reason.contains("points.xml")), "the box needs it");
    assert_eq!((read, listed(&editable, &folder.join("other.xml"))), (2, (None, 2)), "two models were read");
}
