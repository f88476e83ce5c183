//! The work on a script is in the journal before it is shown, and comes back after a kill.

use super::scene_models_later::asks_to_quit;
use super::scenes::{SCENE, replaced, scene, scene_of};
use dragonfly_document::{Change, Decision, DocumentMessage, SaveTo, View};
use dragonfly_kit::document::test_document::{TestDocument, copy_after_kill};
use dragonfly_kit::folder::Folder;
use std::fs;
use std::path::Path;

/// Opens the script after a kill, with a copy of the journals, and restores the offered work.
pub(super) fn restored(path: &Path, autosave: &Path, steps: usize) -> (TestDocument, View) {
    let mut document = TestDocument::new(autosave);
    document.open(path);
    let offer = document.wait_for_offers().remove(0);
    assert_eq!((offer.steps, offer.title.as_str()), (steps, "scene.xml"));
    document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    let view = document.wait_for_view(|view| view.history.done > 0 || !view.history.saved);
    (document, view)
}

#[test]
fn a_script_with_an_error_is_asked_about_until_it_is_saved_as_it_was_typed() {
    let folder = Folder::new("scene-error-kept");
    let path = scene(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.edit(replaced(SCENE, "</cast>", "</cas>"));
    let view = document.wait_for_view(|view| view.history.done == 1);
    let error = scene_of(&view).first_error().expect("an error");
    assert!(error.starts_with("scene.xml:7:"), "{error}");
    assert!(!asks_to_quit(&mut document), "it is not saved");
    document.save(SaveTo::Own);
    assert!(asks_to_quit(&mut document), "nothing is lost");
    assert_eq!(fs::read_to_string(&path).expect("a file"), SCENE.replace("</cast>", "</cas>"));
}

#[test]
fn unsaved_edits_of_a_script_come_back_after_a_kill_with_their_history() {
    let folder = Folder::new("scene-kill");
    let path = scene(&folder);
    let autosave = folder.join("autosave");
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.edit(replaced(SCENE, "Walk", "Run"));
    document.edit(replaced(&SCENE.replace("Walk", "Run"), "Füchse", "Ein Fuchs"));
    let before = document.wait_for_view(|view| view.history.done == 2);
    copy_after_kill(&autosave, &folder.join("killed"));
    let (mut again, view) = restored(&path, &folder.join("killed"), 2);
    assert_eq!(scene_of(&view).text, scene_of(&before).text);
    assert_eq!(view.history.steps, before.history.steps);
    again.change(Change::GoTo(0));
    assert_eq!(&*scene_of(&again.wait_for_view(|view| view.history.done == 0)).text, SCENE);
}

#[test]
fn edits_after_a_save_come_back_after_a_kill_and_undo_leads_to_the_text_before_the_save() {
    let folder = Folder::new("scene-kill-saved");
    let path = scene(&folder);
    let autosave = folder.join("autosave");
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.edit(replaced(SCENE, "Walk", "Run"));
    document.save(SaveTo::Own);
    document.edit(replaced(&SCENE.replace("Walk", "Run"), "Roll", "Jump"));
    document.wait_for_view(|view| view.history.done == 2);
    copy_after_kill(&autosave, &folder.join("killed"));
    let (mut again, view) = restored(&path, &folder.join("killed"), 1);
    assert_eq!(*scene_of(&view).text, *SCENE.replace("Walk", "Run").replace("Roll", "Jump"));
    again.change(Change::GoTo(1));
    let saved = again.wait_for_view(|view| view.history.done == 1);
    assert!(saved.history.saved && *scene_of(&saved).text == *fs::read_to_string(&path).expect("a file"));
    again.change(Change::Undo);
    assert_eq!(&*scene_of(&again.wait_for_view(|view| view.history.done == 0)).text, SCENE);
}

#[test]
fn a_document_that_ended_in_order_offers_nothing_and_keeps_the_history_of_its_text() {
    let folder = Folder::new("scene-ended");
    let path = scene(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.edit(replaced(SCENE, "Walk", "Run"));
    document.save(SaveTo::Own);
    document.end();
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let view = document.wait_for_view(|view| view.history.done == 1);
    assert!(view.history.saved && document.offers_so_far().is_empty());
    document.change(Change::Undo);
    let view = document.wait_for_view(|view| view.history.done == 0);
    assert!(!view.history.saved && &*scene_of(&view).text == SCENE);
}

#[test]
fn the_history_of_a_text_that_another_program_changed_is_not_continued() {
    let folder = Folder::new("scene-other");
    let path = scene(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.edit(replaced(SCENE, "Walk", "Run"));
    document.save(SaveTo::Own);
    document.end();
    fs::write(&path, SCENE.replace("Walk", "Survey")).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let view = document.open(&path);
    assert!(view.history.steps.is_empty() && *scene_of(&view).text == *SCENE.replace("Walk", "Survey"));
}
