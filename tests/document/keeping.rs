//! Unsaved work is never lost: how the document thread uses its journal.

use dragonfly_document::history::Gesture;
use dragonfly_document::{
    Change, Decision, DocumentMessage, DocumentReply, FaultInjection, FaultPlan, FaultPoint, HistoryView,
    SaveTo, Setup, Source, Then,
};
use dragonfly_kit::document::test_document::{
    TestDocument, autosave_in, autosave_with, copy_after_kill, fox, rename, same_takes, turn,
};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::random::{Random, seed};
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_store::JournalEntry;
use std::fs;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

#[test]
fn an_edit_is_recorded_in_the_journal_before_it_is_shown() {
    let folder = Folder::new("keeping-before");
    let autosave = folder.join("autosave");
    let mut document = TestDocument::new(&autosave);
    document.open(&fox(&folder));
    for number in 1..=20 {
        document.edit(turn(number as f32 * 0.1));
        document.wait_for_view(|view| view.history.done == number);
        let keeper = autosave_in(&autosave);
        let found = keeper.recoverable().unwrap();
        let edits = |entry: &JournalEntry| matches!(entry, JournalEntry::Edit(bytes) if bytes.windows(6).any(|part| part == b"\"edit\""));
        let count = keeper.entries(&found[0]).unwrap().into_iter().filter(edits).count();
        assert_eq!(count, number, "what is seen is recorded");
    }
}

#[test]
fn work_of_a_killed_program_is_offered_and_recovered_with_its_history() {
    let folder = Folder::new("keeping-killed");
    let path = fox(&folder);
    let bytes = fs::read(&path).unwrap();
    let mut document = TestDocument::new(&folder.join("first"));
    let opened = document.open(&path);
    document.edit(turn(0.5));
    document.edit(rename("Look around"));
    document.edit(turn(0.9));
    // A drag is one step, however many edits it contains.
    for angle in 1..50 {
        document.change(Change::Edit(turn(angle as f32 * 0.02), Some(Gesture(1))));
    }
    document.change(Change::Release(Gesture(1)));
    document.change(Change::Undo);
    let before = document.view();
    assert_eq!((before.history.done, before.history.steps.len()), (3, 4));
    copy_after_kill(&folder.join("first"), &folder.join("second"));

    let mut document = TestDocument::new(&folder.join("second"));
    document.open(&path);
    let [offer] = &document.wait_for_offers()[..] else { panic!("one document") };
    assert_eq!((offer.title.as_str(), offer.steps), ("Fox.glb", 3));
    assert_eq!(
        offer.labels,
        ["Pose", "Rename take", "Pose"].map(|label| {
            // The label of a pose edit is taken from the view, whatever its wording.
            if label == "Pose" { before.history.steps[0] } else { label }
        })
    );
    assert!(offer.age().is_some_and(|age| age.as_secs() < 600) && offer.warnings().is_empty());
    document.send(DocumentMessage::Decide(Box::new(offer.clone()), Decision::Keep));
    let after = document.wait_for_view(|view| view.history.done == 3);
    same_takes(&before, &after);
    assert_eq!(before.history, after.history);
    assert!(!after.history.saved);
    // Undo and redo through the whole history.
    document.change(Change::Redo);
    assert_eq!(document.view().history.done, 4);
    document.change(Change::GoTo(0));
    same_takes(&document.view(), &opened);
    assert!(document.view().history.saved);
    // A gesture of this run is not joined with one of the earlier run, even if both have the same number.
    document.change(Change::GoTo(4));
    document.change(Change::Edit(turn(0.3), Some(Gesture(1))));
    assert_eq!(document.view().history.done, 5);
    assert_eq!(fs::read(&path).unwrap(), bytes, "the file itself was not touched");
    document.end();

    // The user has not decided yet, so the work is offered again.
    let mut document = TestDocument::new(&folder.join("second"));
    document.open(&path);
    assert_eq!(document.wait_for_offers()[0].steps, 5);
}

#[test]
fn the_history_survives_saving_closing_and_starting_again() {
    let folder = Folder::new("keeping-history");
    let (path, autosave) = (fox(&folder), folder.join("autosave"));
    let mut document = TestDocument::new(&autosave);
    let opened = document.open(&path);
    document.edit(turn(0.5));
    document.edit(rename("Look around"));
    document.save(SaveTo::Own);
    document.edit(turn(0.7));
    document.save(SaveTo::Own);
    let before = document.view();
    assert!(before.history.saved);
    document.end();
    for round in 0..3 {
        let mut document = TestDocument::new(&autosave);
        let after = document.open(&path);
        assert_eq!(
            (after.history.done, after.history.steps.len(), after.history.saved),
            (3, 3, true),
            "{round}"
        );
        same_takes(&before, &after);
        // Undo restores the first takes, although the file no longer contains them.
        document.change(Change::GoTo(0));
        let first = document.view();
        same_takes(&first, &opened);
        assert!(!first.history.saved);
        document.change(Change::GoTo(3));
        assert!(document.view().history.saved);
        // Back at the saved state, nothing is asked or offered.
        document.send(DocumentMessage::Quit);
        assert!(!document.wait_for_reply(|reply| match reply {
            DocumentReply::Unsaved(_) => Some(true),
            DocumentReply::MayQuit => Some(false),
            _ => None,
        }));
        document.end();
    }
    // After undoing everything, saving writes the takes of the first file again.
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.change(Change::GoTo(0));
    document.save(SaveTo::Own);
    document.end();
    let mut fresh = TestDocument::with(Setup::default());
    same_takes(&fresh.open(&path), &opened);
}

#[test]
fn a_history_that_does_not_match_the_file_is_reset_with_a_notice() {
    let folder = Folder::new("keeping-other");
    let (path, autosave) = (fox(&folder), folder.join("autosave"));
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.edit(turn(0.5));
    document.save(SaveTo::Own);
    document.end();
    fs::copy(dragonfly_kit::folder::data("gltf/Fox.glb"), &path).unwrap();
    let mut document = TestDocument::new(&autosave);
    let view = document.open(&path);
    document.wait_for_warning("a new history was started");
    assert!(view.history.steps.is_empty() && view.history.saved);
    document.edit(turn(0.1));
    assert_eq!(document.view().history.done, 1);
}

#[test]
fn edits_of_the_built_in_model_are_recovered_without_a_file() {
    let folder = Folder::new("keeping-built-in");
    let mut document = TestDocument::new(&folder.join("first"));
    document.open_source(Source::BuiltIn);
    document.edit(rename("Hover"));
    document.edit(rename("Hang"));
    let before = document.view();
    copy_after_kill(&folder.join("first"), &folder.join("second"));
    // Offered at the start, whichever file is opened.
    let mut document = TestDocument::new(&folder.join("second"));
    let offer = document.wait_for_offers().remove(0);
    assert_eq!((offer.title.as_str(), offer.steps), ("Dragonfly (recovered)", 2));
    document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    let after = document.wait_for_view(|view| view.history.done == 2);
    same_takes(&before, &after);
    assert_eq!(after.file.path, None);
}

#[test]
fn work_opened_separately_is_a_new_document_and_the_original_is_unchanged() {
    let folder = Folder::new("keeping-beside");
    let path = fox(&folder);
    let mut document = TestDocument::new(&folder.join("first"));
    document.open(&path);
    document.edit(turn(0.5));
    let before = document.view();
    copy_after_kill(&folder.join("first"), &folder.join("second"));
    let mut document = TestDocument::new(&folder.join("second"));
    document.open(&path);
    let offer = document.wait_for_offers().remove(0);
    document.send(DocumentMessage::Decide(Box::new(offer), Decision::Beside));
    let beside = document.wait_for_view(|view| view.history.done == 1);
    same_takes(&before, &beside);
    assert_eq!((beside.file.title.as_str(), &beside.file.path), ("Fox.glb (recovered)", &None));
    assert!(!beside.history.saved);
    document.change(Change::Undo);
    assert!(!document.view().history.saved, "it is in no file");
    document.change(Change::Redo);
    document.view();
    // After another kill both can be recovered, and the separate document is unchanged.
    copy_after_kill(&folder.join("second"), &folder.join("third"));
    let mut third = TestDocument::new(&folder.join("third"));
    let offers = third.wait_for_offers();
    assert_eq!(offers.len(), 2, "{offers:?}");
    let own = offers.iter().find(|offer| offer.found.document.is_none()).unwrap();
    third.send(DocumentMessage::Decide(Box::new(own.clone()), Decision::Keep));
    let again = third.wait_for_view(|view| view.history.done == 1);
    same_takes(&before, &again);
    assert_eq!(again.file.path, None);
    // The work is saved to the path that the user chose, and the first file is unchanged.
    let bytes = fs::read(&path).unwrap();
    let copy = folder.join("Fox 2.glb");
    third.save(SaveTo::As(copy.clone()));
    assert_eq!(fs::read(&path).unwrap(), bytes);
    let mut fresh = TestDocument::with(Setup::default());
    same_takes(&fresh.open(&copy), &again);
}

#[test]
fn discarded_work_is_moved_to_the_bin_and_not_offered_again() {
    let folder = Folder::new("keeping-bin");
    let (path, autosave) = (fox(&folder), folder.join("autosave"));
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.edit(turn(0.5));
    document.send(DocumentMessage::DoNotSave);
    document.end();
    assert_eq!(autosave_in(&autosave).discarded().unwrap().len(), 1);

    let mut document = TestDocument::new(&autosave);
    let view = document.open(&path);
    assert!(view.history.steps.is_empty());
    document.edit(turn(0.6));
    document.view();
    copy_after_kill(&autosave, &folder.join("second"));
    let mut second = TestDocument::new(&folder.join("second"));
    second.open(&path);
    let offer = second.wait_for_offers().remove(0);
    second.send(DocumentMessage::Decide(Box::new(offer), Decision::Discard));
    second.edit(rename("after that"));
    assert_eq!(second.view().history.done, 1);
    assert_eq!(autosave_in(&folder.join("second")).discarded().unwrap().len(), 2);
    // The new work has a journal of its own.
    copy_after_kill(&folder.join("second"), &folder.join("third"));
    let mut third = TestDocument::new(&folder.join("third"));
    third.open(&path);
    let offer = third.wait_for_offers().remove(0);
    assert_eq!(offer.labels, ["Rename take"]);
    // Work that was saved and then undone is reported as such.
    third.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    third.wait_for_view(|view| view.history.done == 1);
    third.save(SaveTo::Own);
    third.change(Change::Undo);
    third.view();
    copy_after_kill(&folder.join("third"), &folder.join("fourth"));
    let mut fourth = TestDocument::new(&folder.join("fourth"));
    fourth.open(&path);
    assert_eq!(fourth.wait_for_offers()[0].labels, ["Rename take (undone)"]);
}

#[test]
fn postponed_recovery_keeps_the_old_work_and_allows_new_work() {
    let folder = Folder::new("keeping-later");
    let path = fox(&folder);
    let mut document = TestDocument::new(&folder.join("first"));
    document.open(&path);
    document.edit(turn(0.5));
    document.view();
    copy_after_kill(&folder.join("first"), &folder.join("second"));
    let mut document = TestDocument::new(&folder.join("second"));
    document.open(&path);
    let offer = document.wait_for_offers().remove(0);
    document.send(DocumentMessage::Decide(Box::new(offer), Decision::Later));
    document.edit(rename("other work"));
    document.edit(rename("more of it"));
    document.view();
    copy_after_kill(&folder.join("second"), &folder.join("third"));
    let mut third = TestDocument::new(&folder.join("third"));
    let mut steps: Vec<usize> = third.wait_for_offers().iter().map(|offer| offer.steps).collect();
    steps.sort_unstable();
    assert_eq!(steps, [1, 2]);
}

#[test]
fn two_programs_that_open_one_file_are_warned_and_both_record_their_edits() {
    let folder = Folder::new("keeping-two");
    let (path, autosave) = (fox(&folder), folder.join("autosave"));
    let mut one = TestDocument::new(&autosave);
    one.open(&path);
    one.edit(turn(0.5));
    one.view();
    let mut two = TestDocument::new(&autosave);
    let view = two.open(&path);
    let text = two.wait_for_warning("is open in another window");
    assert!(text.contains(&format!("process {}", std::process::id())), "{text}");
    assert!(view.history.steps.is_empty());
    two.edit(rename("mine"));
    two.view();
    copy_after_kill(&autosave, &folder.join("second"));
    let mut third = TestDocument::new(&folder.join("second"));
    assert_eq!(third.wait_for_offers().len(), 2);
    // The program that saves last is warned.
    one.save(SaveTo::Own);
    two.send(DocumentMessage::Save(dragonfly_document::SaveOrder::own(None)));
    let reason = two.wait_for_reply(|reply| match reply {
        DocumentReply::NotSaved(_, reason) => Some(reason.clone()),
        _ => None,
    });
    assert!(matches!(reason, dragonfly_document::NotSaved::Changed(_)));
}

/// A fault plan that panics at a change.
#[derive(Debug)]
struct FailAt(AtomicU32);

impl FaultPlan for FailAt {
    fn reach(&self, point: FaultPoint) {
        if point == FaultPoint::Change {
            assert!(self.0.fetch_sub(1, Ordering::Relaxed) != 1, "injected fault");
        }
    }
}

#[test]
fn a_panic_in_the_document_thread_loses_no_work_and_offers_it() {
    let folder = Folder::new("keeping-panic");
    let (path, autosave) = (fox(&folder), folder.join("autosave"));
    let faults = FaultInjection::new(Arc::new(FailAt(AtomicU32::new(4))));
    let setup = Setup { autosave: Some(autosave_in(&autosave)), faults, ..Setup::default() };
    let mut document = TestDocument::with(setup);
    document.open(&path);
    document.edit(turn(0.5));
    document.edit(rename("Look around"));
    document.edit(turn(0.9));
    let before = document.view();
    document.edit(rename("never"));
    document.wait_for_reply(|reply| matches!(reply, DocumentReply::Lost).then_some(()));
    let offer = document.wait_for_offers().remove(0);
    assert_eq!((offer.title.as_str(), offer.steps), ("Fox.glb", 3));
    document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    let after = document.wait_for_view(|view| view.generation > before.generation && view.history.done == 3);
    same_takes(&before, &after);
    // The document continues as before.
    document.edit(turn(0.1));
    document.save(SaveTo::Own);
    assert!(document.view().history.saved);
}

#[test]
fn an_unwritable_autosave_folder_is_reported_once_and_editing_continues() {
    let folder = Folder::new("keeping-nowhere");
    let path = fox(&folder);
    let autosave = folder.join("autosave");
    fs::write(&autosave, "no folder").unwrap();
    let mut document = TestDocument::new(&autosave);
    document.open(&path);
    document.wait_for_warning("Unsaved work is not recorded, so a crash would lose it");
    for number in 0..10 {
        document.edit(turn(number as f32 * 0.1));
    }
    document.save(SaveTo::Own);
    assert!(document.view().history.saved);
    assert!(
        !document.unread_replies().iter().any(|said| said.contains("recorded")),
        "{:?}",
        document.unread_replies()
    );
}

#[test]
fn a_temporary_disk_failure_at_any_call_loses_no_step() {
    let folder = Folder::new("keeping-faults");
    let path = fox(&folder);
    for kind in [Fault::Full, Fault::Io] {
        for call in (1..60).step_by(3) {
            println!("{kind:?} from call {call}");
            let place = folder.join(&format!("{kind:?}-{call}"));
            let files = FaultyFiles::between(call, call + 3, kind);
            let setup = Setup { autosave: Some(autosave_with(&place, files)), ..Setup::default() };
            let mut document = TestDocument::with(setup);
            document.open(&path);
            for number in 0..6 {
                document.edit(turn(number as f32 * 0.1));
            }
            let before = document.view();
            let said = document.unread_replies();
            let troubled =
                said.iter().any(|said| said.contains("not recorded") || said.contains("not being recorded"));
            assert_eq!(before.history.done, 6, "{kind:?} {call}");
            if troubled {
                let again = |said: &String| said.contains("Unsaved work is recorded again");
                if !said.iter().any(again) {
                    document.wait_for_warning("Unsaved work is recorded again");
                }
            }
            let second = folder.join(&format!("{kind:?}-{call}-second"));
            if place.is_dir() {
                copy_after_kill(&place, &second);
            }
            let mut after = TestDocument::new(&second);
            after.open(&path);
            println!("{said:?}: {:?}", autosave_in(&second).recoverable());
            let offer = after.wait_for_offers().remove(0);
            after.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
            same_takes(&after.wait_for_view(|view| view.history.done == 6), &before);
        }
    }
}

/// Random edits, undos and saves; after a kill at any moment, the recovered document equals the one before the kill.
#[test]
fn random_edits_are_recovered_after_a_kill_at_any_moment() {
    let seed = seed(11);
    let mut random = Random::new(seed);
    for round in 0..12 {
        println!("DRAGONFLY_SEED={seed} round {round}");
        let folder = Folder::new("keeping-random");
        let path = fox(&folder);
        let mut place = folder.join("autosave-0");
        let mut document = TestDocument::new(&place);
        document.open(&path);
        for life in 1..4 {
            for _ in 0..random.below(25) {
                match random.below(12) {
                    0 => document.change(Change::Undo),
                    1 => document.change(Change::Redo),
                    2 => document.change(Change::GoTo(random.below(6))),
                    3 => {
                        document.save(SaveTo::Own);
                    }
                    4 => document.edit(rename(&format!("take {}", random.below(100)))),
                    5 => document.change(Change::Cancel(Gesture(random.below(3) as u64))),
                    6 | 7 => {
                        let gesture = Gesture(random.below(3) as u64);
                        document.change(Change::Edit(turn(random.unit()), Some(gesture)));
                    }
                    _ => document.edit(turn(random.unit())),
                }
            }
            let before = document.view();
            let next = folder.join(&format!("autosave-{life}"));
            copy_after_kill(&place, &next);
            drop(document);
            place = next;
            document = TestDocument::new(&place);
            let opened = document.open(&path);
            let after = if before.history.saved {
                document.view()
            } else {
                let offer = document.wait_for_offers().remove(0);
                document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
                let generation = opened.generation;
                document.wait_for_view(|view| view.generation > generation)
            };
            same_takes(&before, &after);
            // The numbers of the steps are those of a run of the program.
            let [before, after] =
                [before, after].map(|view| HistoryView { numbers: Vec::new(), ..(*view.history).clone() });
            assert_eq!(before, after, "round {round}, life {life}");
        }
    }
}

/// A file is identified by its content, not by its name: work continues on a moved file with the same content.
#[test]
fn work_on_a_moved_file_continues_at_its_new_path() {
    let folder = Folder::new("keeping-moved");
    let path = fox(&folder);
    let mut document = TestDocument::new(&folder.join("first"));
    let opened = document.open(&path);
    document.edit(turn(0.5));
    document.save(SaveTo::Own);
    document.edit(rename("Look around"));
    document.edit(turn(0.9));
    let before = document.view();
    let second = folder.join("second");
    copy_after_kill(&folder.join("first"), &second);
    let moved = folder.join("renamed.glb");
    fs::rename(&path, &moved).unwrap();
    let bytes = fs::read(&moved).unwrap();

    let mut document = TestDocument::new(&second);
    let offer = document.wait_for_offers().remove(0);
    assert!(offer.is_missing() && !offer.can_be_kept());
    assert!(offer.warnings()[0].contains("The file is missing"), "{:?}", offer.warnings());
    let found_at =
        |path: &std::path::Path| DocumentMessage::FoundAt(Box::new(offer.clone()), path.to_owned());
    // A different file is detected, and so is a missing one.
    let other = folder.join("other.glb");
    fs::copy(dragonfly_kit::folder::data("gltf/Fox.glb"), &other).unwrap();
    document.send(found_at(&other));
    let (back, at) = document.wait_for_reply(|reply| match reply {
        DocumentReply::OtherFile(offer, path) => Some((offer.clone(), path.clone())),
        _ => None,
    });
    assert_eq!((&*back, &at), (&offer, &other));
    document.send(found_at(&folder.join("nowhere.glb")));
    document.wait_for_warning("nowhere.glb");
    assert_eq!(document.wait_for_offers(), std::slice::from_ref(&offer), "a wrong path is no answer");
    // The path of the moved file.
    document.send(found_at(&moved));
    let after = document.wait_for_view(|view| view.history.done == 3);
    same_takes(&before, &after);
    assert_eq!(before.history, after.history);
    assert_eq!((after.file.title.as_str(), after.file.path.as_deref()), ("renamed.glb", Some(&*moved)));
    assert_eq!(fs::read(&moved).unwrap(), bytes, "nobody saved");
    document.wait_for_warning("Restored the unsaved work of renamed.glb: 2 steps");
    // After another kill the work is offered for the new path of the file, and only once.
    let third = folder.join("third");
    copy_after_kill(&second, &third);
    let mut again = TestDocument::new(&third);
    let offers = again.wait_for_offers();
    assert_eq!(offers.iter().map(|offer| &*offer.title).collect::<Vec<_>>(), ["renamed.glb"]);
    assert!(offers[0].can_be_kept());
    // Edits saved before the move still count as saved.
    again.send(DocumentMessage::Decide(Box::new(offers[0].clone()), Decision::Keep));
    assert_eq!(again.wait_for_view(|view| view.history.done == 3).history, before.history);
    again.end();
    document.save(SaveTo::Own);
    assert!(!path.exists(), "nothing is written where it was");
    document.end();
    let mut document = TestDocument::new(&second);
    let view = document.open(&moved);
    assert_eq!((view.history.done, view.history.saved), (3, true));
    document.change(Change::GoTo(0));
    same_takes(&document.view(), &opened);
}

/// If the file is deleted, the work can be applied to a similar file, as a new document.
#[test]
fn work_on_a_deleted_file_can_be_applied_to_a_similar_file() {
    let folder = Folder::new("keeping-gone");
    let path = fox(&folder);
    let mut document = TestDocument::new(&folder.join("first"));
    document.open(&path);
    document.edit(turn(0.5));
    let before = document.view();
    copy_after_kill(&folder.join("first"), &folder.join("second"));
    // Another version of the file.
    let other = folder.join("older.glb");
    document.edit(rename("An older one"));
    document.change(Change::Undo);
    document.change(Change::Undo);
    document.edit(rename("An older one"));
    document.save(SaveTo::Copy(other.clone()));
    fs::remove_file(&path).unwrap();
    let bytes = fs::read(&other).unwrap();
    let mut document = TestDocument::new(&folder.join("second"));
    let offer = document.wait_for_offers().remove(0);
    let there = dragonfly_document::Offer { source: Some(Source::File(other.clone())), ..offer };
    document.send(DocumentMessage::Decide(Box::new(there), Decision::Beside));
    let view = document.wait_for_view(|view| view.history.done == 1);
    assert_eq!(view.file.path, None);
    assert_eq!(view.takes[0].name, "An older one");
    assert_eq!(view.takes[0].tracks, before.takes[0].tracks);
    assert!(!view.history.saved && fs::read(&other).unwrap() == bytes);
}

#[test]
fn opening_a_model_asks_first_while_something_is_unsaved() {
    let folder = Folder::new("opening-asks");
    let mut document = TestDocument::new(&folder.join("autosave"));
    let open = |document: &mut TestDocument, anyway| {
        document.send(DocumentMessage::Open { source: Source::BuiltIn, anyway });
        document.wait_for_reply(|reply| match reply {
            DocumentReply::Unsaved(then) => {
                assert_eq!(*then, Then::Open(Source::BuiltIn));
                Some(false)
            }
            DocumentReply::Opened(_) => Some(true),
            _ => None,
        })
    };
    assert!(open(&mut document, false), "nothing was open");
    assert!(open(&mut document, false), "nothing is unsaved");
    document.edit(rename("Hover"));
    assert!(!open(&mut document, false), "an edit is unsaved");
    assert_eq!(document.view().history.done, 1, "the model stays open");
    assert!(open(&mut document, true), "the user has decided");
    assert_eq!(document.view().history.done, 0);
}
