//! Saves of projects that fail or go elsewhere, and what their texts say about models and lines.

use super::projects::{END, LINES, MAIN, PROJECT, is_read, project, replaced_in, restored, text_of};
use super::scenes::{replaced, scene_of};
use dragonfly_document::edit::{Edit, EditScript, ScriptLabel, ScriptSplice, TextRef};
use dragonfly_document::protocol::Session;
use dragonfly_document::{
    Cancel, Change, DocumentMessage, DocumentReply, Editable, NotSaved, SaveOrder, SaveTo, SceneModel,
    Source, paths_of_renamed_line,
};
use dragonfly_kit::document::test_document::{TestDocument, copy_after_kill};
use dragonfly_kit::folder::Folder;
use serde_json::Value;
use std::fs;

fn create(name: &str) -> Edit {
    let splices = vec![ScriptSplice { at: 0, old: String::new(), new: END.to_owned() }];
    let text = Some(TextRef::Name(name.to_owned()));
    EditScript { text, create: true, splices, label: None, also: Vec::new() }.into()
}

/// Saves, and returns the reason why it failed.
fn not_saved(document: &mut TestDocument, order: SaveOrder) -> NotSaved {
    document.send(DocumentMessage::Save(order));
    document.wait_for_reply(|reply| match reply {
        DocumentReply::NotSaved(_, reason) => Some(reason.clone()),
        DocumentReply::Saved(saved) => panic!("{saved:?}"),
        _ => None,
    })
}

#[test]
fn a_save_that_failed_after_some_texts_were_written_takes_them_for_its_own() {
    let folder = Folder::new("project-partly");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    let two = MAIN.replace("speed=\"1\"", "speed=\"2\"");
    document.edit(replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""));
    document.edit(create("notes/new.xml"));
    fs::write(folder.join("notes"), "no folder").expect("a file");
    assert!(matches!(not_saved(&mut document, SaveOrder::own(None)), NotSaved::Failed(_)));
    assert_eq!(fs::read_to_string(folder.join("main.xml")).expect("a file"), two, "it was written before");
    document.send(DocumentMessage::LookAtFile);
    document.view();
    assert!(!document.has_reply(|reply| matches!(reply, DocumentReply::FileChanged(_))));
    // An undone text is written again, although the last whole save had it.
    document.change(Change::GoTo(0));
    document.wait_for_view(|view| view.history.done == 0);
    document.save(SaveTo::Own);
    assert_eq!(fs::read_to_string(folder.join("main.xml")).expect("a file"), MAIN);
    document.change(Change::GoTo(2));
    document.wait_for_view(|view| view.history.done == 2);
    fs::remove_file(folder.join("notes")).expect("a file");
    document.save(SaveTo::Own);
    assert_eq!(fs::read_to_string(folder.join("notes/new.xml")).expect("a file"), END);
}

#[test]
fn nothing_is_written_where_another_program_changed_one_of_the_files() {
    let folder = Folder::new("project-unwritten");
    let path = project(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.edit(replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""));
    document.edit(replaced(PROJECT, "Two foxes", "Foxes"));
    fs::write(&path, PROJECT.replace("Two", "Three")).expect("a file");
    let reason = not_saved(&mut document, SaveOrder::own(None));
    assert!(matches!(&reason, NotSaved::Changed(changed) if changed.ends_with("foxes.meproj")), "{reason:?}");
    assert_eq!(fs::read_to_string(folder.join("main.xml")).expect("a file"), MAIN);
}

#[test]
fn a_file_that_a_new_text_replaces_on_request_is_the_only_one_that_is_not_checked() {
    let folder = Folder::new("project-replace");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    document.edit(replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""));
    document.edit(create("there.xml"));
    fs::write(folder.join("there.xml"), "of another program").expect("a file");
    let NotSaved::Exists(path) = not_saved(&mut document, SaveOrder::own(None)) else {
        panic!("another reason")
    };
    let order = SaveOrder { replaces: vec![path], ..SaveOrder::own(None) };
    fs::write(folder.join("main.xml"), "of another program").expect("a file");
    assert!(matches!(not_saved(&mut document, order.clone()), NotSaved::Changed(_)));
    assert_eq!(fs::read_to_string(folder.join("main.xml")).expect("a file"), "of another program");
    fs::write(folder.join("main.xml"), MAIN).expect("a file");
    document.send(DocumentMessage::Save(order));
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::Saved(_)).then_some(()));
    assert_eq!(fs::read_to_string(folder.join("there.xml")).expect("a file"), END);
}

#[test]
fn a_decision_to_replace_a_file_does_not_hold_for_one_that_the_project_has_read() {
    let folder = Folder::new("project-decided");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    document.edit(replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""));
    // Both were read, so that a change of them is asked about; the decided one does not hide the other one.
    for changed in ["main.xml", "end.xml"] {
        fs::write(folder.join(changed), "of another program").expect("a file");
        let order = SaveOrder { replaces: vec![folder.join("end.xml")], ..SaveOrder::own(None) };
        let reason = not_saved(&mut document, order);
        assert!(matches!(&reason, NotSaved::Changed(path) if path.ends_with(changed)), "{reason:?}");
        fs::write(folder.join(changed), if changed == "main.xml" { MAIN } else { END }).expect("a file");
    }
}

#[test]
fn a_project_that_was_deleted_is_written_again_with_a_script_of_it_that_was_edited() {
    let folder = Folder::new("project-deleted");
    let path = project(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.edit(replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""));
    fs::remove_file(&path).expect("it is there");
    let saved = document.save(SaveTo::Own);
    assert_eq!(saved.beside, 1);
    assert_eq!(fs::read_to_string(&path).expect("it counts as saved"), PROJECT);
    assert!(document.view().history.saved);
    // While it is there, it stays as it is, and only the script is written.
    document.change(Change::Undo);
    let before = fs::metadata(&path).and_then(|data| data.modified()).expect("a time");
    assert_eq!(document.save(SaveTo::Own).beside, 1);
    assert_eq!(fs::metadata(&path).and_then(|data| data.modified()).expect("a time"), before);
    assert_eq!(fs::read_to_string(folder.join("main.xml")).expect("a file"), MAIN);
}

#[test]
fn a_session_lists_exactly_the_files_that_its_save_wrote() {
    let folder = Folder::new("project-written");
    let path = project(&folder);
    let editable = Editable::open(&Source::File(path.clone()), &Cancel::default()).expect("a project");
    let mut session = Session::new(editable);
    let mut written_after = |edit: &Edit| {
        let edit = serde_json::json!({"do": "edit", "edit": edit});
        session.answer(&edit.to_string()).expect("an answer");
        let answer = session.answer(r#"{"do":"save"}"#).expect("an answer");
        let answer: Value = serde_json::from_str(&answer).expect("JSON");
        answer["ok"]["written"].clone()
    };
    let script = folder.join("main.xml");
    let edit = replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\"");
    assert_eq!(written_after(&edit), serde_json::json!([script]), "the project stays as it is");
    assert_eq!(written_after(&replaced(PROJECT, "Two foxes", "Foxes")), serde_json::json!([path]));
}

#[test]
fn a_project_that_is_saved_in_another_folder_plays_the_models_of_that_folder() {
    let folder = Folder::new("project-moved");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    document.wait_for_view(is_read);
    fs::create_dir(folder.join("other")).expect("a folder");
    let saved = document.save(SaveTo::As(folder.join("other/foxes.meproj")));
    assert!(saved.notices.is_empty(), "{saved:?}");
    fs::remove_file(folder.join("models/Fox.glb")).expect("it is there");
    document.wait_for_view(is_read);
    document.send(DocumentMessage::EditModel("fox".to_owned()));
    let view = document.wait_for_view(|view| view.scene.is_none());
    assert!(view.file.path.as_ref().is_some_and(|path| path.to_string_lossy().contains("other/models")));
}

#[test]
fn a_project_that_is_saved_in_its_own_folder_by_another_path_gets_no_notice_about_its_models() {
    let folder = Folder::new("project-same-folder");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&project(&folder));
    document.wait_for_view(is_read);
    let saved = document.save(SaveTo::As(folder.join("models/../foxes.meproj")));
    assert!(saved.notices.is_empty(), "{saved:?}");
    document.wait_for_view(|view| view.file.title == "foxes.meproj" && is_read(view));
}

#[test]
fn edits_made_while_a_save_leaves_the_project_as_it_is_are_offered_after_a_kill() {
    let folder = Folder::new("project-newer");
    let path = project(&folder);
    let autosave = folder.join("autosave");
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.edit(replaced_in("main.xml", MAIN, "speed=\"1\"", "speed=\"2\""));
    // Both are handled before the job of the save has ended.
    document.send(DocumentMessage::Save(SaveOrder::own(None)));
    document.edit(replaced_in("end.xml", END, "The End", "Fin"));
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::Saved(_)).then_some(()));
    document.wait_for_view(|view| view.history.done == 2 && view.history.saved_at == Some(1));
    copy_after_kill(&autosave, &folder.join("killed"));
    let mut again = restored(&path, &folder.join("killed"));
    let view = again.wait_for_view(|view| view.history.done == 2);
    assert_eq!((text_of(&view, "end.xml"), view.history.saved_at), (END.replace("The End", "Fin"), Some(1)));
}

#[test]
fn units_and_axes_of_a_model_in_the_project_are_those_with_which_it_is_read() {
    let folder = Folder::new("project-conventions");
    let path = project(&folder);
    let obj = "v 0 0 0\nv 1 0 0\nv 0 0 2\nf 1 2 3\n";
    fs::write(folder.join("models/box.obj"), obj).expect("a file");
    let models = "<model id=\"box\" src=\"models/box.obj\" scale=\"0.5\" up=\"z\"/>";
    fs::write(&path, PROJECT.replace("</models>", &format!("{models}</models>"))).expect("a file");
    fs::write(folder.join("main.xml"), MAIN.replace("</cast>", "<prop id=\"b\" model=\"box\"/></cast>"))
        .expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let view = document.wait_for_view(is_read);
    let Some(SceneModel::Loaded(model)) = scene_of(&view).models.get("box") else {
        panic!("it is not there")
    };
    // 2 units of the file upwards, half a meter each.
    assert!((model.bounds.max.y - 1.0).abs() < 1e-5, "{:?}", model.bounds);
    document.send(DocumentMessage::EditModel("box".to_owned()));
    let view = document.wait_for_view(|view| view.scene.is_none());
    assert!((view.loaded.bounds.max.y - 1.0).abs() < 1e-5, "{:?}", view.loaded.bounds);
}

#[test]
fn a_line_that_gets_another_name_takes_its_paths_along_in_one_step() {
    let folder = Folder::new("project-rename-line");
    let path = project(&folder);
    let text = PROJECT.replace("</cast>", "  <path id=\"all\" line=\"aisle\"/>\n  </cast>");
    fs::write(&path, &text).expect("a file");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let view = document.wait_for_view(is_read);
    let paths = paths_of_renamed_line(scene_of(&view), "aisle", "row", ScriptLabel::Rename).expect("edits");
    let Edit::EditScript(edit) = replaced_in("foxes.lines.xml", LINES, "aisle", "row") else {
        panic!("another edit")
    };
    document.edit(EditScript { also: paths, ..edit }.into());
    let view = document.wait_for_view(|view| view.history.done == 1);
    assert!(scene_of(&view).is_current(), "{:?}", scene_of(&view).errors);
    assert_eq!(text_of(&view, "main.xml"), MAIN.replace("aisle", "row"));
    assert_eq!(text_of(&view, "foxes.meproj"), text.replace("aisle", "row"));
    document.change(Change::Undo);
    let view = document.wait_for_view(|view| view.history.done == 0);
    assert_eq!(text_of(&view, "main.xml"), MAIN);
    document.edit(replaced_in("main.xml", MAIN, "<path ", "<pth "));
    let view = document.wait_for_view(|view| view.history.done == 1);
    assert!(
        paths_of_renamed_line(scene_of(&view), "aisle", "row", ScriptLabel::Rename).is_err(),
        "its paths are not known"
    );
}
