//! A scene that waits while one of its models is edited: each of both has its own saved state.

use super::projects::{is_read, project};
use dragonfly_document::edit::ScriptLabel;
use dragonfly_document::{DocumentMessage, SaveTo, View};
use dragonfly_kit::document::test_document::{TestDocument, rename};
use dragonfly_kit::folder::Folder;

/// Opens the model of the scene, and waits for it.
fn enter(document: &mut TestDocument) -> View {
    document.send(DocumentMessage::EditModel("fox".to_owned()));
    document.wait_for_view(|view| view.waiting_scene.is_some())
}

/// Returns whether the model is saved, and whether the scene is.
fn saved(view: &View) -> [bool; 2] {
    [view.history.saved, view.waiting_scene.as_ref().expect("a scene that waits").saved]
}

#[test]
fn the_unsaved_work_of_a_model_is_counted_apart_from_that_of_the_scene_in_which_it_is_edited() {
    let folder = Folder::new("waiting-scene");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    document.wait_for_view(is_read);
    let view = enter(&mut document);
    assert_eq!(saved(&view), [true, true]);
    assert_eq!(view.waiting_scene.expect("a scene").title.as_ref(), "foxes.meproj");
    document.edit(rename("Look around"));
    let view = document.wait_for_view(|view| !view.history.saved);
    assert_eq!(saved(&view), [false, true], "the scene has not changed");
    // The project keeps the edit, and is unsaved with it.
    document.send(DocumentMessage::ShowScene);
    let view = document.wait_for_view(|view| view.scene.is_some());
    assert!(!view.history.saved && view.history.has_unsaved_step(ScriptLabel::EditModel.text()));
    assert_eq!(saved(&enter(&mut document)), [true, false], "the project has the edit of the model");
    document.edit(rename("Look about"));
    let view = document.wait_for_view(|view| !view.history.saved);
    assert_eq!(saved(&view), [false, false]);
    document.save(SaveTo::Own);
    let view = document.wait_for_view(|view| view.history.saved);
    assert_eq!(saved(&view), [true, false], "the file of the model has both edits");
}
