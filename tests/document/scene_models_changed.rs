//! Models that changed since their edits were made: asked about once, decided in one step, also by a client.

use super::projects::{MAIN, PROJECT, is_read, project, text_of};
use super::scene_models::takes;
use super::scenes::scene_of;
use dragonfly_document::protocol::Session;
use dragonfly_document::{
    Cancel, Change, DocumentMessage, DocumentReply, Editable, OutdatedEdits, OutdatedEditsChoice, Source,
};
use dragonfly_kit::document::test_document::TestDocument;
use dragonfly_kit::folder::Folder;
use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;

/// One edit that fits, and one that does not.
const EDITS: [&str; 2] = [
    "{\"edit\":\"rename_take\",\"take\":0,\"name\":\"Look around\"}\n",
    "{\"edit\":\"reverse_take\",\"take\":\"Dance\"}\n",
];

/// Writes a project of two foxes whose edits were made for other files, and one whose edits fit.
fn changed(folder: &Folder) -> PathBuf {
    let path = project(folder);
    fs::create_dir(folder.join("foxes.edits")).expect("a folder");
    let mut models = String::new();
    for (id, edits, hash) in [("fox", EDITS[0].to_owned(), 1), ("vixen", EDITS.concat(), 2)] {
        if id != "fox" {
            fs::copy(folder.join("models/Fox.glb"), folder.join(&format!("models/{id}.glb")))
                .expect("a copy");
        }
        let file = if id == "fox" { "Fox" } else { id };
        models += &format!("<model id=\"{id}\" src=\"models/{file}.glb\" hash=\"{hash:016x}\"/>\n    ");
        models += &format!("<edits of=\"{id}\" src=\"foxes.edits/{id}.jsonl\"/>\n    ");
        fs::write(folder.join(&format!("foxes.edits/{id}.jsonl")), edits).expect("a file");
    }
    let text =
        PROJECT.replace("<model id=\"fox\" src=\"models/Fox.glb\"/>\n", &format!("{}\n", models.trim_end()));
    fs::write(&path, text).expect("a file");
    let vixen = "<role id=\"vixen\" model=\"vixen\" scale=\"0.01\"/>\n  </cast>";
    fs::write(folder.join("main.xml"), MAIN.replace("</cast>", vixen)).expect("a file");
    path
}

fn hash(folder: &Folder) -> u64 {
    dragonfly_store::hash(&fs::read(folder.join("models/Fox.glb")).expect("a file"))
}

/// Waits for the question about models that changed.
fn asked(document: &mut TestDocument) -> Vec<OutdatedEdits> {
    document.wait_for_reply(|reply| match reply {
        DocumentReply::ChangedModels(edits) => Some(edits.clone()),
        _ => None,
    })
}

fn is_asked(document: &mut TestDocument) -> bool {
    document.view();
    document.has_reply(|reply| matches!(reply, DocumentReply::ChangedModels(_)))
}

#[test]
fn models_that_changed_are_asked_about_once_all_together_and_opening_changes_no_bytes() {
    let folder = Folder::new("changed-asked");
    let path = changed(&folder);
    let before = fs::read(&path).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let edits = asked(&mut document);
    let listed: Vec<(&str, &str, u64)> =
        edits.iter().map(|edits| (&*edits.model, &*edits.title, edits.hash)).collect();
    let now = hash(&folder);
    assert_eq!(listed, [("fox", "Fox.glb", now), ("vixen", "vixen.glb", now)]);
    let view = document.wait_for_view(is_read);
    assert_eq!(*scene_of(&view).outdated, *edits);
    assert_eq!(scene_of(&view).project_notes.len(), 2);
    // Without a decision the notes stay, and nothing is asked again: not by another script, an edit, or a look at the files.
    for name in ["end.xml", "main.xml"] {
        document.send(DocumentMessage::ShowScript(name.to_owned()));
        document.wait_for_view(|view| &*scene_of(view).name == name);
    }
    document.send(DocumentMessage::LookAtFile);
    assert!(!is_asked(&mut document));
    assert_eq!((view.history.done, fs::read(&path).expect("a file")), (0, before));
}

#[test]
fn applied_edits_are_one_step_for_all_models_and_those_that_do_not_fit_are_named() {
    let folder = Folder::new("changed-apply");
    let path = changed(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let edits = asked(&mut document);
    document.send(DocumentMessage::DecideAllOutdated(edits, OutdatedEditsChoice::Apply));
    let view = document.wait_for_view(|view| {
        ["fox", "vixen"].iter().all(|fox| takes(view, fox).first().is_some_and(|name| name == "Look around"))
    });
    assert_eq!((view.history.done, view.history.steps.as_slice()), (1, &["Apply edits again"][..]));
    let text = text_of(&view, "foxes.meproj");
    assert_eq!(text.matches(&format!("hash=\"{:016x}\"", hash(&folder))).count(), 2, "{text}");
    assert!(scene_of(&view).outdated.is_empty());
    let warning = document.wait_for_warning("vixen.glb do not fit it");
    assert!(warning.contains("line 2: there is no take \"Dance\""), "{warning}");
    document.change(Change::Undo);
    let view = document.wait_for_view(|view| view.history.done == 0 && scene_of(view).outdated.len() == 2);
    assert_eq!(text_of(&view, "foxes.meproj"), fs::read_to_string(&path).expect("a file"));
    assert!(!is_asked(&mut document), "an undo does not ask again");
}

#[test]
fn removed_edits_are_one_step_for_all_models_and_an_undo_brings_them_back() {
    let folder = Folder::new("changed-remove");
    let path = changed(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let edits = asked(&mut document);
    document.send(DocumentMessage::DecideAllOutdated(edits, OutdatedEditsChoice::Remove));
    let view = document
        .wait_for_view(|view| view.history.done == 1 && is_read(view) && scene_of(view).outdated.is_empty());
    assert_eq!(view.history.steps.as_slice(), ["Remove edits"]);
    for name in ["fox", "vixen"] {
        assert_eq!(text_of(&view, &format!("foxes.edits/{name}.jsonl")), "");
        assert_eq!(takes(&view, name)[0], "Survey");
    }
    document.change(Change::Undo);
    let view = document.wait_for_view(|view| view.history.done == 0);
    assert_eq!(text_of(&view, "foxes.edits/vixen.jsonl"), EDITS.concat());
}

#[test]
fn a_model_that_changes_while_the_scene_is_open_has_a_note_and_can_be_decided_alone() {
    let folder = Folder::new("changed-later");
    let path = changed(&folder);
    let text = fs::read_to_string(&path).expect("a file");
    let fitting = text.replace("0000000000000001", &format!("{:016x}", hash(&folder)));
    fs::write(&path, fitting.replace("0000000000000002", &format!("{:016x}", hash(&folder))))
        .expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.wait_for_view(is_read);
    assert!(!is_asked(&mut document), "its edits were made for it");
    let fox = folder.join("models/Fox.glb");
    let mut bytes = fs::read(&fox).expect("a file");
    let at = bytes.windows(6).position(|window| window == b"\"Walk\"").expect("a take");
    bytes[at..at + 6].copy_from_slice(b"\"Wolk\"");
    fs::write(&fox, bytes).expect("a file");
    document.send(DocumentMessage::LookAtFile);
    let view = document.wait_for_view(|view| scene_of(view).outdated.len() == 1);
    assert!(!is_asked(&mut document), "asked only about what is found at the opening");
    let edits = scene_of(&view).outdated.to_vec();
    document.send(DocumentMessage::DecideAllOutdated(edits, OutdatedEditsChoice::Apply));
    document.wait_for_view(|view| takes(view, "fox")[..2] == ["Look around", "Wolk"]);
}

#[test]
fn a_client_applies_or_removes_the_edits_of_changed_models_in_one_step() {
    let folder = Folder::new("changed-session");
    let path = changed(&folder);
    let editable = Editable::open(&Source::File(path), &Cancel::default()).expect("a project");
    let mut session = Session::new(editable);
    let mut ask = |request: Value| -> Value {
        serde_json::from_str(&session.answer(&request.to_string()).expect("an answer")).expect("JSON")
    };
    let refused = ask(json!({"do": "settle_edits", "choice": "apply", "models": ["nobody"]}));
    assert!(
        refused["error"].as_str().is_some_and(|reason| reason.starts_with("nobody has no edits")),
        "{refused}"
    );
    let one = ask(json!({"do": "settle_edits", "choice": "remove", "models": ["fox"]}));
    assert_eq!((&one["ok"]["models"], &one["ok"]["done"]), (&json!(["fox"]), &json!(1)), "{one}");
    let all = ask(json!({"do": "settle_edits", "choice": "apply"}));
    assert_eq!((&all["ok"]["models"], &all["ok"]["done"]), (&json!(["vixen"]), &json!(2)), "{all}");
    assert!(all["ok"]["unfit"][0].as_str().is_some_and(|text| text.contains("Dance")), "{all}");
    let again = ask(json!({"do": "settle_edits", "choice": "apply"}));
    assert_eq!((&again["ok"]["models"], &again["ok"]["done"]), (&json!([]), &json!(2)), "{again}");
    assert_eq!(ask(json!({"do": "go_to", "steps": 0}))["ok"]["done"], json!(0));
    let errors = ask(json!({"query": "errors"}));
    assert_eq!(errors["ok"]["edits"].as_array().map(Vec::len), Some(2), "{errors}");
}

/// Waits until no warning about edits that do not fit is left; returns whether there was one.
fn warned(document: &mut TestDocument) -> bool {
    document.view();
    document.has_reply(|reply| matches!(reply, DocumentReply::Warning(text) if text.contains("do not fit")))
}

#[test]
fn edits_of_several_models_that_do_not_fit_are_one_warning_that_is_not_repeated() {
    let folder = Folder::new("changed-misfits");
    let path = changed(&folder);
    fs::write(folder.join("foxes.edits/fox.jsonl"), EDITS.concat()).expect("a file");
    // The script means one of them by its file, too.
    let by_file = "<role id=\"twin\" model=\"models/vixen.glb\" scale=\"0.01\"/>\n  </cast>";
    let main = fs::read_to_string(folder.join("main.xml")).expect("a file");
    fs::write(folder.join("main.xml"), main.replace("</cast>", by_file)).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let edits = asked(&mut document);
    document.send(DocumentMessage::DecideAllOutdated(edits.clone(), OutdatedEditsChoice::Apply));
    let warning = document.wait_for_warning("do not fit");
    assert!(warning.starts_with("Edits of models/Fox.glb, models/vixen.glb do not fit them: "), "{warning}");
    assert_eq!(warning.matches("there is no take \"Dance\"").count(), 2, "{warning}");
    // Neither a second decision nor another look repeats it.
    document.send(DocumentMessage::DecideAllOutdated(edits, OutdatedEditsChoice::Apply));
    document.send(DocumentMessage::LookAtFile);
    document.wait_for_view(is_read);
    assert!(!warned(&mut document));
}

#[test]
fn edits_that_do_not_fit_a_model_that_is_opened_are_one_warning() {
    let folder = Folder::new("changed-misfit-once");
    let path = changed(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let vixen = asked(&mut document).remove(1);
    document.wait_for_view(is_read);
    document.send(DocumentMessage::DecideOutdated(vixen, OutdatedEditsChoice::Apply));
    document.wait_for_warning("do not fit it, and are removed from the project");
    document.send(DocumentMessage::ShowScene);
    document.wait_for_view(|view| view.scene.is_some() && is_read(view));
    assert!(!warned(&mut document));
}
