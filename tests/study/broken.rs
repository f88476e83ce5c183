//! The checker is not blind: ways of sharing that are wrong are found to be wrong. Safe code, as it might be written.

use dragonfly_runtime::Captured;
use dragonfly_study::graphical::document::{NumberedEdit, SharedDocument, TakeEntry};
use dragonfly_study::graphical::driver::Rate;
use dragonfly_study::graphical::frame::{FrameWork, PoseQuestion, shown};
use dragonfly_study::graphical::model::ModelSize;
use dragonfly_study::graphical::scenario::{RunDefects, Scenario, ScenarioSetup, run};
use dragonfly_study::graphical::script::Edits;
use dragonfly_study::graphical::sharing::{
    Sharing, SharingMethod, SharingParts, SharingStart, TimedAnswer, Viewing,
};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap()
}

/// Two locks, taken one after the other: the changes are in the first document, the result in the second.
struct TwoLocks(Arc<[Mutex<SharedDocument>; 2]>);

impl Sharing for TwoLocks {
    fn edit(&mut self, edit: NumberedEdit, _begins: bool) {
        let originals = lock(&self.0[0]).originals();
        let ready = edit.prepare(&originals);
        drop(lock(&self.0[0]).apply(ready.clone()));
        std::thread::yield_now();
        drop(lock(&self.0[1]).apply(ready));
    }

    fn ask(&mut self, question: PoseQuestion, _main: &mut Captured) -> TimedAnswer {
        TimedAnswer::at_once(|| {
            let document = lock(&self.0[1]);
            question.answer(shown(&document.takes), &document.skeleton)
        })
    }

    fn document(&mut self, _main: &mut Captured) -> SharedDocument {
        lock(&self.0[1]).clone()
    }
}

impl Viewing for TwoLocks {
    fn frame(&mut self, frame: &mut FrameWork) {
        let changes = shown(&lock(&self.0[0]).takes).clone();
        let result = Arc::clone(&shown(&lock(&self.0[1]).takes).result);
        frame.read(&TakeEntry { result, ..changes });
        frame.draw();
    }
}

fn two_locks(start: SharingStart) -> SharingParts {
    let both = Arc::new([start.document.clone(), start.document].map(Mutex::new));
    let theirs = TwoLocks(Arc::clone(&both));
    SharingParts { sharing: Box::new(TwoLocks(both)), viewing: Box::new(|_| Box::new(theirs)) }
}

/// A document that is shown to others now and then only.
struct Forgetful {
    own: SharedDocument,
    shared: Arc<Mutex<Arc<SharedDocument>>>,
    every: u64,
}

impl Sharing for Forgetful {
    fn edit(&mut self, edit: NumberedEdit, _begins: bool) {
        let number = edit.number;
        let ready = edit.prepare(&self.own.originals());
        drop(self.own.apply(ready));
        if number.is_multiple_of(self.every) {
            *lock(&self.shared) = Arc::new(self.own.clone());
        }
    }

    fn ask(&mut self, question: PoseQuestion, _main: &mut Captured) -> TimedAnswer {
        TimedAnswer::at_once(|| question.answer(shown(&self.own.takes), &self.own.skeleton))
    }

    fn document(&mut self, _main: &mut Captured) -> SharedDocument {
        self.own.clone()
    }
}

struct Shown(Arc<Mutex<Arc<SharedDocument>>>);

impl Viewing for Shown {
    fn frame(&mut self, frame: &mut FrameWork) {
        let document = Arc::clone(&lock(&self.0));
        frame.read(shown(&document.takes));
        frame.draw();
        frame.confirm(shown(&document.takes));
    }
}

fn forgetful(start: SharingStart, every: u64) -> SharingParts {
    let shared = Arc::new(Mutex::new(Arc::new(start.document.clone())));
    let theirs = Shown(Arc::clone(&shared));
    let sharing = Forgetful { own: start.document, shared, every };
    SharingParts { sharing: Box::new(sharing), viewing: Box::new(|_| Box::new(theirs)) }
}

fn verdict(start: fn(SharingStart) -> SharingParts) -> RunDefects {
    let scenario = Scenario {
        edits: Edits::Small,
        rate: Rate::Every(Duration::from_micros(50)),
        period: None,
        // Six thousand edits and no more, whatever the hand's unpunctuality: the last one has an even number.
        length: Duration::from_micros(299_980),
        warm_up: Duration::ZERO,
        graphics_stall: None,
        main_stall: None,
        busy: 0,
        questions: None,
        thorough: true,
    };
    let bed = ScenarioSetup::new(ModelSize::TINY, 1);
    run(&bed, &SharingMethod::new("broken", start), &scenario, &mut Default::default())
}

#[test]
fn an_edit_in_two_halves_is_seen_to_be_torn() {
    let verdict = verdict(two_locks);
    assert!(verdict.torn > 0, "{verdict:?}");
    assert!(!verdict.wrong, "only who reads is wrong: {verdict:?}");
}

#[test]
fn a_document_that_is_not_shown_in_time_is_seen_to_be_stale() {
    let verdict = verdict(|start| forgetful(start, 2));
    assert!(verdict.stale > 0 && verdict.torn == 0, "{verdict:?}");
}

#[test]
fn the_same_without_the_mistake_passes() {
    assert_eq!(verdict(|start| forgetful(start, 1)), RunDefects::default());
}
