//! A project is a document of several texts: its scripts play with its cast, its models and its lines, and a save writes only the texts
//! that changed.

use super::scenes::{replaced, scene_of};
use dragonfly_document::edit::{Edit, EditScript, ScriptSplice, TextRef};
use dragonfly_document::{
    Change, Decision, DocumentMessage, DocumentReply, NotSaved, SaveOrder, SaveTo, SceneModel, View,
};
use dragonfly_kit::document::test_document::{TestDocument, copy_after_kill, fox};
use dragonfly_kit::folder::Folder;
use std::fs;
use std::path::{Path, PathBuf};

pub(super) const PROJECT: &str = "<?xml version=\"1.0\"?>\n<project version=\"1\" name=\"Two foxes\" fps=\"30\">\n  <models>\n    \
    <model id=\"fox\" src=\"models/Fox.glb\"/>\n  </models>\n  <cast>\n    <camera id=\"wide\" at=\"0 2 9\" look=\"0 1 0\"/>\n  </cast>\n  \
    <lines src=\"foxes.lines.xml\"/>\n  <script id=\"main\" src=\"main.xml\"/>\n  <script id=\"end\" src=\"end.xml\"/>\n</project>\n";

pub(super) const MAIN: &str = "<script version=\"1\">\n  <cast>\n    <role id=\"ann\" model=\"fox\" scale=\"0.01\"/>\n    \
    <path id=\"way\" line=\"aisle\"/>\n  </cast>\n  <!-- she walks -->\n  <move who=\"ann\" path=\"way\" speed=\"1\"/>\n</script>\n";

pub(super) const END: &str = "<script version=\"1\">\n  <title text=\"The End\" dur=\"2\"/>\n</script>\n";

pub(super) const LINES: &str =
    "<lines version=\"1\">\n  <line id=\"aisle\" points=\"0 0 0  1 0 0  2 0 0  3 0 0\"/>\n</lines>\n";

/// Writes the project, and returns its path.
pub(super) fn project(folder: &Folder) -> PathBuf {
    fs::create_dir(folder.join("models")).expect("a folder");
    fs::rename(fox(folder), folder.join("models/Fox.glb")).expect("a file");
    for (name, text) in
        [("foxes.meproj", PROJECT), ("main.xml", MAIN), ("end.xml", END), ("foxes.lines.xml", LINES)]
    {
        fs::write(folder.join(name), text).expect("a file");
    }
    folder.join("foxes.meproj")
}

/// Returns an edit that replaces the first `old` of a text.
pub(super) fn replaced_in(name: &str, text: &str, old: &str, new: &str) -> Edit {
    let Edit::EditScript(edit) = replaced(text, old, new) else { panic!("another edit") };
    EditScript { text: Some(TextRef::Name(name.to_owned())), ..edit }.into()
}

/// Returns whether every model of the scene was read.
pub(super) fn is_read(view: &View) -> bool {
    let models = view.scene.as_ref().map(|scene| scene.models.clone()).unwrap_or_default();
    !models.is_empty() && models.values().all(|model| matches!(model, SceneModel::Loaded(_)))
}

pub(super) fn text_of(view: &View, name: &str) -> String {
    scene_of(view).texts.called(name).map(|file| file.text.to_string()).expect(name)
}

/// Returns when each file of a folder was written, with its contents.
fn contents(folder: &Path, names: &[&str]) -> Vec<(std::time::SystemTime, String)> {
    let of = |name: &&str| {
        let path = folder.join(name);
        let time = fs::metadata(&path).and_then(|data| data.modified()).expect("a time");
        (time, fs::read_to_string(&path).expect("a text"))
    };
    names.iter().map(of).collect()
}

#[test]
fn a_project_plays_its_first_script_with_its_cast_its_models_by_id_and_its_lines() {
    let folder = Folder::new("project-open");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    let view = document.wait_for_view(is_read);
    let scene = scene_of(&view);
    assert_eq!((&*scene.name, &*scene.text), ("main.xml", MAIN));
    assert!(scene.is_current() && scene.project_errors.is_empty() && scene.line_errors.is_empty());
    let plan = scene.plan.as_ref().expect("a plan");
    assert!(plan.thing_called("wide").is_some() && plan.things().iter().all(|thing| !thing.is_missing));
    assert_eq!(plan.length().seconds(), 3.0, "the line is 3 m long");
    document.send(DocumentMessage::ShowScript("end.xml".to_owned()));
    let view = document.wait_for_view(|view| &*scene_of(view).name == "end.xml");
    assert_eq!(scene_of(&view).plan.as_ref().expect("a plan").length().seconds(), 2.0);
    document.send(DocumentMessage::ShowScript("no.xml".to_owned()));
    document.wait_for_reply(|reply| {
        matches!(reply, DocumentReply::Refused(reason) if reason.contains("no.xml")).then_some(())
    });
}

#[test]
fn a_drawn_line_that_changes_moves_the_role_on_it() {
    let folder = Folder::new("project-line");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    document.wait_for_view(is_read);
    document.edit(replaced_in("foxes.lines.xml", LINES, "1 0 0  2 0 0  3 0 0", "2 0 0  4 0 0  6 0 0"));
    let view = document.wait_for_view(|view| view.history.done == 1);
    assert_eq!(scene_of(&view).plan.as_ref().expect("a plan").length().seconds(), 6.0);
    document.edit(replaced_in("foxes.lines.xml", &text_of(&view, "foxes.lines.xml"), "6 0 0", ""));
    let view = document.wait_for_view(|view| view.history.done == 2);
    assert_eq!(scene_of(&view).line_errors.len(), 1);
    assert_eq!(
        scene_of(&view).plan.as_ref().expect("a plan").length().seconds(),
        6.0,
        "the last good line stays"
    );
}

#[test]
fn a_save_writes_only_the_texts_that_changed_and_undo_leads_back_to_all_of_them() {
    let folder = Folder::new("project-save");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    let names = ["foxes.meproj", "main.xml", "end.xml", "foxes.lines.xml"];
    let before = contents(&folder.join(""), &names);
    document.edit(replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""));
    document.save(SaveTo::Own);
    let after = contents(&folder.join(""), &names);
    assert_eq!(after[1].1, MAIN.replace("speed=\"1\"", "speed=\"2\""));
    for index in [0, 2, 3] {
        assert_eq!(after[index], before[index], "{} was not written", names[index]);
    }
    assert!(document.view().history.saved);
    document.edit(replaced(PROJECT, "Two foxes", "Foxes"));
    document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    document.save(SaveTo::Own);
    let last = contents(&folder.join(""), &names);
    assert_eq!(last[0].1, PROJECT.replace("Two foxes", "Foxes"));
    assert_eq!(last[2].1, END.replace("The End", "Fin"));
    assert_eq!((&last[1], &last[3]), (&after[1], &after[3]));
    document.change(Change::GoTo(0));
    document.wait_for_view(|view| view.history.done == 0);
    document.save(SaveTo::Own);
    let texts: Vec<String> = contents(&folder.join(""), &names).into_iter().map(|(_, text)| text).collect();
    assert_eq!(texts, [PROJECT, MAIN, END, LINES]);
}

#[test]
fn a_script_of_a_project_that_another_program_changed_is_not_overwritten_without_a_question() {
    let folder = Folder::new("project-changed");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    document.edit(replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""));
    fs::write(folder.join("main.xml"), END).expect("a file");
    document.send(DocumentMessage::LookAtFile);
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::FileChanged(_)).then_some(()));
    document.send(DocumentMessage::Save(SaveOrder::own(None)));
    let reason = document.wait_for_reply(|reply| match reply {
        DocumentReply::NotSaved(_, reason) => Some(reason.clone()),
        _ => None,
    });
    assert!(matches!(reason, NotSaved::Changed(_)));
    assert_eq!(fs::read_to_string(folder.join("main.xml")).expect("a file"), END);
}

#[test]
fn a_new_text_is_written_with_the_next_save_and_never_over_a_file_that_is_there() {
    let folder = Folder::new("project-new-text");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let path = project(&folder);
    document.open(&path);
    let create = |name: &str| {
        let splices = vec![ScriptSplice { at: 0, old: String::new(), new: END.to_owned() }];
        let text = Some(TextRef::Name(name.to_owned()));
        EditScript { text, create: true, splices, label: None, also: Vec::new() }
    };
    document.edit(create("notes/new.xml").into());
    document.wait_for_view(|view| view.history.done == 1);
    document.save(SaveTo::Own);
    assert_eq!(fs::read_to_string(folder.join("notes/new.xml")).expect("a file"), END);
    for (name, reason) in [("main.xml", "already"), ("../out.xml", "leads out"), ("/out.xml", "absolute")] {
        document.edit(create(name).into());
        document.wait_for_reply(|reply| {
            matches!(reply, DocumentReply::Refused(text) if text.contains(reason)).then_some(())
        });
    }
    fs::write(folder.join("there.xml"), "of another program").expect("a file");
    document.edit(create("there.xml").into());
    document.send(DocumentMessage::Save(SaveOrder::own(None)));
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::NotSaved(..)).then_some(()));
    assert_eq!(fs::read_to_string(folder.join("there.xml")).expect("a file"), "of another program");
}

/// Opens the project after a kill, with a copy of the journals, and restores the offered work.
pub(super) fn restored(path: &Path, autosave: &Path) -> TestDocument {
    let mut document = TestDocument::new(autosave);
    document.open(path);
    let offer = document.wait_for_offers().remove(0);
    document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    document
}

#[test]
fn edits_of_several_texts_come_back_after_a_kill_also_after_a_save_that_left_the_project_as_it_was() {
    let folder = Folder::new("project-kill");
    let path = project(&folder);
    let autosave = folder.join("autosave");
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.edit(replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""));
    document.save(SaveTo::Own);
    document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    document.edit(replaced(PROJECT, "Two foxes", "Foxes"));
    document.wait_for_view(|view| view.history.done == 3);
    copy_after_kill(&autosave, &folder.join("killed"));
    let mut again = restored(&path, &folder.join("killed"));
    let view = again.wait_for_view(|view| view.history.done == 3);
    assert_eq!(text_of(&view, "end.xml"), END.replace("The End", "Fin"));
    assert_eq!(text_of(&view, "foxes.meproj"), PROJECT.replace("Two foxes", "Foxes"));
    assert_eq!(view.history.saved_at, Some(1));
    again.change(Change::GoTo(0));
    let view = again.wait_for_view(|view| view.history.done == 0);
    assert_eq!(text_of(&view, "main.xml"), MAIN);
}

#[test]
fn a_project_with_errors_is_opened_to_be_corrected_and_a_missing_script_is_reported() {
    let folder = Folder::new("project-errors");
    let path = project(&folder);
    fs::remove_file(folder.join("end.xml")).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let view = document.open(&path);
    assert!(view.loaded.warnings[0].contains("end.xml"), "{:?}", view.loaded.warnings);
    document.edit(replaced(PROJECT, "<models>", "<modles>"));
    let view = document.wait_for_view(|view| view.history.done == 1);
    assert!(!scene_of(&view).project_errors.is_empty() && &*scene_of(&view).text == MAIN);
    assert!(!scene_of(&view).is_current(), "the newest project does not play");
    let broken = folder.join("broken.meproj");
    fs::write(&broken, "<project version=\"1\"").expect("a file");
    let view = document.open(&broken);
    assert_eq!(scene_of(&view).project_errors.len(), 1);
}
