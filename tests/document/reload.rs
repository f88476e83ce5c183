//! A file that another program changed is opened again with the unsaved edits: they are steps of the new document, are in its journal,
//! and are saved into the new file.

use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::Edit;
use dragonfly_document::{
    Cancel, Change, Decision, DocumentMessage, DocumentReply, Editable, FaultInjection, FaultPlan, SaveTo,
    Setup, Source, Then, UnfitEdit, View,
};
use dragonfly_kit::document::new_version::{new_version, rename_nodes, reverse};
use dragonfly_kit::document::test_document::{
    TestDocument, autosave_in, copy_after_kill, fox, same_takes, turn,
};
use dragonfly_kit::folder::Folder;
use glam::Quat;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

fn edit(line: &str) -> Edit {
    serde_json::from_str(line).expect(line)
}

/// Writes a new version of the file: everything in another order, and a bone with another name.
fn change_file(path: &Path) -> Vec<u8> {
    let bytes = new_version(&fs::read(path).expect("a file"), |json| {
        reverse(json);
        rename_nodes(json, "b_Tail03_014", "b_TailTip");
    });
    fs::write(path, &bytes).expect("a file");
    bytes
}

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

/// Returns the rotation of a bone at the first key at 0.5 s of a take.
fn rotation(view: &View, take: &str, bone: &str) -> Quat {
    let take = view.takes.iter().find(|found| found.name == take).expect("the take");
    let bone = view.loaded.model.animation.skeleton.find(bone).expect("the bone");
    let channel = &take.tracks[bone as usize].rotation;
    let at = channel.times.iter().position(|time| (time - 0.5).abs() < 1e-4).expect("a key");
    channel.values[at]
}

/// Opens Fox and makes three edits of it: the head, a take, the tip of the tail.
fn edited(folder: &Folder, path: &Path) -> TestDocument {
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(path);
    document.edit(turn(0.4));
    document.edit(edit(r#"{"edit":"rename_take","take":2,"name":"Sprint"}"#));
    document.edit(edit(
        r#"{"edit":"set","take":2,"time":0.5,"poses":[{"bone":"b_Tail03_014","rotation":[0,0,0.5,0.5]}]}"#,
    ));
    document.edit(edit(
        r#"{"edit":"set","take":2,"time":0.5,"poses":[{"bone":"b_Neck_04","rotation":[0.5,0,0,0.5]}]}"#,
    ));
    document.wait_for_view(|view| view.history.done == 4);
    document
}

#[test]
fn unsaved_edits_are_steps_of_the_new_file_and_are_saved_into_it() {
    let folder = Folder::new("reload-saved");
    let path = fox(&folder);
    let mut document = edited(&folder, &path);
    let before = document.view();
    let new = change_file(&path);
    let (after, unfit) = reload(&mut document);
    assert_eq!(
        unfit.iter().map(ToString::to_string).collect::<Vec<_>>(),
        [r#"Rotate (b_Tail03_014, Sprint, at 0.5 s): the new version has no bone "b_Tail03_014""#]
    );
    assert_eq!((after.history.done, after.history.saved), (3, false));
    let names: Vec<_> = after.takes.iter().map(|take| take.name.clone()).collect();
    assert_eq!(names, ["Sprint", "Walk", "Survey"], "the order of the new file");
    for (take, bone) in [("Survey", "b_Head_05"), ("Sprint", "b_Neck_04")] {
        assert_eq!(rotation(&after, take, bone), rotation(&before, take, bone), "{bone}");
    }
    // Undo of everything is the new file, byte for byte, and redo restores the edits.
    document.change(Change::GoTo(0));
    let undone = document.wait_for_view(|view| view.history.done == 0);
    assert!(undone.history.saved);
    document.save(SaveTo::Copy(folder.join("undone.glb")));
    assert!(fs::read(folder.join("undone.glb")).expect("a file") == new);
    document.change(Change::GoTo(3));
    document.wait_for_view(|view| view.history.done == 3);
    document.save(SaveTo::Own);
    document.end();
    let mut again = TestDocument::new(&folder.join("other"));
    let saved = again.open(&path);
    for (take, bone) in [("Survey", "b_Head_05"), ("Sprint", "b_Neck_04")] {
        assert_eq!(rotation(&saved, take, bone), rotation(&before, take, bone), "{bone}");
    }
    assert!(saved.loaded.model.animation.skeleton.find("b_TailTip").is_some());
}

#[test]
fn the_journal_after_it_restores_the_edits_in_the_new_file() {
    let folder = Folder::new("reload-journal");
    let path = fox(&folder);
    let mut document = edited(&folder, &path);
    change_file(&path);
    let (view, _) = reload(&mut document);
    copy_after_kill(&folder.join("autosave"), &folder.join("killed"));
    let mut after = TestDocument::new(&folder.join("killed"));
    after.open(&path);
    let mut offers = after.wait_for_offers();
    assert_eq!(offers.len(), 1, "the old journal is in the bin");
    assert_eq!(offers[0].steps, 3);
    after.send(DocumentMessage::Decide(Box::new(offers.remove(0)), Decision::Keep));
    same_takes(&after.wait_for_view(|view| view.history.done == 3), &view);
    assert_eq!(fs::read_dir(folder.join("killed").join("bin")).expect("a bin").count(), 1);
    // Edits after it are recorded, too.
    document.edit(turn(0.8));
    let view = document.wait_for_view(|view| view.history.done == 4);
    copy_after_kill(&folder.join("autosave"), &folder.join("later"));
    let mut after = TestDocument::new(&folder.join("later"));
    after.open(&path);
    let offer = after.wait_for_offers().remove(0);
    after.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    same_takes(&after.wait_for_view(|view| view.history.done == 4), &view);
}

#[test]
fn only_edits_since_the_last_save_are_applied_and_poses_that_are_pending_stay_pending() {
    let folder = Folder::new("reload-since");
    let path = fox(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    document.edit(edit(
        r#"{"edit":"offset","take":0,"time":0.5,"poses":[{"bone":"b_Head_05","translation":[1,0,0]}]}"#,
    ));
    document.edit(edit(
        r#"{"edit":"pend","take":0,"time":0.7,"poses":[{"bone":"b_Neck_04","rotation":[0.5,0,0,0.5]}]}"#,
    ));
    document.save(SaveTo::Own);
    let saved = document.view();
    document.edit(edit(r#"{"edit":"rename_take","take":1,"name":"Stroll"}"#));
    change_file(&path);
    let (after, unfit) = reload(&mut document);
    assert_eq!((unfit.len(), after.history.done), (0, 2), "the pending pose and the new name");
    assert_eq!(rotation(&after, "Survey", "b_Head_05"), rotation(&saved, "Survey", "b_Head_05"));
    let survey = after.slots.iter().find(|slot| slot.original.name == "Survey").expect("the take");
    let neck = after.loaded.model.animation.skeleton.find("b_Neck_04").expect("the bone");
    assert_eq!(survey.pending().len(), 1);
    assert!(survey.pending()[0].of(neck).is_some());
}

#[test]
fn undone_steps_that_were_saved_are_listed_and_the_edits_after_them_are_applied_once() {
    let folder = Folder::new("reload-undone");
    let path = fox(&folder);
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open(&path);
    let offset = |x: f32| {
        let pose = format!(r#"[{{"bone":"b_Head_05","translation":[{x},0,0]}}]"#);
        edit(&format!(r#"{{"edit":"offset","take":0,"time":0.5,"poses":{pose}}}"#))
    };
    document.edit(offset(1.0));
    document.edit(offset(10.0));
    document.save(SaveTo::Own);
    let saved = document.view();
    document.change(Change::Undo);
    document.edit(offset(100.0));
    document.wait_for_view(|view| view.history.done == 2 && view.generation > saved.generation);
    change_file(&path);
    let (after, unfit) = reload(&mut document);
    assert_eq!(unfit.len(), 1);
    assert!(unfit[0].to_string().starts_with("Undo: "), "{}", unfit[0]);
    let place = |view: &View| {
        let take = view.takes.iter().find(|take| take.name == "Survey").expect("the take");
        let bone = view.loaded.model.animation.skeleton.find("b_Head_05").expect("the bone");
        let channel = &take.tracks[bone as usize].translation;
        channel.values[channel.times.iter().position(|time| (time - 0.5).abs() < 1e-4).expect("a key")].x
    };
    assert!((place(&after) - place(&saved) - 100.0).abs() < 1e-3, "{} and {}", place(&saved), place(&after));
}

#[test]
fn a_file_that_cannot_be_read_leaves_the_document_and_its_edits_as_they_are() {
    let folder = Folder::new("reload-broken");
    let path = fox(&folder);
    let mut document = edited(&folder, &path);
    let before = document.view();
    fs::write(&path, "no model").expect("a file");
    document.send(DocumentMessage::Reload);
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::Failed { .. }).then_some(()));
    let after = document.view();
    same_takes(&after, &before);
    assert_eq!((after.history.done, after.history.saved), (4, false));
}

#[test]
fn a_document_without_a_file_has_nothing_to_load_again() {
    let folder = Folder::new("reload-none");
    let mut document = TestDocument::new(&folder.join("autosave"));
    document.open_source(Source::BuiltIn);
    document.send(DocumentMessage::Reload);
    let reason = document.wait_for_reply(|reply| match reply {
        DocumentReply::Refused(reason) => Some(reason.clone()),
        _ => None,
    });
    assert_eq!(reason, "The document was never saved, so there is no file to load again");
}

#[test]
fn a_new_version_for_the_tests_has_the_same_takes_in_another_order() {
    let folder = Folder::new("reload-version");
    let path = fox(&folder);
    let open = || Editable::open(&Source::File(path.clone()), &Cancel::default()).expect("a model");
    let old = open();
    change_file(&path);
    let new = open();
    let names = |editable: &Editable| -> Vec<String> {
        ModelAdapter::of(&editable.model).slots().iter().map(|slot| slot.original.name.clone()).collect()
    };
    assert_eq!(names(&old).into_iter().rev().collect::<Vec<_>>(), names(&new));
    let bones = |editable: &Editable| -> Vec<String> {
        editable.model.animation.skeleton.bones.iter().map(|bone| bone.name.clone()).collect()
    };
    assert_ne!(bones(&old), bones(&new));
}

/// A fault plan by which no job that reads a file starts while it is set.
#[derive(Debug, Default)]
struct RefusedReads(AtomicBool);

impl FaultPlan for RefusedReads {
    fn refuses_read(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

#[test]
fn work_whose_file_could_not_be_read_again_is_not_discarded() {
    let folder = Folder::new("reload-refused");
    let path = fox(&folder);
    let refused = Arc::new(RefusedReads::default());
    let faults = FaultInjection::new(Arc::clone(&refused) as _);
    let autosave = Some(autosave_in(&folder.join("autosave")));
    let mut document = TestDocument::with(Setup { faults, autosave, ..Setup::default() });
    document.open(&path);
    document.edit(turn(0.4));
    refused.0.store(true, Ordering::Relaxed);
    // The two messages that the editor sends for "Reload".
    document.send(DocumentMessage::DoNotSave);
    document.send(DocumentMessage::Open { source: Source::File(path), anyway: true });
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::Failed { .. }).then_some(()));
    document.send(DocumentMessage::Quit);
    let asks = document.wait_for_reply(|reply| match reply {
        DocumentReply::Unsaved(Then::Quit) => Some(true),
        DocumentReply::MayQuit => Some(false),
        _ => None,
    });
    assert!(asks, "the work is still there");
}
