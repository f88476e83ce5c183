//! Edits that a project keeps, but that cannot be applied to the model, are not removed without a word.

use super::projects::{PROJECT, is_read, project};
use super::scene_models::{enter, takes};
use super::scene_models_later::{asks_to_quit, refused};
use super::scenes::scene_of;
use dragonfly_document::{Change, DocumentMessage};
use dragonfly_kit::document::test_document::{TestDocument, rename};
use dragonfly_kit::folder::Folder;
use std::fs;

const FILE: &str = "foxes.edits/fox.jsonl";

/// Opens a project that keeps these edits of the fox.
fn kept(folder: &Folder, lines: &str) -> TestDocument {
    let path = project(folder);
    fs::create_dir(folder.join("foxes.edits")).expect("a folder");
    fs::write(folder.join(FILE), lines).expect("a file");
    let element = format!("src=\"models/Fox.glb\"/>\n    <edits of=\"fox\" src=\"{FILE}\"/>");
    fs::write(&path, PROJECT.replace("src=\"models/Fox.glb\"/>", &element)).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.wait_for_view(is_read);
    document
}

fn kept_text(document: &mut TestDocument) -> String {
    let view = document.view();
    scene_of(&view).texts.called(FILE).expect("a text").text.to_string()
}

#[test]
fn a_model_is_not_opened_to_edit_it_while_a_line_of_its_kept_edits_cannot_be_read() {
    let folder = Folder::new("scene-models-unreadable");
    let lines =
        "{\"edit\":\"rename_take\",\"take\":0,\"name\":\"Look around\"}\n{\"edit\":\"of_a_newer_version\"}\n";
    let mut document = kept(&folder, lines);
    document.send(DocumentMessage::EditModel("fox".to_owned()));
    refused(&mut document, "foxes.edits/fox.jsonl: line 2");
    assert!(document.view().scene.is_some(), "the scene is still shown");
    assert_eq!(kept_text(&mut document), lines);
    assert!(asks_to_quit(&mut document), "nothing was edited");
}

#[test]
fn edits_that_do_not_fit_are_removed_only_after_a_warning_and_an_undo_brings_them_back() {
    let folder = Folder::new("scene-models-unfit");
    let lines = "{\"edit\":\"reverse_take\",\"take\":\"Dance\"}\n{\"edit\":\"rename_take\",\"take\":0,\"name\":\"Look around\"}\n";
    let mut document = kept(&folder, lines);
    assert_eq!(enter(&mut document).history.done, 1);
    let text = document.wait_for_warning("do not fit");
    assert!(text.contains("line 1: there is no take \"Dance\""), "{text}");
    assert!(text.contains("removed from the project once the model is edited or saved"), "{text}");
    document.send(DocumentMessage::ShowScene);
    document.wait_for_view(|view| view.scene.is_some());
    assert_eq!(kept_text(&mut document), lines, "without an edit they stay");
    enter(&mut document);
    document.edit(rename("Dance"));
    document.send(DocumentMessage::ShowScene);
    document.wait_for_view(|view| takes(view, "fox").first().is_some_and(|name| name == "Dance"));
    assert!(!kept_text(&mut document).contains("reverse_take"));
    document.change(Change::Undo);
    assert_eq!(kept_text(&mut document), lines);
}
