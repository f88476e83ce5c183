//! Alarms that objects set, and threads that sleep on request (thesis §3.2.6.1).

use crate::helpers::{Log, fn_receiver, fn_worker, log_calls, log_messages};
use dragonfly_runtime::{Context, Next, Stage};
use std::time::Duration;

const SECOND: Duration = Duration::from_secs(1);

#[test]
fn the_thread_is_due_at_the_earliest_alarm() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let start = stage.now();
    for secs in [5, 2, 9] {
        let mut set = false;
        stage.context(&thread).register_worker(fn_worker(move |thread| {
            if !std::mem::replace(&mut set, true) {
                thread.wake_at(thread.now() + SECOND * secs);
            }
            true
        }));
    }
    for due in [2, 5, 9] {
        assert_eq!(stage.iterate(&thread), Next::At(start + SECOND * due));
        // An iteration in between does not remove the alarm.
        assert_eq!(stage.iterate(&thread), Next::At(start + SECOND * due));
        let now = stage.now();
        stage.advance(start + SECOND * due - now);
    }
    assert_eq!(stage.iterate(&thread), Next::OnMessage, "no alarm is left");
}

#[test]
fn a_later_alarm_of_the_same_object_replaces_the_earlier() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let start = stage.now();
    let snooze = fn_receiver(|secs: u32, thread: &mut Context| thread.wake_at(thread.now() + SECOND * secs));
    let address = stage.context(&thread).register_receiver(snooze);
    address.send(2).unwrap();
    address.send(7).unwrap();
    assert_eq!(stage.iterate(&thread), Next::At(start + SECOND * 7));
}

#[test]
fn removing_an_object_removes_its_alarm() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let soon = stage.now() + SECOND;
    let id = stage.context(&thread).register_worker(fn_worker(move |thread| {
        thread.wake_at(soon);
        true
    }));
    assert_eq!(stage.iterate(&thread), Next::At(soon));
    stage.context(&thread).unregister_worker(id);
    assert_eq!(stage.iterate(&thread), Next::OnMessage);
}

#[test]
fn a_thread_that_sleeps_on_request_delivers_nothing_and_loses_nothing() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(log_calls(&log, "|"));
    let address = stage.context(&thread).register_receiver(log_messages(&log, "m"));
    address.send(1).unwrap();
    thread.remote_sleep(SECOND);
    address.send(2).unwrap();
    let wake_time = stage.now() + SECOND;
    assert_eq!(stage.iterate(&thread), Next::At(wake_time));
    assert_eq!(log.take(), "m1", "what was queued before the sleep is delivered, and no worker is called");
    address.send(3).unwrap();
    stage.advance(SECOND / 2);
    assert_eq!(stage.iterate(&thread), Next::At(wake_time), "a message does not wake it");
    stage.advance(SECOND / 2);
    assert_eq!(stage.iterate(&thread), Next::OnMessage);
    assert_eq!(log.take(), "m2 m3 |");
}

#[test]
fn an_object_can_make_its_thread_sleep() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(log_calls(&log, "a"));
    stage.context(&thread).register_worker(fn_worker(|thread| {
        thread.sleep(SECOND);
        true
    }));
    stage.context(&thread).register_worker(log_calls(&log, "b"));
    let wake_time = stage.now() + SECOND;
    assert_eq!(stage.iterate(&thread), Next::At(wake_time));
    assert_eq!(log.take(), "a");
}
