//! A save over another file of the folder replaces none that the project needs, and reads models only where one of them could need it.

use super::project_moved::not_saved;
use super::projects::{END, MAIN, PROJECT, is_read, project, replaced_in, text_of};
use dragonfly_document::{Cancel, Change, Editable, SaveTo, Source};
use dragonfly_kit::document::test_document::TestDocument;
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
        let (reason, read) = listed(&editable, &folder.join(name));
        assert!(reason.is_some_and(|reason| reason.contains("choose another folder")), "{name}");
        assert_eq!(read, 0, "{name}");
    }
}

#[test]
fn a_project_gets_no_second_name_in_its_folder_under_which_its_scripts_would_be_changed() {
    let folder = Folder::new("two-names");
    let path = project(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.wait_for_view(is_read);
    document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    for to in [SaveTo::As(folder.join("v2.meproj")), SaveTo::Copy(folder.join("v3.meproj"))] {
        let reason = not_saved(&mut document, to);
        assert!(reason.contains("main.xml and 2 more files in common with foxes.meproj"), "{reason}");
        assert!(reason.contains("choose another folder"), "{reason}");
    }
    assert_eq!(fs::read_to_string(folder.join("end.xml")).expect("a text"), END);
    assert!(!folder.join("v2.meproj").exists() && !folder.join("v3.meproj").exists());
    // One that is gone shares nothing.
    fs::remove_file(&path).expect("the project");
    document.save(SaveTo::As(folder.join("v2.meproj")));
    assert_eq!(fs::read_to_string(folder.join("v2.meproj")).expect("a text"), PROJECT);
    assert!(fs::read_to_string(folder.join("end.xml")).expect("a text").contains("Fin"));
}

#[test]
fn the_history_of_a_project_goes_on_after_it_was_saved_in_another_folder_and_the_program_began_again() {
    let (folder, other) = (Folder::new("moved-history"), Folder::new("moved-history-there"));
    let autosave = folder.join("autosave");
    let mut document = TestDocument::new(&autosave);
    document.open(&project(&folder));
    document.wait_for_view(is_read);
    document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    // Under another name, too.
    document.save(SaveTo::As(other.join("wolves.meproj")));
    let end = END.replace("The End", "Fin");
    document.edit(replaced_in("end.xml", &end, "Fin", "Ende"));
    document.save(SaveTo::Own);
    document.end();

    let mut document = TestDocument::new(&autosave);
    let view = document.open(&other.join("wolves.meproj"));
    assert_eq!((view.history.done, view.history.saved), (2, true));
    document.change(Change::GoTo(0));
    let view = document.view();
    assert_eq!(text_of(&view, "end.xml"), END);
}

#[test]
fn a_save_over_a_file_that_is_no_scene_is_refused_where_a_model_needs_it() {
    let folder = Folder::new("over-points");
    project(&folder);
    // A script alone, which shares no other text.
    let prop = "<prop id=\"crate\" model=\"box.gltf\"/></cast>";
    let script = MAIN.replace("model=\"fox\"", "model=\"models/Fox.glb\"").replace("</cast>", prop);
    let path = folder.join("main.xml");
    fs::write(&path, script).expect("a file");
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
