//! Whatever happens while a model of a scene is edited, nothing of the scene or of the model is lost, and no edit is applied twice.

use super::projects::{PROJECT, is_read, project};
use super::scene_models::{enter, takes};
use super::scenes::{replaced, scene_of};
use dragonfly_document::edit::parse_lines;
use dragonfly_document::{
    Change, Decision, DocumentMessage, DocumentReply, OpenedModel, OutdatedEdits, OutdatedEditsChoice,
    SaveOrder, SaveTo, SceneModel, Setup, Source, Then, View, open_model,
};
use dragonfly_kit::document::test_document::{TestDocument, autosave_in, copy_after_kill, rename, turn};
use dragonfly_kit::folder::Folder;
use std::fs;
use std::path::{Path, PathBuf};

fn opened(folder: &Folder) -> (TestDocument, PathBuf) {
    let path = project(folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.wait_for_view(is_read);
    (document, path)
}

fn is_renamed(view: &View) -> bool {
    takes(view, "fox").first().is_some_and(|name| name == "Look around")
}

/// Makes the project keep one edit of the fox.
pub(super) fn keep_rename(document: &mut TestDocument) {
    enter(document);
    document.edit(rename("Look around"));
    document.send(DocumentMessage::ShowScene);
    document.wait_for_view(is_renamed);
}

/// Waits until the document replies that leaving would lose work, or that it may end. Returns whether it may.
pub(super) fn asks_to_quit(document: &mut TestDocument) -> bool {
    document.send(DocumentMessage::Quit);
    document.wait_for_reply(|reply| match reply {
        DocumentReply::MayQuit => Some(true),
        DocumentReply::Unsaved(Then::Quit) => Some(false),
        _ => None,
    })
}

pub(super) fn refused(document: &mut TestDocument, word: &str) {
    document.wait_for_reply(|reply| {
        matches!(reply, DocumentReply::Refused(reason) if reason.contains(word)).then_some(())
    });
}

fn outdated(document: &mut TestDocument) -> OutdatedEdits {
    document.wait_for_reply(|reply| match reply {
        DocumentReply::OutdatedEdits(edits) => Some(edits.clone()),
        _ => None,
    })
}

/// The steps of the journals in a folder of unsaved work, by the titles of their files.
fn offered(autosave: &Path) -> Vec<(String, usize)> {
    let mut document = TestDocument::new(autosave);
    document.send(DocumentMessage::Search);
    let offers = document.wait_for_reply(|reply| match reply {
        DocumentReply::Offers(offers) => Some(offers.clone()),
        DocumentReply::NothingToOffer => Some(Vec::new()),
        _ => None,
    });
    let mut found: Vec<_> = offers.into_iter().map(|offer| (offer.title, offer.steps)).collect();
    found.sort();
    found
}

#[test]
fn a_reload_of_a_model_that_still_runs_does_not_take_the_place_of_the_scene_that_is_shown_again() {
    let folder = Folder::new("scene-models-reload");
    let (mut document, _) = opened(&folder);
    document.edit(replaced(PROJECT, "Two foxes", "Foxes"));
    enter(&mut document);
    document.edit(rename("Look around"));
    // All three are handled before the file is read.
    document.send(DocumentMessage::Reload);
    document.send(DocumentMessage::ShowScene);
    let view = document.wait_for_view(is_renamed);
    assert_eq!(view.history.done, 2);
    // Another file is read from start to end after the reload would have ended.
    document.send(DocumentMessage::ReadCompared(Source::BuiltIn));
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::ComparedRead(_)).then_some(()));
    let view = document.view();
    assert!(view.scene.is_some() && view.history.done == 2, "the scene and its steps are still there");
    copy_after_kill(&folder.join("autosave"), &folder.join("killed"));
    assert_eq!(offered(&folder.join("killed")), [("foxes.meproj".to_owned(), 2)]);
}

/// Opens scenes as usual and the fox at once, so that the models of a scene are still being read then.
fn quick(
    source: &Source,
    progress: &mut dyn FnMut(dragonfly_document::Progress),
    cancel: &dragonfly_document::Cancel,
) -> Result<OpenedModel, dragonfly_document::LoadError> {
    let is_fox = source.path().is_some_and(|path| path.ends_with("Fox.glb"));
    if !is_fox {
        return open_model(source, progress, cancel);
    }
    let mut opened: OpenedModel = dragonfly_kit::document::fixture::full().opened.as_ref().clone().into();
    opened.loaded.path = source.path().map(Path::to_owned);
    Ok(opened)
}

#[test]
fn models_that_were_being_read_when_one_is_edited_are_there_when_the_scene_is_shown_again() {
    let folder = Folder::new("scene-models-loading");
    let path = project(&folder);
    let (mut models, mut roles) = (String::new(), String::new());
    for number in 0..12 {
        fs::copy(folder.join("models/Fox.glb"), folder.join(&format!("models/fox{number}.glb")))
            .expect("a copy");
        models += &format!("<model id=\"fox{number}\" src=\"models/fox{number}.glb\"/>");
        roles += &format!("<role id=\"role{number}\" model=\"fox{number}\"/>");
    }
    fs::write(&path, PROJECT.replace("</models>", &format!("{models}</models>"))).expect("a file");
    let main = super::projects::MAIN.replace("</cast>", &format!("{roles}</cast>"));
    fs::write(folder.join("main.xml"), main).expect("a file");
    let autosave = Some(autosave_in(&folder.join("autosave")));
    let mut document = TestDocument::with(Setup { load: quick, autosave, ..Setup::default() });
    document.open(&path);
    document.send(DocumentMessage::EditModel("fox".to_owned()));
    document.wait_for_view(|view| view.scene.is_none());
    // Time passes in which those models are read: a file is read from start to end.
    for _ in 0..8 {
        document.send(DocumentMessage::ReadCompared(Source::File(folder.join("models/fox0.glb"))));
        document.wait_for_reply(|reply| matches!(reply, DocumentReply::ComparedRead(_)).then_some(()));
    }
    document.send(DocumentMessage::ShowScene);
    document.wait_for_view(is_read);
}

#[test]
fn leaving_asks_about_the_scene_and_its_model_as_one_and_ends_after_one_save() {
    let folder = Folder::new("scene-models-quit");
    let (mut document, path) = opened(&folder);
    document.edit(replaced(PROJECT, "Two foxes", "Foxes"));
    enter(&mut document);
    document.edit(rename("Look around"));
    assert!(!asks_to_quit(&mut document));
    let view = document.wait_for_view(|view| view.scene.is_some());
    assert_eq!(
        (view.file.title.as_str(), view.history.done),
        ("foxes.meproj", 2),
        "the question is about it"
    );
    document.save(SaveTo::Own);
    assert!(asks_to_quit(&mut document));
    assert!(fs::read_to_string(&path).expect("a file").contains("name=\"Foxes\""));
    assert!(folder.join("foxes.edits/fox.jsonl").exists());
}

#[test]
fn a_saved_model_of_an_unsaved_scene_is_not_asked_about_again_and_discarded_work_is_not_offered() {
    let folder = Folder::new("scene-models-discard");
    let (mut document, _) = opened(&folder);
    document.edit(replaced(PROJECT, "Two foxes", "Foxes"));
    enter(&mut document);
    assert!(!asks_to_quit(&mut document));
    document.wait_for_view(|view| view.scene.is_some());
    document.send(DocumentMessage::DoNotSave);
    assert!(asks_to_quit(&mut document), "the user has decided");
    document.end();
    assert_eq!(offered(&folder.join("autosave")), []);
}

#[test]
fn a_model_whose_edits_only_its_file_can_keep_is_asked_about_before_its_scene() {
    let folder = Folder::new("scene-models-quit-script");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&super::scenes::scene(&folder));
    document
        .wait_for_view(|view| matches!(scene_of(view).models.get("Fox.glb"), Some(SceneModel::Loaded(_))));
    document.edit(replaced(super::scenes::SCENE, "Walk", "Run"));
    document.send(DocumentMessage::EditModel("Fox.glb".to_owned()));
    document.wait_for_view(|view| view.scene.is_none());
    document.edit(rename("Look around"));
    assert!(!asks_to_quit(&mut document));
    assert!(document.view().scene.is_none(), "its edits would be lost");
    document.send(DocumentMessage::DoNotSave);
    assert!(!asks_to_quit(&mut document));
    let view = document.wait_for_view(|view| view.scene.is_some());
    assert_eq!(view.history.done, 1, "now the scene is asked about");
    document.save(SaveTo::Own);
    assert!(asks_to_quit(&mut document));
}

#[test]
fn the_model_of_a_scene_keeps_its_file_and_a_copy_of_it_can_be_saved() {
    let folder = Folder::new("scene-models-save-as");
    let (mut document, _) = opened(&folder);
    enter(&mut document);
    document.edit(rename("Look around"));
    let other = folder.join("models/Fox2.glb");
    document.send(DocumentMessage::Save(SaveOrder { to: SaveTo::As(other.clone()), ..SaveOrder::own(None) }));
    document.wait_for_reply(|reply| match reply {
        DocumentReply::NotSaved(_, dragonfly_document::NotSaved::Failed(reason)) => {
            assert!(reason.contains("save a copy"), "{reason}");
            Some(())
        }
        DocumentReply::Saved(saved) => panic!("{saved:?}"),
        _ => None,
    });
    assert!(!other.exists());
    document.save(SaveTo::Copy(other.clone()));
    assert!(other.exists());
    document.edit(turn(0.4));
    document.send(DocumentMessage::ShowScene);
    let view = document.wait_for_view(is_renamed);
    let lines = scene_of(&view).texts.called("foxes.edits/fox.jsonl").expect("a text").text.clone();
    assert_eq!(parse_lines(&lines).expect("edits").len(), 2, "all edits are kept");
}

#[test]
fn no_model_is_opened_while_the_project_that_would_keep_its_edits_has_errors() {
    let folder = Folder::new("scene-models-errors");
    let (mut document, _) = opened(&folder);
    document.edit(replaced(PROJECT, "<models>", "<modles>"));
    document.send(DocumentMessage::EditModel("fox".to_owned()));
    refused(&mut document, "errors");
    document.change(Change::Undo);
    enter(&mut document);
    document.send(DocumentMessage::ShowScene);
    document.wait_for_view(|view| view.scene.is_some());
}

#[test]
fn a_model_with_kept_edits_that_is_only_looked_at_has_no_unsaved_work() {
    let folder = Folder::new("scene-models-kept");
    let (mut document, path) = opened(&folder);
    keep_rename(&mut document);
    document.save(SaveTo::Own);
    let view = enter(&mut document);
    assert_eq!((view.history.done, view.history.saved, view.history.saved_at), (1, true, Some(1)));
    copy_after_kill(&folder.join("autosave"), &folder.join("killed"));
    assert_eq!(offered(&folder.join("killed")), []);
    document.edit(turn(0.4));
    document.wait_for_view(|view| view.history.done == 2 && !view.history.saved);
    document.send(DocumentMessage::Revert);
    document.wait_for_view(|view| view.history.done == 1 && view.history.saved);
    assert!(asks_to_quit(&mut document));
    document.end();
    assert_eq!(offered(&folder.join("autosave")), []);
    assert!(fs::read_to_string(&path).expect("a file").contains("fox.jsonl"));
}

#[test]
fn edits_that_were_saved_into_the_model_are_not_applied_again_when_the_project_still_keeps_them() {
    let folder = Folder::new("scene-models-twice");
    let (mut document, path) = opened(&folder);
    enter(&mut document);
    document.edit(turn(0.4));
    document.send(DocumentMessage::ShowScene);
    document.wait_for_view(|view| view.scene.is_some() && view.history.done == 1);
    document.save(SaveTo::Own);
    enter(&mut document);
    document.edit(rename("Look around"));
    document.save(SaveTo::Own);
    // The project is not saved.
    document.send(DocumentMessage::ShowScene);
    document.wait_for_view(is_renamed);
    document.send(DocumentMessage::DoNotSave);
    document.end();
    let mut document = TestDocument::new(&folder.join("other"));
    document.open(&path);
    let view = document.wait_for_view(|view| is_read(view) && !scene_of(view).project_notes.is_empty());
    assert!(
        scene_of(&view).project_notes[0].message.contains("not applied"),
        "{:?}",
        scene_of(&view).project_notes
    );
    document.send(DocumentMessage::EditModel("fox".to_owned()));
    let edits = outdated(&mut document);
    assert_eq!((edits.model.as_str(), edits.title.as_str()), ("fox", "Fox.glb"));
    assert!(document.view().scene.is_some(), "nothing is opened before the user decides");
    document.send(DocumentMessage::DecideOutdated(edits, OutdatedEditsChoice::Remove));
    let view = document.wait_for_view(|view| view.scene.is_none() && view.loaded.title == "Fox.glb");
    assert_eq!(view.history.done, 0);
    document.send(DocumentMessage::ShowScene);
    let view = document.wait_for_view(|view| view.scene.is_some() && is_read(view));
    assert!(scene_of(&view).project_notes.is_empty(), "{:?}", scene_of(&view).project_notes);
    assert_eq!(scene_of(&view).texts.called("foxes.edits/fox.jsonl").map(|file| file.text.len()), Some(0));
}

#[test]
fn edits_for_another_file_are_applied_when_the_user_says_so_and_the_scene_plays_them() {
    let folder = Folder::new("scene-models-apply");
    let (mut document, path) = opened(&folder);
    keep_rename(&mut document);
    document.save(SaveTo::Own);
    document.end();
    // Another program writes the file again.
    let fox = folder.join("models/Fox.glb");
    let mut bytes = fs::read(&fox).expect("a file");
    let at = bytes.windows(6).position(|window| window == b"\"Walk\"").expect("a take");
    bytes[at..at + 6].copy_from_slice(b"\"Wolk\"");
    fs::write(&fox, bytes).expect("a file");
    let mut document = TestDocument::new(&folder.join("other"));
    document.open(&path);
    let view = document.wait_for_view(is_read);
    assert_eq!(takes(&view, "fox")[..2], ["Survey", "Wolk"]);
    document.send(DocumentMessage::EditModel("fox".to_owned()));
    let edits = outdated(&mut document);
    document.send(DocumentMessage::DecideOutdated(edits, OutdatedEditsChoice::Apply));
    let view = document.wait_for_view(|view| view.scene.is_none() && view.loaded.title == "Fox.glb");
    assert_eq!(view.takes[0].name, "Look around");
    document.send(DocumentMessage::ShowScene);
    let view = document.wait_for_view(is_renamed);
    assert!(scene_of(&view).project_notes.is_empty() && view.history.done == 1);
}

#[test]
fn the_file_of_new_edits_is_none_that_is_on_the_disk_already() {
    let folder = Folder::new("scene-models-name");
    let (mut document, path) = opened(&folder);
    keep_rename(&mut document);
    document.save(SaveTo::Own);
    document.change(Change::Undo);
    document.wait_for_view(|view| view.history.done == 0);
    document.save(SaveTo::Own);
    document.end();
    let mut document = TestDocument::new(&folder.join("other"));
    document.open(&path);
    document.wait_for_view(is_read);
    keep_rename(&mut document);
    document.save(SaveTo::Own);
    assert!(folder.join("foxes.edits/fox-2.jsonl").exists());
}

#[test]
fn a_model_file_that_another_program_changed_is_read_again_when_the_files_are_looked_at() {
    let folder = Folder::new("scene-models-changed-file");
    let (mut document, _) = opened(&folder);
    let fox = folder.join("models/Fox.glb");
    let mut bytes = fs::read(&fox).expect("a file");
    let at = bytes.windows(6).position(|window| window == b"\"Walk\"").expect("a take");
    bytes[at..at + 6].copy_from_slice(b"\"Wolk\"");
    fs::write(&fox, bytes).expect("a file");
    document.send(DocumentMessage::LookAtFile);
    document.wait_for_view(|view| takes(view, "fox").get(1).is_some_and(|name| name == "Wolk"));
}

#[test]
fn a_model_of_a_scene_that_cannot_be_read_leaves_the_scene_open_and_nothing_waits() {
    let folder = Folder::new("scene-models-broken");
    let (mut document, _) = opened(&folder);
    fs::write(folder.join("models/Fox.glb"), "no model").expect("a file");
    document.send(DocumentMessage::EditModel("fox".to_owned()));
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::Failed { .. }).then_some(()));
    let view = document.view();
    assert!(view.scene.is_some() && view.waiting_scene.is_none());
    document.send(DocumentMessage::ShowScene);
    refused(&mut document, "model of a scene");
}

#[test]
fn the_work_of_a_model_that_comes_back_is_kept_in_the_scene() {
    let folder = Folder::new("scene-models-back");
    let (mut document, path) = opened(&folder);
    enter(&mut document);
    document.edit(rename("Look around"));
    document.wait_for_view(|view| view.scene.is_none() && view.history.done == 1);
    copy_after_kill(&folder.join("autosave"), &folder.join("killed"));
    let mut again = TestDocument::new(&folder.join("killed"));
    again.open(&path);
    again.wait_for_view(is_read);
    enter(&mut again);
    let offer = again.wait_for_reply(|reply| match reply {
        DocumentReply::Offers(offers) => offers.iter().find(|offer| offer.title == "Fox.glb").cloned(),
        _ => None,
    });
    again.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    again.wait_for_view(|view| view.history.done == 1);
    again.send(DocumentMessage::ShowScene);
    again.wait_for_view(is_renamed);
}
