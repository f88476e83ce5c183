//! The stage: everything happens in the order that the test chooses.

use crate::helpers::{Log, fn_receiver, fn_worker, log_calls, log_messages};
use dragonfly_runtime::{Context, Next, PendingMessage, Stage};
use std::time::Duration;

#[test]
fn messages_are_delivered_in_the_order_that_the_test_chooses() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(log_calls(&log, "|"));
    let a = stage.context(&thread).register_receiver(log_messages(&log, "a"));
    for message in 1..=3 {
        a.send(message).unwrap();
    }
    assert!(stage.deliver(&thread, 2));
    assert!(stage.deliver(&thread, 0));
    assert!(!stage.deliver(&thread, 1), "there is only one left");
    a.send(4).unwrap();
    stage.iterate(&thread);
    assert_eq!(log.take(), "a3 a1 a2 a4 |");
}

#[test]
fn queued_messages_can_be_listed() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let gone = thread.reserve_address::<String>();
    let here = stage.context(&thread).register_receiver(Ear);
    here.send(1).unwrap();
    here.latest().send(2).unwrap();
    gone.send("x".to_owned()).unwrap();
    thread.remote_sleep(Duration::ZERO);
    thread.remote_stop();
    let seen: Vec<_> = stage
        .waiting(&thread)
        .into_iter()
        .map(|PendingMessage { to, message }| format!("{to}<{message}"))
        .collect();
    assert_eq!(seen, ["Ear<u32", "Ear<u32", "<String", "<sleep", "<stop"]);
}

struct Ear;
impl dragonfly_runtime::Receiver for Ear {
    type Message = u32;
    fn receive(&mut self, _: u32, _: &mut Context) {}
}

#[test]
fn the_clock_of_a_stage_advances_only_on_request() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let now = stage.now();
    let timer = stage.context(&thread).timer();
    stage.iterate(&thread);
    assert_eq!((stage.now(), timer.time()), (now, Duration::ZERO));
    stage.advance(Duration::from_secs(3));
    assert_eq!((stage.now(), timer.time()), (now + Duration::from_secs(3), Duration::from_secs(3)));
}

#[test]
fn settle_runs_until_nothing_is_due() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let (left, right) = (stage.start("left"), stage.start("right"));
    let (to_left, to_right) = (left.reserve_address::<u32>(), right.reserve_address::<u32>());
    for (thread, own, other) in [(&left, &to_left, &to_right), (&right, &to_right, &to_left)] {
        let (other, lines) = (other.clone(), log.clone());
        let receiver = fn_receiver(move |ball: u32, thread: &mut Context| {
            lines.add(format!("{}{ball}", thread.handle().name()));
            if ball > 0 {
                other.send(ball - 1).unwrap();
            }
        });
        stage.context(thread).register_receiver_at(own, receiver);
    }
    to_right.send(3).unwrap();
    assert!(stage.settle(100));
    assert_eq!(log.take(), "right3 left2 right1 left0");
    to_left.send(0).unwrap();
    left.pause();
    assert!(stage.settle(100), "a paused thread has nothing to do");
    assert_eq!(log.take(), "");
}

#[test]
fn settle_returns_false_if_the_threads_never_come_to_rest() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(fn_worker(|thread| {
        thread.iterate_again();
        true
    }));
    assert!(!stage.settle(10));
    assert_eq!(stage.iterate(&thread), Next::Now);
}
