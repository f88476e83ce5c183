//! `dragonfly --stdio` records every edit before it is answered: a killed session loses nothing that was answered.

use crate::stdio::StdioSession;
use dragonfly_document::adapter::ModelAdapter;
use dragonfly_document::edit::Edit;
use dragonfly_document::history::Edited;
use dragonfly_document::{Cancel, Decision, DocumentMessage, Editable, Source};
use dragonfly_kit::document::test_document::{TestDocument, autosave_in, fox, rename, turn};
use dragonfly_kit::folder::{Folder, takes_long};
use dragonfly_kit::random::{Random, seed};
use serde_json::{Value, json};
use std::path::Path;

/// Returns a random edit and its line.
fn any_edit(random: &mut Random, number: usize) -> (Edit, String) {
    let edit = match random.below(3) {
        0 => rename(&format!("take {number}")),
        _ => turn(random.between(-1.0, 1.0)),
    };
    let line = serde_json::to_string(&edit).expect("an edit");
    (edit, line)
}

/// Returns the takes after some edits of the file.
fn takes_after(original: &Path, edits: &[Edit]) -> Edited {
    let source = Source::File(original.to_owned());
    let editable = Editable::open(&source, &Cancel::default()).expect("a model");
    let mut edited = Edited::new(ModelAdapter::new(&editable.model.animation));
    edits.iter().for_each(|edit| edited.apply(edit.clone(), None).expect("it was accepted"));
    edited
}

#[test]
fn answered_edits_survive_a_kill_at_any_moment() {
    let kills = if takes_long() { 400 } else { 12 };
    let (first, mut lost, mut recovered) = (seed(80), 0, 0);
    for round in 0..kills {
        let mut random = Random::new(first + round);
        let folder = Folder::new("stdio-kill");
        let (file, journals) = (fox(&folder), folder.join("journals"));
        let original = folder.join("original.glb");
        std::fs::copy(&file, &original).expect("a copy");
        let mut session = StdioSession::recording(&file, &journals);
        let (mut edits, mut saved) = (Vec::new(), 0);
        for number in 0..random.below(10) {
            let (edit, line) = any_edit(&mut random, number);
            let answer = session.say(&line);
            assert_eq!(answer["ok"]["done"], json!(number + 1), "{answer}");
            edits.push(edit);
            if random.below(6) == 0 {
                session.ask(&json!({"do": "save"}));
                saved = edits.len();
            }
        }
        let answered = edits.len();
        // The kill may come before, while or after these are recorded.
        for number in 0..random.below(4) {
            let (edit, line) = any_edit(&mut random, 100 + number);
            session.send(&line);
            edits.push(edit);
        }
        for _ in 0..random.below(200) {
            std::hint::spin_loop();
        }
        session.kill();
        let mut after = TestDocument::new(&journals);
        let opened = after.open(&file);
        let recorded = autosave_in(&journals).recoverable().unwrap_or_default();
        let unsaved = recorded.iter().any(|found| found.unsaved > 0);
        if !unsaved {
            lost += usize::from(answered > saved);
            let expected = takes_after(&original, &edits[..saved]);
            let same = expected.adapter().results().zip(opened.takes.iter()).all(|(a, b)| a == b);
            assert!(same, "seed {}: the file as it was saved", first + round);
            continue;
        }
        let offer = after.wait_for_offers().remove(0);
        after.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
        let view = after.wait_for_view(|view| view.history.done >= answered);
        let expected = takes_after(&original, &edits[..view.history.done]);
        let same = expected.adapter().results().zip(view.takes.iter()).all(|(a, b)| a == b);
        assert!(same, "seed {}: {} of {answered} edits", first + round, view.history.done);
        recovered += 1;
    }
    println!("{kills} kills, {recovered} times work was restored, {lost} times answered edits were lost");
    assert_eq!(lost, 0);
    assert!(recovered > kills / 2, "{recovered}");
}

/// Returns the number of journals with unsaved edits and of all journals in a folder.
fn journals_in(folder: &Path) -> (usize, usize) {
    let found = autosave_in(folder).recoverable().unwrap_or_default();
    (found.iter().filter(|found| found.unsaved > 0).count(), found.len())
}

#[test]
fn a_session_leaves_a_journal_only_with_unsaved_edits() {
    let folder = Folder::new("stdio-journal-end");
    let (file, journals) = (fox(&folder), folder.join("journals"));
    let edit = serde_json::to_string(&turn(0.4)).expect("an edit");
    // Reading makes none, not even its folder.
    let mut session = StdioSession::recording(&file, &journals);
    session.ask(&json!({"query": "takes"}));
    session.end();
    assert!(!journals.exists());
    // Nothing is unsaved.
    let mut session = StdioSession::recording(&file, &journals);
    session.say(&edit);
    assert_eq!(journals_in(&journals), (1, 1));
    session.ask(&json!({"do": "save"}));
    session.end();
    assert_eq!(journals_in(&journals), (0, 0));
    // The window offers what was not saved.
    let mut session = StdioSession::recording(&file, &journals);
    session.say(&edit);
    session.end();
    assert_eq!(journals_in(&journals), (1, 1));
    let mut window = TestDocument::new(&journals);
    window.open(&file);
    assert_eq!(window.wait_for_offers().remove(0).steps, 1);
}

#[test]
fn nothing_is_recorded_where_that_is_switched_off_or_the_model_is_built_in() {
    let folder = Folder::new("stdio-journal-off");
    let (file, journals) = (fox(&folder), folder.join("journals"));
    let edit: Value = serde_json::to_value(turn(0.4)).expect("an edit");
    let mut session = StdioSession::recording(&file, Path::new("off"));
    session.ask(&edit);
    session.end();
    assert!(!Path::new("off").exists());
    let mut session = StdioSession::recording(Path::new("demo:"), &journals);
    session.ask(&json!({"edit": "rename_take", "take": 0, "name": "Glide"}));
    session.end();
    assert!(!journals.exists());
}

#[test]
fn edits_are_answered_while_the_journal_cannot_be_created_and_recorded_once_it_can() {
    let folder = Folder::new("stdio-journal-later");
    let (file, journals) = (fox(&folder), folder.join("journals"));
    std::fs::write(&journals, "no folder").expect("a file");
    let mut session = StdioSession::recording(&file, &journals);
    for angle in [0.1, 0.2] {
        session.ask(&serde_json::to_value(turn(angle)).expect("an edit"));
    }
    std::fs::remove_file(&journals).expect("it is there");
    session.ask(&serde_json::to_value(turn(0.3)).expect("an edit"));
    session.kill();
    let mut window = TestDocument::new(&journals);
    window.open(&file);
    assert_eq!(window.wait_for_offers().remove(0).steps, 3);
}
