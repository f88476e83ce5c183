//! Deadlines: alarms that objects set, and threads that are told to sleep (thesis §3.2.6.1).

use crate::cast::{Log, hear, listen, note, work};
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
        stage.context(&thread).register_worker(work(move |thread| {
            if !std::mem::replace(&mut set, true) {
                thread.wake_at(thread.now() + SECOND * secs);
            }
            true
        }));
    }
    for due in [2, 5, 9] {
        assert_eq!(stage.iterate(&thread), Next::At(start + SECOND * due));
        // A message in between takes no alarm away.
        assert_eq!(stage.iterate(&thread), Next::At(start + SECOND * due));
        let now = stage.now();
        stage.advance(start + SECOND * due - now);
    }
    assert_eq!(stage.iterate(&thread), Next::OnMessage, "all have rung");
}

#[test]
fn a_later_alarm_of_the_same_object_replaces_the_earlier() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let start = stage.now();
    let snooze = hear(|secs: u32, thread: &mut Context| thread.wake_at(thread.now() + SECOND * secs));
    let address = stage.context(&thread).register_receiver(snooze);
    address.send(2).unwrap();
    address.send(7).unwrap();
    assert_eq!(stage.iterate(&thread), Next::At(start + SECOND * 7));
}

#[test]
fn an_alarm_goes_with_its_object() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let soon = stage.now() + SECOND;
    let id = stage.context(&thread).register_worker(work(move |thread| {
        thread.wake_at(soon);
        true
    }));
    assert_eq!(stage.iterate(&thread), Next::At(soon));
    stage.context(&thread).unregister_worker(id);
    assert_eq!(stage.iterate(&thread), Next::OnMessage);
}

#[test]
fn a_sleeping_thread_delivers_nothing_and_loses_nothing() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(note(&log, "|"));
    let address = stage.context(&thread).register_receiver(listen(&log, "m"));
    address.send(1).unwrap();
    thread.remote_sleep(SECOND);
    address.send(2).unwrap();
    let morning = stage.now() + SECOND;
    assert_eq!(stage.iterate(&thread), Next::At(morning));
    assert_eq!(log.take(), "m1", "behind what was queued before it, and no worker after it");
    address.send(3).unwrap();
    stage.advance(SECOND / 2);
    assert_eq!(stage.iterate(&thread), Next::At(morning), "a message does not wake it");
    stage.advance(SECOND / 2);
    assert_eq!(stage.iterate(&thread), Next::OnMessage);
    assert_eq!(log.take(), "m2 m3 |");
}

#[test]
fn an_object_can_send_its_thread_to_sleep() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(note(&log, "a"));
    stage.context(&thread).register_worker(work(|thread| {
        thread.sleep(SECOND);
        true
    }));
    stage.context(&thread).register_worker(note(&log, "b"));
    let morning = stage.now() + SECOND;
    assert_eq!(stage.iterate(&thread), Next::At(morning));
    assert_eq!(log.take(), "a");
}
