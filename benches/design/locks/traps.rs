//! Mistakes that compile. Each test makes one happen, deterministically.

use super::{Document, SharedState};
use crate::design::skeleton::Bone;
use parking_lot::Mutex;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Barrier, mpsc};
use std::thread;
use std::time::Duration;

/// A lock that is not free within this time counts as deadlocked; the locks in these tests would never become
/// free.
const DEADLINE: Duration = Duration::from_millis(20);

fn shared() -> SharedState {
    SharedState::new(vec![Bone::new("hip", 0.0), Bone::new("knee", 0.0)])
}

#[test]
fn deadlock_by_a_call_under_the_lock_that_takes_it_again() {
    let shared = shared();
    // `shared.bones()` inside of this closure would wait for the lock, which this call of `edit` holds.
    shared.edit(0, |_| assert!(shared.document.try_lock_for(DEADLINE).is_none()));
    assert!(shared.document.try_lock().is_some());
}

#[test]
fn deadlock_by_two_locks_taken_in_two_orders() {
    let shared = shared();
    let both_hold_one = Barrier::new(2);
    let both_have_tried = Barrier::new(2);
    let meet = || both_hold_one.wait();
    let (panel, viewport) = thread::scope(|scope| {
        let panel = scope.spawn(|| {
            let _document = shared.document.lock();
            meet();
            let got = shared.picture.try_lock_for(DEADLINE).is_some();
            both_have_tried.wait();
            got
        });
        let viewport = scope.spawn(|| {
            let _picture = shared.picture.lock();
            meet();
            let got = shared.document.try_lock_for(DEADLINE).is_some();
            both_have_tried.wait();
            got
        });
        (
            panel.join().expect("a panel that does not panic"),
            viewport.join().expect("a viewport that does not panic"),
        )
    });
    assert!(!panel && !viewport, "each waits for what the other holds");
}

#[test]
fn deadlock_by_waiting_for_an_answer_under_the_lock() {
    let shared = shared();
    let (ask, questions) = mpsc::channel::<usize>();
    let (tell, answers) = mpsc::channel();
    let shared = &shared;
    thread::scope(|scope| {
        let viewport = scope.spawn(move || {
            // The viewport needs the lock for the answer.
            let bone = questions.recv().expect("it was asked");
            let name =
                shared.document.try_lock_for(DEADLINE).map(|document| document.bones[bone].name.clone());
            tell.send(name).expect("they wait for it");
        });
        let document = shared.document.lock();
        ask.send(0).expect("it runs");
        assert_eq!(answers.recv().expect("an answer"), None, "it cannot have the lock while this waits");
        drop(document);
        viewport.join().expect("a viewport that does not panic");
    });
}

#[test]
fn race_by_reading_under_one_lock_and_writing_under_the_next() {
    let shared = shared();
    // Two sliders, each of which adds one to the angle; both read it before either writes it.
    let first = shared.bones()[0].angle;
    let second = shared.bones()[0].angle;
    shared.edit(0, |bone| bone.angle = first + 1.0);
    shared.edit(0, |bone| bone.angle = second + 1.0);
    assert_eq!(shared.bones()[0].angle, 1.0, "one of two is lost");
    // The fix: both steps under one lock.
    shared.edit(0, |bone| bone.angle += 1.0);
    assert_eq!(shared.bones()[0].angle, 2.0);
}

#[test]
fn torn_view_by_two_locks_for_data_that_belongs_together() {
    let shared = shared();
    // Suppose that both bones must always have the same angle. A frame reads them one after the other.
    let hip = shared.document.lock().bones[0].angle;
    shared.edit(0, |bone| bone.angle = 1.0);
    shared.edit(1, |bone| bone.angle = 1.0);
    let knee = shared.document.lock().bones[1].angle;
    assert_ne!(hip, knee, "a state that never was");
}

#[test]
fn stale_answer_by_using_it_after_the_lock_was_released() {
    let shared = shared();
    shared.keep(crate::design::skeleton::draw(&shared.bones()));
    let picked = shared.pick([0.5, 0.0]).expect("the hip is there");
    shared.edit(0, |bone| bone.visible = false);
    assert!(!shared.bones()[picked].visible, "a hidden bone was picked");
}

#[test]
fn missed_wake_up_by_a_change_that_bypasses_the_interface() {
    let shared = shared();
    let mut seen = 0;
    shared.wait_for_change(&mut seen);
    // Any code in this module can do that: neither `version` nor `changed` is updated.
    shared.document.lock().bones[0].angle = 1.0;
    let Document { version, .. } = *shared.document.lock();
    assert_eq!(version, seen, "the viewport sleeps on");
}

#[test]
fn half_an_edit_by_a_panic_under_the_lock() {
    // After a panic in the middle of a change of two values, the next reader sees half of the change.
    let half = Mutex::new((0, 0));
    let broken = catch_unwind(AssertUnwindSafe(|| {
        let mut both = half.lock();
        both.0 = 1;
        assert!(both.1 == 1, "on purpose");
        both.1 = 1;
    }));
    assert!(broken.is_err());
    assert_eq!(*half.lock(), (1, 0));
    // The standard library's lock reports that instead; with the usual `unwrap` the panic spreads to every thread.
    let poisoned = Arc::new(std::sync::Mutex::new(0));
    let theirs = Arc::clone(&poisoned);
    let broken = catch_unwind(AssertUnwindSafe(move || {
        let _guard = theirs.lock().expect("no thread has panicked yet");
        panic!("on purpose");
    }));
    assert!(broken.is_err() && poisoned.lock().is_err());
}
