//! Saving in the document's thread: the same bytes as the command line writes, nothing overwritten without being asked, and
//! the journal follows the file.

use crate::program::run;
use dragonfly_document::edit::Edit;
use dragonfly_document::{
    Change, DocumentMessage, DocumentReply, NotSaved, SaveOrder, SaveTo, Setup, Source, Then,
};
use dragonfly_kit::document::test_document::{
    TestDocument, autosave_in, copy_after_kill, fox, rename, same_takes, turn,
};
use dragonfly_kit::folder::{Folder, data};
use dragonfly_store::{FileState, RealFiles};
use std::fs;
use std::path::Path;

/// Orders a save that is refused. Returns the reason.
#[track_caller]
fn refused(desk: &mut TestDocument, to: SaveTo) -> NotSaved {
    desk.send(DocumentMessage::Save(SaveOrder { to, ..SaveOrder::own(None) }));
    desk.wait_for_reply(|reply| match reply {
        DocumentReply::NotSaved(_, reason) => Some(reason.clone()),
        DocumentReply::Saved(saved) => panic!("{saved:?}"),
        _ => None,
    })
}

/// Orders a save that overwrites any existing file.
#[track_caller]
fn anyway(desk: &mut TestDocument, to: SaveTo) {
    desk.send(DocumentMessage::Save(SaveOrder { to, anyway: true, ..SaveOrder::own(None) }));
    desk.wait_for_reply(|reply| matches!(reply, DocumentReply::Saved(_)).then_some(()));
}

fn written(folder: &Folder, edits: &[Edit]) -> String {
    let lines: Vec<String> = edits.iter().map(|edit| serde_json::to_string(edit).unwrap()).collect();
    let path = folder.join("edits.jsonl");
    fs::write(&path, lines.join("\n")).unwrap();
    path.display().to_string()
}

#[test]
fn a_save_writes_what_the_command_line_writes_and_announces_the_same_changes() {
    let folder = Folder::new("saving-same");
    let path = fox(&folder);
    let edits = [turn(0.5), rename("Look around"), turn(0.7)];
    let lines = written(&folder, &edits);
    let file = path.to_str().unwrap();
    let out = folder.join("out.glb");
    run(["edit", file, "--edits", &lines, "-o", out.to_str().unwrap()]).expect(0);
    let announced = run(["edit", file, "--edits", &lines, "--dry-run"]).expect(0).text().to_owned();

    let mut desk = TestDocument::new(&folder.join("autosave"));
    desk.open(&path);
    edits.into_iter().for_each(|edit| desk.edit(edit));
    desk.send(DocumentMessage::Plan(None));
    let plan = desk.wait_for_reply(|reply| match reply {
        DocumentReply::Plan(plan, None) => Some(plan.clone()),
        _ => None,
    });
    assert_eq!(plan, Ok(announced));
    let saved = desk.save(SaveTo::Own);
    assert!(fs::read(&path).unwrap() == fs::read(&out).unwrap());
    assert_eq!((saved.copy, saved.beside), (false, 0));
    assert!(desk.view().history.saved);
    desk.send(DocumentMessage::Plan(None));
    let plan = desk.wait_for_reply(|reply| match reply {
        DocumentReply::Plan(plan, None) => Some(plan.clone()),
        _ => None,
    });
    assert_eq!(plan, Ok("nothing changes\n".to_owned()));
}

#[test]
fn a_file_changed_elsewhere_is_overwritten_only_on_request_with_a_backup() {
    let folder = Folder::new("saving-changed");
    let (path, autosave) = (fox(&folder), folder.join("autosave"));
    let mut desk = TestDocument::new(&autosave);
    desk.open(&path);
    desk.edit(turn(0.5));
    desk.send(DocumentMessage::LookAtFile);
    let other = fs::read(data("gltf/Fox_skeleton.glb")).unwrap();
    desk.view();
    assert!(
        !desk.unread_replies().iter().any(|said| said.contains("FileChanged")),
        "no other program changed it"
    );
    fs::write(&path, &other).unwrap();
    // Reported once, however often the window gets the focus.
    for _ in 0..3 {
        desk.send(DocumentMessage::LookAtFile);
    }
    desk.wait_for_reply(|reply| {
        matches!(reply, DocumentReply::FileChanged(FileState::Changed)).then_some(())
    });
    desk.view();
    assert!(!desk.unread_replies().iter().any(|said| said.contains("FileChanged")));
    assert!(matches!(refused(&mut desk, SaveTo::Own), NotSaved::Changed(_)));
    assert!(fs::read(&path).unwrap() == other);
    assert!(!desk.view().history.saved);
    anyway(&mut desk, SaveTo::Own);
    assert!(fs::read(&path).unwrap() != other);
    let versions = autosave_in(&autosave).versions().of(&RealFiles, &path).unwrap();
    assert!(fs::read(&versions[0].path).unwrap() == other, "what the other program wrote is kept");
    // A missing file is reported too; saving restores it.
    fs::remove_file(&path).unwrap();
    desk.send(DocumentMessage::LookAtFile);
    desk.wait_for_reply(|reply| {
        matches!(reply, DocumentReply::FileChanged(FileState::Missing)).then_some(())
    });
    desk.save(SaveTo::Own);
    assert!(path.is_file());
}

#[test]
fn after_save_as_the_document_is_the_new_file_and_the_old_file_has_no_unsaved_work() {
    let folder = Folder::new("saving-as");
    let (path, autosave) = (fox(&folder), folder.join("autosave"));
    let before = fs::read(&path).unwrap();
    let mut desk = TestDocument::new(&autosave);
    let opened = desk.open(&path);
    desk.edit(turn(0.5));
    desk.save(SaveTo::As(folder.join("Vixen")));
    let other = folder.join("Vixen.glb");
    let view = desk.view();
    assert_eq!((view.file.title.as_str(), view.file.path.as_deref()), ("Vixen.glb", Some(&*other)));
    assert!(view.history.saved && fs::read(&path).unwrap() == before);
    desk.edit(rename("Sneak"));
    let edited = desk.view();
    copy_after_kill(&autosave, &folder.join("second"));
    let mut second = TestDocument::new(&folder.join("second"));
    let offers = second.wait_for_offers();
    assert_eq!(
        offers.iter().map(|offer| (&*offer.title, offer.steps)).collect::<Vec<_>>(),
        [("Vixen.glb", 1)]
    );
    second.send(DocumentMessage::Decide(Box::new(offers[0].clone()), dragonfly_document::Decision::Keep));
    same_takes(&second.wait_for_view(|view| view.history.done == 2), &edited);
    second.change(Change::GoTo(0));
    same_takes(&second.view(), &opened);
    // The first file is opened as it always was.
    let first = second.open(&path);
    assert!(first.history.steps.is_empty() && first.history.saved);
}

#[test]
fn saving_a_copy_does_not_change_the_unsaved_state() {
    let folder = Folder::new("saving-copy");
    let path = fox(&folder);
    let mut desk = TestDocument::new(&folder.join("autosave"));
    desk.open(&path);
    desk.edit(turn(0.5));
    let copy = folder.join("copy.glb");
    assert!(desk.save(SaveTo::Copy(copy.clone())).copy);
    let view = desk.view();
    assert!(!view.history.saved && view.file.path.as_deref() == Some(&*path));
    let mut fresh = TestDocument::with(Setup::default());
    same_takes(&fresh.open(&copy), &view);
    assert!(matches!(refused(&mut desk, SaveTo::Copy(path)), NotSaved::Failed(_)));
}

#[test]
fn another_file_is_replaced_only_on_request_and_another_format_is_refused() {
    let folder = Folder::new("saving-exists");
    let path = fox(&folder);
    let other = folder.join("other.glb");
    fs::write(&other, "precious").unwrap();
    let mut desk = TestDocument::new(&folder.join("autosave"));
    desk.open(&path);
    desk.edit(turn(0.5));
    for to in [SaveTo::As(other.clone()), SaveTo::Copy(other.clone())] {
        assert_eq!(refused(&mut desk, to), NotSaved::Exists(other.clone()));
    }
    assert_eq!(fs::read(&other).unwrap(), b"precious");
    let NotSaved::Failed(reason) = refused(&mut desk, SaveTo::As(folder.join("fox.gltf"))) else { panic!() };
    assert!(reason.contains("fox.gltf: the format of the file stays .glb"), "{reason}");
    let NotSaved::Failed(reason) = refused(&mut desk, SaveTo::As("/proc/nothing/fox.glb".into())) else {
        panic!()
    };
    assert!(reason.starts_with("/proc/nothing"), "{reason}");
    anyway(&mut desk, SaveTo::As(other.clone()));
    assert_eq!(desk.view().file.path, Some(other));
}

#[test]
fn reverting_restores_the_saved_state_and_can_be_undone() {
    let folder = Folder::new("saving-revert");
    let path = fox(&folder);
    let mut desk = TestDocument::new(&folder.join("autosave"));
    desk.open(&path);
    desk.edit(turn(0.5));
    desk.save(SaveTo::Own);
    let saved = desk.view();
    desk.edit(turn(0.7));
    desk.edit(rename("Sneak"));
    let edited = desk.view();
    desk.send(DocumentMessage::Revert);
    let view = desk.view();
    same_takes(&view, &saved);
    assert!(view.history.saved && view.history.steps.len() == 3);
    desk.change(Change::GoTo(3));
    same_takes(&desk.view(), &edited);
    // If no undo step leads to the saved state, the file is read again.
    desk.change(Change::GoTo(0));
    desk.edit(turn(0.1));
    assert!(!desk.view().history.saved);
    let generation = desk.view().generation;
    desk.send(DocumentMessage::Revert);
    let view = desk.wait_for_view(|view| view.generation > generation && view.history.saved);
    same_takes(&view, &saved);
}

#[test]
fn saving_without_a_file_asks_for_a_path_and_closing_asks_if_unsaved() {
    let folder = Folder::new("saving-nowhere");
    let mut desk = TestDocument::new(&folder.join("autosave"));
    let leave = |desk: &mut TestDocument| {
        desk.send(DocumentMessage::Quit);
        desk.wait_for_reply(|reply| match reply {
            DocumentReply::Unsaved(Then::Quit) => Some(true),
            DocumentReply::MayQuit => Some(false),
            _ => None,
        })
    };
    assert!(!leave(&mut desk), "nothing is open");
    desk.open_source(Source::BuiltIn);
    assert!(!leave(&mut desk));
    desk.edit(rename("Hover"));
    assert!(leave(&mut desk));
    assert_eq!(refused(&mut desk, SaveTo::Own), NotSaved::NoFile);
    desk.change(Change::Undo);
    assert!(!leave(&mut desk));
    desk.change(Change::Redo);
    desk.save(SaveTo::As(folder.join("mine.glb")));
    assert!(!leave(&mut desk));
    assert!(Path::new(&folder.join("mine.glb")).is_file());
    // From now on it is saved there.
    desk.edit(rename("Hang"));
    assert_eq!(desk.save(SaveTo::Own).path, folder.join("mine.glb"));
}

#[test]
fn every_format_can_be_saved_and_reopened_with_its_undo_history() {
    let folder = Folder::new("saving-formats");
    let dfm = folder.join("fox.dfm");
    let model = {
        let mut desk = TestDocument::with(Setup::default());
        desk.open(&data("gltf/Fox.glb")).loaded.model.clone()
    };
    fs::write(&dfm, dragonfly_anim::format::dfm::write(&model).unwrap()).unwrap();
    for name in ["SimpleSkin_embedded.gltf", "Fox_skeleton.glb"] {
        fs::copy(data(&format!("gltf/{name}")), folder.join(name)).unwrap();
    }
    for name in ["fox.dfm", "SimpleSkin_embedded.gltf", "Fox_skeleton.glb"] {
        let (path, autosave) = (folder.join(name), folder.join(&format!("{name}-autosave")));
        let mut desk = TestDocument::new(&autosave);
        let opened = desk.open(&path);
        if opened.takes.is_empty() {
            continue;
        }
        desk.edit(rename("Something else"));
        desk.save(SaveTo::Own);
        let saved = desk.view();
        desk.end();
        let mut desk = TestDocument::new(&autosave);
        let again = desk.open(&path);
        assert_eq!((again.history.done, again.history.saved), (1, true), "{name}");
        same_takes(&again, &saved);
        desk.change(Change::Undo);
        same_takes(&desk.view(), &opened);
    }
}

/// The file is replaced before the journal records that it was saved. A program killed between the two has saved, and
/// keeps its history.
#[test]
fn a_kill_right_after_the_file_was_replaced_loses_no_undo_history() {
    let folder = Folder::new("saving-moment");
    let (path, autosave) = (fox(&folder), folder.join("autosave"));
    let mut desk = TestDocument::new(&autosave);
    desk.open(&path);
    desk.edit(turn(0.5));
    desk.edit(rename("Look around"));
    desk.save(SaveTo::Own);
    let before = desk.view();
    let second = folder.join("second");
    copy_after_kill(&autosave, &second);
    let journal = fs::read_dir(second.join("journals")).unwrap().next().unwrap().unwrap().path();
    // Damages the last record of the journal: the one that the save succeeded.
    let bytes = fs::read(&journal).unwrap();
    fs::write(&journal, &bytes[..bytes.len() - 1]).unwrap();
    let mut desk = TestDocument::new(&second);
    let after = desk.open(&path);
    assert_eq!(after.history, before.history);
    same_takes(&before, &after);
    let said = desk.unread_replies();
    assert!(
        !said.iter().any(|said| said.contains("Offers") || said.contains("a new history was started")),
        "{said:?}"
    );
    desk.change(Change::GoTo(0));
    assert!(!desk.view().history.saved);
    // If edits followed that save, they are offered together with the history before it.
    let third = folder.join("third");
    fs::remove_dir_all(second.join("journals")).unwrap();
    fs::create_dir_all(second.join("journals")).unwrap();
    fs::write(&journal, &bytes[..bytes.len() - 1]).unwrap();
    let mut desk = TestDocument::new(&second);
    desk.open(&path);
    desk.edit(turn(0.9));
    let before = desk.view();
    copy_after_kill(&second, &third);
    let mut desk = TestDocument::new(&third);
    let opened = desk.open(&path);
    let offer = desk.wait_for_offers().remove(0);
    assert_eq!(offer.steps, 1);
    desk.send(DocumentMessage::Decide(Box::new(offer), dragonfly_document::Decision::Keep));
    let after = desk.wait_for_view(|view| view.generation > opened.generation);
    assert_eq!(after.history, before.history);
    same_takes(&before, &after);
}

/// Reading a file gives each rotation the sign of the one before it. Such a file counts as unchanged.
#[test]
fn a_saved_rotation_by_any_angle_keeps_its_undo_history_when_reopened() {
    let folder = Folder::new("saving-turns");
    let (path, autosave) = (fox(&folder), folder.join("autosave"));
    let angles = [0.3, 2.0, 3.0, 3.5, 4.0, 6.0, -3.0, -5.0];
    for (steps, angle) in angles.into_iter().enumerate() {
        let mut desk = TestDocument::new(&autosave);
        let opened = desk.open(&path);
        assert_eq!(opened.history.done, steps, "before {angle}");
        desk.edit(turn(angle));
        desk.save(SaveTo::Own);
        desk.end();
    }
}
