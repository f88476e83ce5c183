//! Errors of the cast that the scripts of a project share have their places in the text of the project, in the window and in the protocol.

use super::projects::{END, PROJECT, is_read, project, replaced_in, text_of};
use super::scenes::{replaced, scene_of};
use dragonfly_document::protocol::Session;
use dragonfly_document::{Cancel, Editable, Source};
use dragonfly_kit::document::test_document::TestDocument;
use dragonfly_kit::folder::Folder;
use serde_json::Value;
use std::fs;

#[test]
fn an_error_of_the_shared_cast_has_its_place_in_the_project_and_the_scene_before_plays_on() {
    let folder = Folder::new("shared-error");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    let view = document.wait_for_view(is_read);
    assert!(scene_of(&view).is_current());
    document.edit(replaced(PROJECT, "look=\"0 1 0\"", "look=\"ann.Hed\""));
    let view = document.wait_for_view(|view| view.history.done == 1);
    let scene = scene_of(&view);
    assert!(scene.errors.is_empty() && scene.project_errors.is_empty() && !scene.is_current());
    let [error] = &*scene.shared_errors else { panic!("{:?}", scene.shared_errors) };
    let text = text_of(&view, "foxes.meproj");
    assert_eq!((&text[error.range.clone()], error.place.line), ("ann.Hed", 7));
    assert!(scene.plan.is_some(), "the scene before");
    document.edit(replaced(&text, "ann.Hed", "ann"));
    let view = document.wait_for_view(|view| view.history.done == 2);
    assert!(scene_of(&view).is_current());
}

#[test]
fn a_missing_model_of_the_shared_cast_is_a_note_in_the_project() {
    let folder = Folder::new("shared-missing");
    let path = project(&folder);
    let cup = "<prop id=\"cup\" model=\"cup.glb\"/>\n  </cast>";
    fs::write(&path, PROJECT.replace("</cast>", cup)).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let view = document.wait_for_view(|view| !scene_of(view).project_notes.is_empty());
    let scene = scene_of(&view);
    let text = text_of(&view, "foxes.meproj");
    assert_eq!((&text[scene.project_notes[0].range.clone()], scene.notes.len()), ("cup.glb", 0));
}

#[test]
fn the_protocol_lists_what_is_wrong_in_each_text_of_a_project() {
    let folder = Folder::new("shared-protocol");
    let path = project(&folder);
    fs::write(&path, PROJECT.replace("look=\"0 1 0\"", "look=\"ann.Hed\"")).expect("a file");
    fs::write(folder.join("end.xml"), END.replace("dur=\"2\"", "dur=\"two\"")).expect("a file");
    let editable = Editable::open(&Source::File(path), &Cancel::default()).expect("a project");
    let mut session = Session::new(editable);
    let answer = session.answer(r#"{"query":"errors"}"#).expect("an answer");
    let answer: Value = serde_json::from_str(&answer).expect("JSON");
    let texts = answer["ok"]["texts"].as_array().expect("a list");
    let place = |name: &str| {
        let text = texts.iter().find(|text| text["text"] == name).expect(name);
        text["errors"]
            .as_array()
            .expect("a list")
            .iter()
            .map(|error| error["line"].clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(
        (place("foxes.meproj"), place("main.xml"), place("end.xml")),
        (vec![7.into()], vec![], vec![2.into()])
    );
    // Of an edited script, too.
    let Value::Object(edit) =
        serde_json::to_value(replaced_in("main.xml", super::projects::MAIN, "way", "wey")).expect("JSON")
    else {
        panic!("an edit is an object")
    };
    session.answer(&Value::Object(edit).to_string()).expect("an answer");
    let answer = session.answer(r#"{"query":"errors"}"#).expect("an answer");
    assert!(answer.contains("no path") || answer.contains("wey") || answer.contains("way"), "{answer}");
}
