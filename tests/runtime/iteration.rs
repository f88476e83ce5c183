//! The loop: deliver all queued messages, then call the workers in order (thesis §3.2.6.1).

use crate::helpers::{Log, fn_receiver, fn_worker, log_calls, log_messages};
use dragonfly_runtime::{Next, Stage};

#[test]
fn all_queued_messages_are_delivered_before_the_workers_are_called() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(log_calls(&log, "work"));
    let a = stage.context(&thread).register_receiver(log_messages(&log, "a"));
    let b = stage.context(&thread).register_receiver(log_messages(&log, "b"));
    a.send(1).unwrap();
    b.send(2).unwrap();
    a.send(3).unwrap();
    stage.iterate(&thread);
    assert_eq!(log.take(), "a1 b2 a3 work");
    stage.iterate(&thread);
    assert_eq!(log.take(), "work");
}

#[test]
fn workers_are_called_in_the_order_of_registration() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    for name in ["open", "draw", "present"] {
        stage.context(&thread).register_worker(log_calls(&log, name));
    }
    stage.iterate(&thread);
    stage.iterate(&thread);
    assert_eq!(log.take(), "open draw present open draw present");
}

#[test]
fn a_worker_that_returns_false_ends_the_iteration() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(log_calls(&log, "first"));
    let mut ready = false;
    stage.context(&thread).register_worker(fn_worker(move |_| std::mem::replace(&mut ready, true)));
    stage.context(&thread).register_worker(log_calls(&log, "third"));
    stage.iterate(&thread);
    assert_eq!(log.take(), "first", "the device is not ready");
    stage.iterate(&thread);
    assert_eq!(log.take(), "first third", "now it is");
}

#[test]
fn messages_sent_during_an_iteration_are_delivered_in_the_next_one() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let echo = stage.context(&thread).handle().reserve_address();
    let (own, lines) = (echo.clone(), log.clone());
    let receiver = fn_receiver(move |message: u32, _| {
        lines.add(message.to_string());
        if message < 3 {
            own.send(message + 1).unwrap();
        }
    });
    stage.context(&thread).register_receiver_at(&echo, receiver);
    stage.context(&thread).register_worker(log_calls(&log, "|"));
    echo.send(1).unwrap();
    assert_eq!(stage.iterate(&thread), Next::Now);
    assert_eq!(stage.iterate(&thread), Next::Now);
    assert_eq!(stage.iterate(&thread), Next::OnMessage);
    assert_eq!(log.take(), "1 | 2 | 3 |");
}

#[test]
fn an_iteration_is_due_at_once_only_while_a_worker_requests_it() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let mut frames = 3;
    stage.context(&thread).register_worker(fn_worker(move |thread| {
        frames -= 1;
        if frames > 0 {
            thread.iterate_again();
        }
        true
    }));
    let next: Vec<_> = (0..3).map(|_| stage.iterate(&thread)).collect();
    assert_eq!(next, [Next::Now, Next::Now, Next::OnMessage]);
}

#[test]
fn returning_false_does_not_request_another_iteration() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(fn_worker(|_| false));
    assert_eq!(stage.iterate(&thread), Next::OnMessage);
}

#[test]
fn an_iteration_without_messages_or_changes_allocates_nothing() {
    let mut stage = Stage::new();
    let thread = stage.start("thread");
    let start = stage.now();
    for _ in 0..5 {
        stage.context(&thread).register_worker(fn_worker(move |thread| {
            thread.iterate_again();
            thread.wake_at(start);
            true
        }));
    }
    stage.iterate(&thread);
    let (count, _) = dragonfly_kit::counting::count(|| {
        for _ in 0..100 {
            stage.iterate(&thread);
        }
    });
    assert_eq!(count.allocations, 0);
}

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
