//! The checker detects errors: incorrect methods of sharing, in safe code as it might be written, are reported.

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

/// Two locks, taken one after the other: the first document has the changes, the second one has the result.
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

/// A document that publishes only every n-th edit.
struct RarelyPublished {
    own: SharedDocument,
    shared: Arc<Mutex<Arc<SharedDocument>>>,
    every: u64,
}

impl Sharing for RarelyPublished {
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

/// The graphics thread's side of [`RarelyPublished`].
struct RarelyPublishedViewing(Arc<Mutex<Arc<SharedDocument>>>);

impl Viewing for RarelyPublishedViewing {
    fn frame(&mut self, frame: &mut FrameWork) {
        let document = Arc::clone(&lock(&self.0));
        frame.read(shown(&document.takes));
        frame.draw();
        frame.confirm(shown(&document.takes));
    }
}

fn rarely_published(start: SharingStart, every: u64) -> SharingParts {
    let shared = Arc::new(Mutex::new(Arc::new(start.document.clone())));
    let theirs = RarelyPublishedViewing(Arc::clone(&shared));
    let sharing = RarelyPublished { own: start.document, shared, every };
    SharingParts { sharing: Box::new(sharing), viewing: Box::new(|_| Box::new(theirs)) }
}

fn verdict(start: fn(SharingStart) -> SharingParts) -> RunDefects {
    let scenario = Scenario {
        edits: Edits::Small,
        rate: Rate::Every(Duration::from_micros(50)),
        period: None,
        // Gives exactly 6,000 edits, however irregular the mouse is. The last one has an even number, so it is
        // published.
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
fn an_edit_in_two_halves_is_reported_as_torn() {
    let verdict = verdict(two_locks);
    assert!(verdict.torn > 0, "{verdict:?}");
    assert!(!verdict.wrong, "only readers see the error: {verdict:?}");
}

#[test]
fn a_document_that_is_published_too_late_is_reported_as_stale() {
    let verdict = verdict(|start| rarely_published(start, 2));
    assert!(verdict.stale > 0 && verdict.torn == 0, "{verdict:?}");
}

#[test]
fn a_document_that_is_published_after_every_edit_passes() {
    assert_eq!(verdict(|start| rarely_published(start, 1)), RunDefects::default());
}
