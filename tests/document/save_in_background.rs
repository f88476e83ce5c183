//! The document is edited while a file is saved: nothing waits for the disk, and nothing is lost.

use dragonfly_document::history::Gesture;
use dragonfly_document::{
    Change, Decision, DocumentMessage, DocumentReply, FaultInjection, FaultPlan, FaultPoint, SaveOrder,
    SaveTo, Setup, View,
};
use dragonfly_kit::document::test_document::{
    TestDocument, autosave_in, copy_after_kill, fox, rename, same_takes, turn,
};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::random::{Random, seed};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex};
use std::time::Duration;

/// A fault plan that holds a save at a point until it is released.
#[derive(Debug)]
pub(super) struct HeldSave {
    at: FaultPoint,
    state: Mutex<Held>,
    changed: Condvar,
}

#[derive(Clone, Copy, Debug, Default)]
struct Held {
    /// Whether the next save is held.
    closed: bool,
    /// Whether a save has reached the point.
    reached: bool,
    /// Whether the save panics there.
    panics: bool,
}

impl HeldSave {
    pub(super) fn at(at: FaultPoint) -> Arc<Self> {
        Arc::new(Self { at, state: Mutex::default(), changed: Condvar::new() })
    }

    fn change(&self, change: impl FnOnce(&mut Held)) {
        change(&mut self.state.lock().unwrap());
        self.changed.notify_all();
    }

    pub(super) fn hold(&self) {
        self.change(|held| held.closed = true);
    }

    pub(super) fn release(&self) {
        self.change(|held| *held = Held { panics: held.panics, ..Held::default() });
    }

    /// Starts a save and waits until it is held.
    #[track_caller]
    pub(super) fn hold_save(&self, document: &TestDocument, to: SaveTo) {
        self.hold();
        document.send(order(to));
        self.wait_until_reached();
    }

    #[track_caller]
    pub(super) fn wait_until_reached(&self) {
        let state = self.state.lock().unwrap();
        let waited = self.changed.wait_timeout_while(state, Duration::from_secs(60), |held| !held.reached);
        assert!(!waited.unwrap().1.timed_out(), "no save has reached {:?}", self.at);
    }
}

impl FaultPlan for HeldSave {
    fn reach(&self, point: FaultPoint) {
        if point != self.at {
            return;
        }
        let mut state = self.state.lock().unwrap();
        state.reached = state.closed;
        self.changed.notify_all();
        let state = self.changed.wait_timeout_while(state, Duration::from_secs(60), |held| held.closed);
        let panics = state.unwrap().0.panics;
        assert!(!panics, "injected fault");
    }
}

pub(super) const POINTS: [FaultPoint; 2] = [FaultPoint::PrepareSave, FaultPoint::WriteSave];

pub(super) fn document(autosave: &Path, held: &Arc<HeldSave>) -> TestDocument {
    let faults = FaultInjection::new(Arc::clone(held) as _);
    TestDocument::with(Setup { autosave: Some(autosave_in(autosave)), faults, ..Setup::default() })
}

/// Opens a copy of Fox in a folder of the test, whose saves can be held at `at`.
fn opened(name: &str, at: FaultPoint) -> (Folder, PathBuf, Arc<HeldSave>, TestDocument) {
    let folder = Folder::new(&format!("background-{name}-{at:?}"));
    let (path, held) = (fox(&folder), HeldSave::at(at));
    let mut document = document(&folder.join("autosave"), &held);
    document.open(&path);
    (folder, path, held, document)
}

fn order(to: SaveTo) -> DocumentMessage {
    DocumentMessage::Save(SaveOrder { to, ..SaveOrder::own(None) })
}

#[track_caller]
pub(super) fn wait_until_saved(document: &mut TestDocument) {
    document.wait_for_reply(|reply| match reply {
        DocumentReply::Saved(_) => Some(()),
        DocumentReply::NotSaved(_, reason) => panic!("{reason:?}"),
        _ => None,
    });
}

/// Opens the file without a journal.
fn on_disk(path: &Path) -> View {
    TestDocument::with(Setup::default()).open(path)
}

/// Starts the program after a kill and restores what it offers; the steps offered, and the view then.
pub(super) fn restored(autosave: &Path, path: &Path) -> (usize, View) {
    let mut document = TestDocument::new(autosave);
    document.open(path);
    let offer = document.wait_for_offers().remove(0);
    let steps = offer.steps;
    document.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
    document.wait_for_warning("Restored");
    (steps, document.view())
}

#[test]
fn edits_made_during_a_save_are_answered_before_its_end_and_are_unsaved_after_it() {
    for at in POINTS {
        let (_folder, path, held, mut document) = opened("edit", at);
        document.edit(turn(0.5));
        let saved = document.view();
        held.hold_save(&document, SaveTo::Own);
        document.edit(rename("newer"));
        document.wait_for_view(|view| view.history.done == 2);
        held.release();
        wait_until_saved(&mut document);
        assert!(!document.view().history.saved);
        same_takes(&on_disk(&path), &saved);
        document.change(Change::Undo);
        assert!(document.view().history.saved);
        document.change(Change::Redo);
        document.save(SaveTo::Own);
        assert!(document.view().history.saved);
        same_takes(&on_disk(&path), &document.view());
    }
}

#[test]
fn a_kill_at_any_point_of_a_save_loses_neither_the_saved_nor_the_newer_edits() {
    for at in POINTS {
        let (folder, path, held, mut document) = opened("kill", at);
        document.edit(turn(0.5));
        document.edit(rename("saved"));
        held.hold_save(&document, SaveTo::Own);
        document.edit(turn(0.7));
        document.change(Change::Edit(turn(0.8), Some(Gesture(1))));
        document.change(Change::Edit(turn(0.9), Some(Gesture(1))));
        let before = document.view();
        copy_after_kill(&folder.join("autosave"), &folder.join("during"));
        let (steps, view) = restored(&folder.join("during"), &path);
        assert_eq!(steps, 4, "{at:?}: the file is the old one");
        same_takes(&view, &before);

        held.release();
        wait_until_saved(&mut document);
        copy_after_kill(&folder.join("autosave"), &folder.join("after"));
        let (steps, view) = restored(&folder.join("after"), &path);
        assert_eq!(steps, 2, "{at:?}: the file has the first two");
        same_takes(&view, &before);
        assert_eq!(view.history.saved_at, Some(2));
    }
}

#[test]
fn a_kill_between_the_write_of_a_file_and_its_record_is_noticed_at_the_next_start() {
    let (folder, path, held, mut document) = opened("unrecorded", FaultPoint::WriteSave);
    document.edit(turn(0.5));
    held.hold_save(&document, SaveTo::Own);
    document.edit(turn(0.7));
    let before = document.view();
    copy_after_kill(&folder.join("autosave"), &folder.join("during"));
    held.release();
    wait_until_saved(&mut document);
    // The journal of before the end of the save, and the file of after it.
    let (steps, view) = restored(&folder.join("during"), &path);
    assert_eq!((steps, view.history.saved_at), (1, Some(1)));
    same_takes(&view, &before);
}

#[test]
fn a_drag_that_goes_on_during_a_save_is_a_second_step() {
    for at in POINTS {
        let (folder, path, held, mut document) = opened("drag", at);
        document.change(Change::Edit(turn(0.1), Some(Gesture(7))));
        document.change(Change::Edit(turn(0.2), Some(Gesture(7))));
        let saved = document.view();
        held.hold_save(&document, SaveTo::Own);
        document.change(Change::Edit(turn(0.3), Some(Gesture(7))));
        document.change(Change::Edit(turn(0.4), Some(Gesture(7))));
        document.change(Change::Release(Gesture(7)));
        let before = document.view();
        assert_eq!(before.history.done, 2);
        held.release();
        wait_until_saved(&mut document);
        same_takes(&on_disk(&path), &saved);
        copy_after_kill(&folder.join("autosave"), &folder.join("after"));
        let (steps, view) = restored(&folder.join("after"), &path);
        assert_eq!((steps, view.history.done, view.history.saved_at), (1, 2, Some(1)));
        same_takes(&view, &before);
    }
}

#[test]
fn an_end_is_asked_for_only_after_the_save_and_counts_the_edits_made_during_it() {
    let (_folder, _path, held, mut document) = opened("quit", FaultPoint::WriteSave);
    for (round, edits) in [0, 1].into_iter().enumerate() {
        document.edit(turn(0.5 + round as f32));
        held.hold_save(&document, SaveTo::Own);
        (0..edits).for_each(|_| document.edit(rename("newer")));
        document.send(DocumentMessage::Quit);
        // A change after it waits, too: otherwise the question would be about a later state.
        document.edit(rename("after the question"));
        assert!(document.unread_replies().iter().all(|said| !said.contains("Quit")));
        held.release();
        wait_until_saved(&mut document);
        let asks = document.wait_for_reply(|reply| match reply {
            DocumentReply::Unsaved(_) => Some(true),
            DocumentReply::MayQuit => Some(false),
            _ => None,
        });
        assert_eq!(asks, edits > 0);
        document.save(SaveTo::Own);
    }
}

#[test]
fn a_second_save_and_a_revert_follow_the_one_that_is_running() {
    let (_folder, path, held, mut document) = opened("twice", FaultPoint::PrepareSave);
    document.edit(turn(0.5));
    held.hold_save(&document, SaveTo::Own);
    document.edit(rename("second"));
    document.send(order(SaveTo::Own));
    // Does not wait for the second save.
    document.edit(rename("third"));
    document.wait_for_view(|view| view.history.done == 3);
    document.send(DocumentMessage::Revert);
    held.release();
    wait_until_saved(&mut document);
    wait_until_saved(&mut document);
    let view = document.wait_for_view(|view| view.history.saved);
    assert_eq!(view.history.done, 3, "the second save has the edits made until it began");
    assert_eq!(on_disk(&path).takes[0].name, "third");
}

#[test]
fn a_save_that_panics_is_reported_and_the_next_one_succeeds() {
    for at in POINTS {
        let folder = Folder::new(&format!("background-panic-{at:?}"));
        let (path, held) = (fox(&folder), HeldSave::at(at));
        let old = fs::read(&path).unwrap();
        let mut document = document(&folder.join("autosave"), &held);
        document.open(&path);
        document.edit(turn(0.5));
        held.change(|held| held.panics = true);
        document.send(order(SaveTo::Own));
        let reason = document.wait_for_reply(|reply| match reply {
            DocumentReply::NotSaved(_, reason) => Some(format!("{reason:?}")),
            _ => None,
        });
        assert!(reason.contains("injected fault"), "{reason}");
        assert_eq!(fs::read(&path).unwrap(), old);
        assert!(!document.view().history.saved);
        held.change(|held| held.panics = false);
        document.edit(rename("newer"));
        document.save(SaveTo::Own);
        same_takes(&on_disk(&path), &document.view());
    }
}

#[test]
fn a_document_that_ends_during_a_save_finishes_it_first() {
    for at in POINTS {
        let (folder, path, held, mut document) = opened("end", at);
        document.edit(turn(0.5));
        let before = document.view();
        held.hold_save(&document, SaveTo::Own);
        document.stop();
        held.release();
        document.end();
        same_takes(&on_disk(&path), &before);
        let found = autosave_in(&folder.join("autosave")).recoverable().unwrap();
        assert_eq!(found.iter().map(|found| found.unsaved).collect::<Vec<_>>(), [0], "{at:?}");
    }
}

#[test]
fn edits_made_while_a_file_is_saved_under_another_name_go_to_the_journal_of_that_file() {
    for at in POINTS {
        let folder = Folder::new(&format!("background-as-{at:?}"));
        let (path, other, held) = (fox(&folder), folder.join("other.glb"), HeldSave::at(at));
        let mut document = document(&folder.join("autosave"), &held);
        document.open(&path);
        document.edit(turn(0.5));
        let saved = document.view();
        held.hold_save(&document, SaveTo::As(other.clone()));
        document.edit(turn(0.7));
        let before = document.view();
        held.release();
        wait_until_saved(&mut document);
        document.edit(rename("newest"));
        let newest = document.view();
        assert_eq!(newest.file.path.as_deref(), Some(&*other));
        same_takes(&on_disk(&other), &saved);
        copy_after_kill(&folder.join("autosave"), &folder.join("after"));
        let (steps, view) = restored(&folder.join("after"), &other);
        assert_eq!((steps, view.history.saved_at), (2, Some(1)));
        same_takes(&view, &newest);
        assert_ne!(before.generation, newest.generation);
    }
}

/// Sends a random change.
fn random_change(document: &TestDocument, random: &mut Random) {
    match random.below(6) {
        0 => document.change(Change::Undo),
        1 => document.change(Change::Redo),
        2 => document.edit(rename(&format!("take {}", random.below(1000)))),
        3 => document.change(Change::Release(Gesture(random.below(3) as u64))),
        _ => {
            let gesture = (random.below(2) == 0).then(|| Gesture(random.below(3) as u64));
            document.change(Change::Edit(turn(random.below(100) as f32 * 0.01), gesture));
        }
    }
}

#[test]
fn random_edits_before_during_and_after_saves_are_restored_exactly_after_a_kill() {
    let seed = seed(20_261_122);
    let mut random = Random::new(seed);
    for round in 0..12 {
        let folder = Folder::new(&format!("background-random-{round}"));
        let held = HeldSave::at(POINTS[random.below(2)]);
        let mut path: PathBuf = fox(&folder);
        let mut document = document(&folder.join("autosave"), &held);
        document.open(&path);
        for save in 0..4 {
            (0..random.below(6)).for_each(|_| random_change(&document, &mut random));
            held.hold();
            let other = folder.join(&format!("other-{save}.glb"));
            let moves = random.below(4) == 0;
            document.send(order(if moves { SaveTo::As(other.clone()) } else { SaveTo::Own }));
            held.wait_until_reached();
            (0..random.below(6)).for_each(|_| random_change(&document, &mut random));
            let during = random.below(3) == 0;
            if during {
                check_kill(&mut document, &folder, &path, &format!("{save}-during"));
            }
            held.release();
            wait_until_saved(&mut document);
            if moves {
                path = other;
            }
            check_kill(&mut document, &folder, &path, &format!("{save}-after"));
        }
    }
}

/// Kills a copy of the program and checks that the next start restores the same history.
fn check_kill(document: &mut TestDocument, folder: &Folder, path: &Path, name: &str) {
    let before = document.view();
    let autosave = folder.join(name);
    copy_after_kill(&folder.join("autosave"), &autosave);
    let mut next = TestDocument::new(&autosave);
    let mut after = next.open(path);
    if !before.history.saved {
        let offer = next.wait_for_offers().remove(0);
        next.send(DocumentMessage::Decide(Box::new(offer), Decision::Keep));
        next.wait_for_warning("Restored");
        after = next.view();
    }
    same_takes(&before, &after);
    assert_eq!(before.history.saved, after.history.saved, "{name}");
    assert_eq!(
        (before.history.done, &before.history.steps),
        (after.history.done, &after.history.steps),
        "{name}"
    );
}
