//! A script that another program changed is opened again with the unsaved edits: those that do not touch the changed lines are moved to
//! their new places, the others are listed.

use super::scenes::{SCENE, replaced, scene, scene_of};
use dragonfly_anim::data::ModelData;
use dragonfly_anim::stage::script::MOST_BYTES;
use dragonfly_document::adapter::{ModelAdapter, TextFiles};
use dragonfly_document::edit::{Edit, EditScript, ScriptSplice, TextRef};
use dragonfly_document::{Change, DocumentMessage, DocumentReply, Rebase, Rebased, SaveTo, UnfitEdit, View};
use dragonfly_kit::document::test_document::TestDocument;
use dragonfly_kit::folder::Folder;
use std::fs;

/// Opens the file again with the unsaved edits. Returns the view after it and the edits that do not fit.
fn reload(document: &mut TestDocument) -> (View, Vec<UnfitEdit>) {
    document.send(DocumentMessage::Reload);
    let unfit = document.wait_for_reply(|reply| match reply {
        DocumentReply::Rebased(unfit) => Some(unfit.clone()),
        DocumentReply::Failed { reason, .. } => panic!("{reason}"),
        _ => None,
    });
    (document.view(), unfit)
}

#[test]
fn edits_of_other_lines_are_moved_to_the_new_text_and_are_steps_of_it() {
    let folder = Folder::new("scene-merge");
    let path = scene(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.edit(replaced(SCENE, "Walk", "Run"));
    document.edit(replaced(&SCENE.replace("Walk", "Run"), "begin=\"1\"", "begin=\"2.5\""));
    document.wait_for_view(|view| view.history.done == 2);
    // Another program writes a longer comment above, and a title at the end.
    let outside = |text: &str| {
        text.replace("<!-- Füchse -->", "<!-- Füchse, die laufen -->\r\n  <!-- und rollen -->")
            .replace("</script>", "  <title text=\"Ende\" dur=\"1\"/>\r\n</script>")
    };
    fs::write(&path, outside(SCENE)).expect("a file");
    let (view, unfit) = reload(&mut document);
    assert_eq!(unfit, []);
    let own = |text: &str| text.replace("Walk", "Run").replace("begin=\"1\"", "begin=\"2.5\"");
    assert_eq!(*scene_of(&view).text, *own(&outside(SCENE)));
    assert_eq!(view.history.done, 2);
    document.change(Change::GoTo(0));
    let view = document.wait_for_view(|view| view.history.done == 0);
    assert!(view.history.saved && *scene_of(&view).text == *outside(SCENE));
    document.change(Change::GoTo(2));
    document.save(SaveTo::Own);
    assert_eq!(fs::read_to_string(&path).expect("a file"), own(&outside(SCENE)));
}

#[test]
fn an_edit_of_a_changed_line_is_listed_with_its_line_and_the_others_are_applied() {
    let folder = Folder::new("scene-conflict");
    let path = scene(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let mut text = SCENE.to_owned();
    for (old, new) in [("Walk", "Run"), ("\"Run\"", "\"Run\" fade-in=\"0.2\""), ("Roll", "Jump")] {
        document.edit(replaced(&text, old, new));
        text = text.replacen(old, new, 1);
    }
    document.wait_for_view(|view| view.history.done == 3);
    fs::write(&path, SCENE.replace("Walk", "Survey")).expect("a file");
    let (view, unfit) = reload(&mut document);
    let listed: Vec<String> = unfit.iter().map(ToString::to_string).collect();
    let line = "Edit script: line 8 of scene.xml is another one in the new version";
    assert_eq!(listed, [line, line]);
    assert_eq!(*scene_of(&view).text, *SCENE.replace("Walk", "Survey").replace("Roll", "Jump"));
    assert_eq!(view.history.done, 1);
}

#[test]
fn the_same_change_on_both_sides_is_neither_listed_nor_made_twice() {
    let texts =
        |text: &str| ModelAdapter::of(&ModelData::default()).with_texts(TextFiles::one("scene.xml", text));
    let run = SCENE.replace("Walk", "Run");
    let mut rebase = Rebase::new(texts(SCENE), texts(&run));
    rebase.apply(0, &replaced(SCENE, "Walk", "Run")).expect("it fits the old text");
    rebase.apply(1, &replaced(&run, "Roll", "Jump")).expect("it fits the old text");
    rebase.apply(2, &replaced(&run, "\"Run\"", "\"Survey\"")).expect("it fits the old text");
    let done = rebase.finish();
    assert_eq!(done.unfit, []);
    let text = done.edited.adapter().texts().main().cloned().expect("a text");
    assert_eq!(*text, *run.replace("Roll", "Jump").replace("\"Run\"", "\"Survey\""));
}

/// Returns what is left of edits of one version of some texts in another version of them.
fn merged(old: &TextFiles, new: &TextFiles, edits: &[Edit]) -> Rebased {
    let model = |texts: &TextFiles| ModelAdapter::of(&ModelData::default()).with_texts(texts.clone());
    let mut rebase = Rebase::new(model(old), model(new));
    for (number, edit) in edits.iter().enumerate() {
        rebase.apply(number, edit).expect("it fits the old text");
    }
    rebase.finish()
}

fn script_edit(edit: Edit) -> EditScript {
    let Edit::EditScript(edit) = edit else { panic!("another edit") };
    edit
}

#[test]
fn an_edit_that_the_new_text_has_no_room_for_moves_no_later_edit_to_another_place() {
    let room = "<!-- a long remark -->".repeat(100);
    let old = TextFiles::one("scene.xml", SCENE);
    let long = format!("{SCENE}<!--{}-->", " ".repeat(MOST_BYTES - SCENE.len() - 1000));
    let new = TextFiles::one("scene.xml", long.as_str());
    let grown = SCENE.replacen("Walk", &room, 1);
    let edits = [replaced(SCENE, "Walk", &room), replaced(&grown, "Roll", "Jump")];
    let done = merged(&old, &new, &edits);
    assert_eq!(done.unfit.len(), 1, "{:?}", done.unfit);
    assert!(!done.unfit[0].applied_in_part && done.unfit[0].number == 0);
    let text = done.edited.adapter().texts().main().cloned().expect("a text");
    assert!(*text == *long.replacen("Roll", "Jump", 1));
}

#[test]
fn two_parts_of_one_edit_may_change_the_same_text() {
    let old = TextFiles::one("scene.xml", SCENE);
    let new = TextFiles::one("scene.xml", SCENE.replace("<cast>", "<!-- all of them -->\r\n  <cast>"));
    let first = SCENE.replacen("Füchse", "Fuchs und noch einer", 1);
    let edit = EditScript {
        also: vec![script_edit(replaced(&first, "Roll", "Jump"))],
        ..script_edit(replaced(SCENE, "Füchse", "Fuchs und noch einer"))
    };
    let done = merged(&old, &new, &[edit.into()]);
    assert_eq!(done.unfit, []);
    let text = done.edited.adapter().texts().main().cloned().expect("a text");
    let wanted = new.main().expect("a text").replacen("Füchse", "Fuchs und noch einer", 1);
    assert_eq!(*text, *wanted.replacen("Roll", "Jump", 1));
}

#[test]
fn texts_that_one_edit_creates_are_merged_each_by_itself() {
    let create = |name: &str, text: &str| EditScript {
        text: Some(TextRef::Name(name.to_owned())),
        create: true,
        splices: vec![ScriptSplice { at: 0, old: String::new(), new: text.to_owned() }],
        label: None,
        also: Vec::new(),
    };
    let old = TextFiles::one("scene.xml", SCENE);
    let new = TextFiles::one("scene.xml", SCENE.replace("Walk", "Run"));
    let both = EditScript { also: vec![create("b.xml", "one b")], ..create("a.xml", "one a") };
    let change = |name: &str, old: &str, new: &str| {
        let edit = script_edit(replaced(old, "one", new));
        Edit::from(EditScript { text: Some(TextRef::Name(name.to_owned())), ..edit })
    };
    let edits = [both.into(), change("a.xml", "one a", "first"), change("b.xml", "one b", "second")];
    let done = merged(&old, &new, &edits);
    assert_eq!(done.unfit, []);
    let texts = done.edited.adapter().texts();
    let text = |name: &str| texts.called(name).map(|file| file.text.to_string());
    assert_eq!([text("a.xml"), text("b.xml")].map(Option::unwrap_or_default), ["first a", "second b"]);
}
