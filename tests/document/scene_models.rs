//! Models that are edited inside a project: the project keeps their edits as one step, and the scene plays them at once.

use super::projects::{MAIN, PROJECT, is_read, project};
use super::scenes::{replaced, scene, scene_of};
use dragonfly_document::edit::parse_lines;
use dragonfly_document::{Change, Decision, DocumentMessage, DocumentReply, SaveTo, SceneModel, View};
use dragonfly_kit::document::test_document::{TestDocument, copy_after_kill, rename, turn};
use dragonfly_kit::folder::Folder;
use std::fs;

/// Returns the names of the takes of a model in the scene.
pub(super) fn takes(view: &View, name: &str) -> Vec<String> {
    match view.scene.as_ref().and_then(|scene| scene.models.get(name)) {
        Some(SceneModel::Loaded(loaded)) => {
            loaded.model.animation.takes.iter().map(|take| take.name.clone()).collect()
        }
        _ => Vec::new(),
    }
}

/// Shows the fox of the scene, to edit it.
pub(super) fn enter(document: &mut TestDocument) -> View {
    document.send(DocumentMessage::EditModel("fox".to_owned()));
    document.wait_for_view(|view| view.scene.is_none() && view.loaded.title == "Fox.glb")
}

#[test]
fn edits_of_a_model_are_one_step_of_the_project_and_are_saved_beside_it_and_come_back() {
    let folder = Folder::new("scene-models");
    let path = project(&folder);
    let fox = fs::read(folder.join("models/Fox.glb")).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.wait_for_view(is_read);
    document.edit(replaced(PROJECT, "Two foxes", "Foxes"));
    let view = enter(&mut document);
    assert_eq!(view.takes.len(), 3);
    document.edit(rename("Look around"));
    document.edit(turn(0.4));
    document.wait_for_view(|view| view.scene.is_none() && view.history.done == 2);
    document.send(DocumentMessage::ShowScene);
    let view =
        document.wait_for_view(|view| takes(view, "fox").first().is_some_and(|name| name == "Look around"));
    assert_eq!((view.history.done, view.history.steps[1]), (2, "Edit model"));
    document.save(SaveTo::Own);
    assert_eq!(fs::read(folder.join("models/Fox.glb")).expect("a file"), fox, "the model stays as it was");
    let lines = fs::read_to_string(folder.join("foxes.edits/fox.jsonl")).expect("a file");
    let edits: Vec<_> = parse_lines(&lines).expect("edits").into_iter().map(|(_, edit)| edit).collect();
    assert_eq!(edits, [rename("Look around"), turn(0.4)]);
    let text = fs::read_to_string(&path).expect("a file");
    let hash = format!(" hash=\"{:016x}\"", dragonfly_store::hash(&fox));
    let wanted = PROJECT.replace("Two foxes", "Foxes").replace(
        "models/Fox.glb\"/>\n",
        &format!("models/Fox.glb\"{hash}/>\n    <edits of=\"fox\" src=\"foxes.edits/fox.jsonl\"/>\n"),
    );
    assert_eq!(text, wanted, "two lines of the project differ");
    document.end();
    // Opened again, the scene has them, and they are steps of the model.
    let mut document = TestDocument::new(&folder.join("other"));
    document.open(&path);
    document.wait_for_view(|view| takes(view, "fox").first().is_some_and(|name| name == "Look around"));
    let view = enter(&mut document);
    assert_eq!((view.history.steps.as_slice(), view.history.done), (&["Rename take", "Rotate"][..], 2));
    document.change(Change::GoTo(0));
    document.wait_for_view(|view| view.scene.is_none() && view.history.done == 0);
    document.send(DocumentMessage::ShowScene);
    let view = document.wait_for_view(|view| takes(view, "fox").first().is_some_and(|name| name == "Survey"));
    assert_eq!(scene_of(&view).texts.called("foxes.edits/fox.jsonl").map(|file| file.text.len()), Some(0));
}

#[test]
fn undo_in_the_scene_takes_the_edits_of_a_model_back_and_redo_brings_them_again() {
    let folder = Folder::new("scene-models-undo");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    document.wait_for_view(is_read);
    enter(&mut document);
    document.edit(rename("Look around"));
    document.send(DocumentMessage::ShowScene);
    let is_renamed = |view: &View| takes(view, "fox").first().is_some_and(|name| name == "Look around");
    document.wait_for_view(is_renamed);
    document.change(Change::Undo);
    let view = document.wait_for_view(|view| takes(view, "fox").first().is_some_and(|name| name == "Survey"));
    assert_eq!(&**scene_of(&view).texts.main().expect("a text"), PROJECT);
    assert_eq!(scene_of(&view).texts.list().len(), 4);
    document.change(Change::Redo);
    document.wait_for_view(is_renamed);
}

#[test]
fn the_scene_is_as_it_was_where_nothing_was_edited() {
    let folder = Folder::new("scene-models-none");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    document.wait_for_view(is_read);
    enter(&mut document);
    document.send(DocumentMessage::ShowScene);
    let view = document.wait_for_view(|view| view.scene.is_some());
    assert!(view.history.saved && view.history.steps.is_empty() && &*scene_of(&view).text == MAIN);
    document.send(DocumentMessage::ShowScene);
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::Refused(_)).then_some(()));
}

#[test]
fn a_script_without_a_project_does_not_lose_the_edits_of_a_model_but_asks_to_save_it() {
    let folder = Folder::new("scene-models-script");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&scene(&folder));
    document
        .wait_for_view(|view| matches!(scene_of(view).models.get("Fox.glb"), Some(SceneModel::Loaded(_))));
    document.send(DocumentMessage::EditModel("Fox.glb".to_owned()));
    document.wait_for_view(|view| view.scene.is_none() && view.loaded.title == "Fox.glb");
    document.edit(rename("Look around"));
    document.send(DocumentMessage::ShowScene);
    document.wait_for_reply(|reply| {
        matches!(reply, DocumentReply::Refused(text) if text.contains("save it")).then_some(())
    });
    let view = document.view();
    assert!(view.scene.is_none() && view.history.done == 1, "the model is still shown");
    document.save(SaveTo::Own);
    document.send(DocumentMessage::ShowScene);
    let view = document
        .wait_for_view(|view| takes(view, "Fox.glb").first().is_some_and(|name| name == "Look around"));
    assert!(view.history.steps.is_empty());
}

#[test]
fn a_model_that_is_edited_in_a_scene_and_the_scene_come_back_after_a_kill() {
    let folder = Folder::new("scene-models-kill");
    let path = project(&folder);
    let autosave = folder.join("autosave");
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.wait_for_view(is_read);
    document.edit(replaced(PROJECT, "Two foxes", "Foxes"));
    enter(&mut document);
    document.edit(rename("Look around"));
    document.send(DocumentMessage::ShowScene);
    document.wait_for_view(|view| view.scene.is_some() && view.history.done == 2);
    enter(&mut document);
    document.edit(turn(0.4));
    document.wait_for_view(|view| view.scene.is_none() && view.history.done == 2);
    copy_after_kill(&autosave, &folder.join("killed"));
    let mut again = TestDocument::new(&folder.join("killed"));
    let mut offers = again.wait_for_offers();
    offers.sort_by(|one, other| one.title.cmp(&other.title));
    let offered: Vec<(&str, usize)> =
        offers.iter().map(|offer| (offer.title.as_str(), offer.steps)).collect();
    assert_eq!(offered, [("Fox.glb", 2), ("foxes.meproj", 2)]);
    for (offer, done) in offers.into_iter().zip([2, 2]) {
        let is_project = offer.title == "foxes.meproj";
        again.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
        let view =
            again.wait_for_view(|view| view.history.done == done && view.scene.is_some() == is_project);
        if !is_project {
            assert_eq!(view.takes[0].name, "Look around");
        }
    }
    again.wait_for_view(|view| takes(view, "fox").first().is_some_and(|name| name == "Look around"));
}

#[test]
fn a_model_whose_file_changed_since_its_edits_and_edits_that_do_not_fit_are_reported_with_their_places() {
    let folder = Folder::new("scene-models-changed");
    let path = project(&folder);
    fs::create_dir(folder.join("foxes.edits")).expect("a folder");
    let edits = "{\"edit\":\"rename_take\",\"take\":0,\"name\":\"Look around\"}\n{\"edit\":\"reverse_take\",\"take\":\"Dance\"}\n";
    fs::write(folder.join("foxes.edits/fox.jsonl"), edits).expect("a file");
    let model = "<model id=\"fox\" src=\"models/Fox.glb\" hash=\"0123456789abcdef\"/>\n    <edits of=\"fox\" src=\"foxes.edits/fox.jsonl\"/>";
    let text = PROJECT.replace("<model id=\"fox\" src=\"models/Fox.glb\"/>", model);
    fs::write(&path, &text).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let notes = |view: &View| -> Vec<String> {
        scene_of(view).project_notes.iter().map(|note| note.in_file("foxes.meproj")).collect()
    };
    let view = document.wait_for_view(|view| is_read(view) && !scene_of(view).project_notes.is_empty());
    assert_eq!(notes(&view).len(), 1, "{:?}", notes(&view));
    assert!(notes(&view)[0].starts_with("foxes.meproj:4:48: models/Fox.glb changed"), "{:?}", notes(&view));
    assert_eq!(takes(&view, "fox")[0], "Survey", "the file may have the edits already");
    // With the hash of the file, they are applied as far as they fit.
    let hash = dragonfly_store::hash(&fs::read(folder.join("models/Fox.glb")).expect("a file"));
    document.edit(replaced(&text, "0123456789abcdef", &format!("{hash:016x}")));
    let view =
        document.wait_for_view(|view| takes(view, "fox").first().is_some_and(|name| name == "Look around"));
    assert_eq!(notes(&view).len(), 1, "{:?}", notes(&view));
    assert!(notes(&view)[0].contains("line 2: there is no take \"Dance\""), "{:?}", notes(&view));
    // A script that names the file itself means the same model.
    document.edit(super::projects::replaced_in(
        "main.xml",
        MAIN,
        "model=\"fox\"",
        "model=\"models/Fox.glb\"",
    ));
    let view = document.wait_for_view(|view| {
        takes(view, "models/Fox.glb").first().is_some_and(|name| name == "Look around")
    });
    assert_eq!(notes(&view).len(), 1, "{:?}", notes(&view));
    // A model that is not there any more has no such note.
    fs::remove_file(folder.join("models/Fox.glb")).expect("a file");
    document.send(DocumentMessage::LookAtFile);
    let view = document.wait_for_view(|view| {
        matches!(scene_of(view).models.get("models/Fox.glb"), Some(SceneModel::Missing(_)))
    });
    assert!(notes(&view).is_empty(), "{:?}", notes(&view));
}
