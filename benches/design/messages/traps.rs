//! Mistakes that compile. Each test makes one happen, deterministically: on a stage, where the test chooses the order
//! of delivery, or between two OS threads synchronized by a barrier.

use super::*;
use dragonfly_runtime::{Address, Receiver, Stage, Thread};
use std::sync::{Arc, Barrier, mpsc};
use std::time::Duration;

/// Returns the editor on a stage, at rest, with two bones.
fn editor() -> (Stage, [ThreadHandle; 3], Rc<RefCell<Panel>>) {
    let mut stage = Stage::new();
    let threads = ["main", "document", "graphics"].map(|name| stage.start(name));
    let [main, document, graphics] = &threads;
    let bones = vec![Bone::new("hip", 0.0), Bone::new("knee", 0.0)];
    let panel = open(stage.context(main), document, graphics, bones, |_| {});
    assert!(stage.settle(10));
    (stage, threads, panel)
}

/// Sends a request to the other asker while it handles a message itself, and waits for the answer.
struct Asker {
    /// Meeting points of the askers: the first when both are handling a message, the second when both have looked for
    /// their answer.
    stations: Arc<[Barrier; 2]>,
    found: mpsc::Sender<bool>,
}

enum AnswerRequest {
    Begin { other: Address<AnswerRequest> },
    Ask { answer: mpsc::Sender<()> },
}

impl Receiver for Asker {
    type Message = AnswerRequest;

    fn receive(&mut self, question: AnswerRequest, _: &mut Context) {
        match question {
            AnswerRequest::Begin { other } => {
                let (answer, answers) = mpsc::channel();
                self.stations[0].wait();
                other.send(AnswerRequest::Ask { answer }).expect("it runs");
                // Neither asker can answer before this call returns: `recv()` would wait forever.
                let found = answers.recv_timeout(Duration::from_millis(20)).is_ok();
                self.stations[1].wait();
                self.found.send(found).expect("the test listens");
            }
            // Fails only when the test has ended.
            AnswerRequest::Ask { answer } => _ = answer.send(()),
        }
    }
}

#[test]
fn deadlock_by_waiting_for_an_answer_in_the_middle_of_a_message() {
    let threads = ["left", "right"].map(|name| Thread::start(name).expect("a thread"));
    let stations = Arc::new([Barrier::new(2), Barrier::new(2)]);
    let (found, results) = mpsc::channel();
    let addresses = [&threads[0], &threads[1]].map(|thread| {
        let (stations, found) = (Arc::clone(&stations), found.clone());
        thread.handle().register_receiver(move |_| Asker { stations, found })
    });
    addresses[0].send(AnswerRequest::Begin { other: addresses[1].clone() }).expect("a running thread");
    addresses[1].send(AnswerRequest::Begin { other: addresses[0].clone() }).expect("a running thread");
    let result = || results.recv_timeout(Duration::from_secs(10)).expect("both come back");
    assert_eq!([result(), result()], [false, false], "each waits for the other");
}

/// Sends every message on, forever: two of these keep each other busy.
struct Echo {
    to: Address<u32>,
}

impl Receiver for Echo {
    type Message = u32;

    fn receive(&mut self, number: u32, _: &mut Context) {
        let _ = self.to.send(number + 1);
    }
}

#[test]
fn endless_activity_by_messages_in_a_circle() {
    let mut stage = Stage::new();
    let (left, right) = (stage.start("left"), stage.start("right"));
    let (to_left, to_right) = (left.reserve_address(), right.reserve_address());
    left.register_receiver_at(&to_left, {
        let to = to_right.clone();
        |_| Echo { to }
    });
    right.register_receiver_at(&to_right, {
        let to = to_left.clone();
        |_| Echo { to }
    });
    assert!(stage.settle(10));
    to_left.send(0).expect("a running thread");
    assert!(!stage.settle(1_000), "it never comes to rest");
}

#[test]
fn race_by_reading_a_view_and_sending_a_value_computed_from_it() {
    let (mut stage, _, panel) = editor();
    let turn = || {
        let row = panel.borrow().rows()[0].clone();
        let angle: f32 =
            row.split(' ').nth(1).and_then(|angle| angle.parse().ok()).expect("a row with an angle");
        panel.borrow().drag_angle(0, angle + 1.0);
    };
    // Called twice before the new view arrives.
    turn();
    turn();
    assert!(stage.settle(10));
    assert_eq!(panel.borrow().rows()[0], "hip 1.00 #ffffff", "one of two is lost");
    // The fix: an edit that contains the operation, whose result the owner computes.
    panel.borrow().toggle_visible(0);
    panel.borrow().toggle_visible(0);
    panel.borrow().toggle_visible(0);
    assert!(stage.settle(10));
    assert_eq!(panel.borrow().rows()[0], "hip 1.00 #ffffff hidden");
}

#[test]
fn stale_view_by_reading_before_the_new_one_is_delivered() {
    let (mut stage, [main, document, _], panel) = editor();
    panel.borrow().toggle_visible(0);
    assert!(!panel.borrow().rows()[0].contains("hidden"), "not yet with the document");
    stage.iterate(&document);
    assert!(!panel.borrow().rows()[0].contains("hidden"), "done, and not yet seen");
    stage.iterate(&main);
    assert!(panel.borrow().rows()[0].contains("hidden"));
}

#[test]
fn stale_answer_by_two_routes_to_the_same_thread() {
    let (mut stage, [main, document, graphics], panel) = editor();
    // The bone is hidden before it is clicked. But one message is sent by way of the document, the other directly to
    // the viewport.
    panel.borrow().toggle_visible(0);
    panel.borrow().click([0.5, 0.0]);
    stage.iterate(&graphics);
    stage.iterate(&document);
    stage.iterate(&main);
    assert_eq!(panel.borrow().selected(), Some(0));
    assert!(panel.borrow().rows()[0].contains("hidden"), "a hidden bone was picked");
}

#[test]
fn flood_by_a_sender_without_back_pressure() {
    let (stage, [_, document, _], panel) = editor();
    for step in 0..100_000 {
        panel.borrow().drag_angle(0, step as f32);
    }
    assert_eq!(document.queue_len(), 100_000, "all wait");
    drop(stage);
    // The fix, if only the newest message counts.
    let (_stage, [_, document, _], _) = editor();
    let newest = document.reserve_address::<Edit>().latest();
    for step in 0..100_000 {
        newest.send(Edit::SetAngle { bone: 0, angle: step as f32 }).expect("a running thread");
    }
    assert_eq!((newest.waiting(), document.queue_len()), (1, 1));
}

#[test]
fn lost_message_by_sending_to_a_removed_receiver() {
    let (mut stage, [_, document, _], _) = editor();
    let unregistered = document.reserve_address::<Edit>();
    let before = document.counters().undeliverable;
    assert!(unregistered.send(Edit::ToggleVisible { bone: 0 }).is_ok(), "accepted");
    stage.iterate(&document);
    assert_eq!(document.counters().undeliverable - before, 1, "and counted, but not delivered");
}
