//! Takes of other files become takes of the open model: in one step, in a job, and in the journal.

use dragonfly_document::{BoneMap, Change, ClipOrder, Decision, DocumentMessage, DocumentReply, View};
use dragonfly_kit::document::test_document::{TestDocument, fox};
use dragonfly_kit::folder::{Folder, data};
use std::fs;
use std::path::PathBuf;

fn names(view: &View) -> Vec<String> {
    view.takes.iter().map(|take| take.name.clone()).collect()
}

fn notice(reply: &DocumentReply) -> Option<String> {
    match reply {
        DocumentReply::Notice(text) if !text.starts_with("Importing") => Some(text.clone()),
        DocumentReply::Warning(text) | DocumentReply::Refused(text) => Some(text.clone()),
        _ => None,
    }
}

/// Writes Fox under other names, as if its takes were files of their own.
fn clips(folder: &Folder, count: usize) -> Vec<PathBuf> {
    let paths: Vec<PathBuf> = (0..count).map(|number| folder.join(&format!("clip{number}.glb"))).collect();
    for path in &paths {
        fs::copy(data("gltf/Fox.glb"), path).expect("a copy");
    }
    paths
}

#[test]
fn takes_of_several_files_are_added_in_one_step_that_can_be_undone() {
    let folder = Folder::new("import-takes");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&fox(&folder));
    document.send(DocumentMessage::ImportTakes(ClipOrder::of(clips(&folder, 2))));
    let view = document.wait_for_view(|view| view.history.done == 1);
    assert_eq!(
        names(&view),
        ["Survey", "Walk", "Run", "Survey 2", "Walk 2", "Run 2", "Survey 3", "Walk 3", "Run 3"]
    );
    assert_eq!(view.takes[3].tracks, view.takes[0].tracks, "the same skeleton: keys are copied");
    assert_eq!(document.wait_for_reply(notice), "Added 6 takes of 2 files");
    document.change(Change::Undo);
    assert_eq!(names(&document.wait_for_view(|view| view.history.done == 0)), ["Survey", "Walk", "Run"]);
}

#[test]
fn a_file_that_cannot_be_imported_is_reported_and_the_others_are_added() {
    let folder = Folder::new("import-broken");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&fox(&folder));
    let mut files = clips(&folder, 1);
    let (broken, still) = (folder.join("broken.glb"), folder.join("still.glb"));
    fs::write(&broken, b"glTF").expect("a file");
    fs::copy(data("gltf/box_sparse.glb"), &still).expect("a copy");
    files.insert(0, broken);
    document.send(DocumentMessage::ImportTakes(ClipOrder::of(files)));
    assert_eq!(document.wait_for_view(|view| view.history.done == 1).takes.len(), 6);
    assert!(document.wait_for_reply(notice).starts_with("broken.glb"));
    // If nothing fits, nothing changes.
    document.send(DocumentMessage::ImportTakes(ClipOrder::of(vec![still])));
    assert!(document.wait_for_reply(notice).starts_with("still.glb"));
    assert_eq!(document.view().history.done, 1);
}

#[test]
fn imported_takes_are_in_the_journal() {
    let folder = Folder::new("import-journal");
    let path = fox(&folder);
    let autosave = folder.join("autosave");
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.send(DocumentMessage::ImportTakes(ClipOrder::of(clips(&folder, 1))));
    let view = document.wait_for_view(|view| view.history.done == 1);
    drop(document);
    let mut again = TestDocument::new(&autosave);
    again.open(&path);
    let offer = again.wait_for_offers().remove(0);
    again.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    let restored = again.wait_for_view(|view| view.history.done == 1);
    assert_eq!(restored.takes, view.takes);
}

#[test]
fn files_are_imported_with_the_map_of_the_user() {
    let folder = Folder::new("import-mapped");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let before = document.open(&fox(&folder));
    let turned = |view: &View, take: usize| {
        let bones = &view.loaded.model.animation.skeleton.bones;
        let tracks = view.takes[take].tracks.iter().filter(|track| !track.is_empty());
        tracks.map(|track| bones[track.bone as usize].name.clone()).collect::<Vec<_>>()
    };
    assert!(turned(&before, 1).len() > 10);
    // The head alone follows, and it follows the neck.
    let map = r#"{"bone_map": 1, "bones": [["b_Neck_04", "b_Head_05"]]}"#;
    let map = BoneMap::parse(map).expect("a map");
    let order = ClipOrder { map: Some(map), contacts: false, ..ClipOrder::of(clips(&folder, 2)) };
    document.send(DocumentMessage::ImportTakes(order));
    let view = document.wait_for_view(|view| view.history.done == 1);
    assert_eq!(view.takes.len(), 9);
    for take in 3..9 {
        assert_eq!(turned(&view, take), ["b_Head_05"], "{}", view.takes[take].name);
    }
    assert!(document.wait_for_reply(notice).contains("no bone follows"), "the others are named");
}

#[test]
fn a_take_of_a_capture_is_named_after_its_file_and_what_was_done_is_said_last() {
    let folder = Folder::new("import-capture");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&fox(&folder));
    let capture = folder.join("Sneak around.bvh");
    let text = "HIERARCHY ROOT b_Hip_01 { OFFSET 0 0 0 CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation \
                JOINT b_Spine01_02 { OFFSET 0 1 0 CHANNELS 3 Zrotation Yrotation Xrotation End Site { OFFSET 0 1 0 } } } \
                MOTION Frames: 2 Frame Time: 0.1 0 1 0 0 0 0 0 0 0 0 1 2 0 90 0 0 0 30";
    fs::write(&capture, text).expect("a file");
    document.send(DocumentMessage::ImportTakes(ClipOrder::of(vec![capture])));
    // The status line shows the last message: the view comes before the summary, not after it.
    let mut is_shown = false;
    let (text, was_shown) = document.wait_for_reply(|reply| {
        is_shown |= matches!(reply, DocumentReply::View(view) if view.history.done == 1);
        notice(reply).map(|text| (text, is_shown))
    });
    assert!(text.starts_with("Added Sneak around") && was_shown, "{text} {was_shown}");
    assert_eq!(names(&document.view())[3], "Sneak around");
}
