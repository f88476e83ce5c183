//! Stopping, pausing and waiting for threads; the order of a shutdown (thesis §2.2.6.3, §3.2.6.1).

use crate::helpers::{
    LIMIT, Log, LogOnDrop, deadline, fn_receiver, fn_worker, forwarder, log_calls, log_messages,
    plain_thread, worker_holding,
};
use dragonfly_runtime::{Context, Next, Stage, Thread};
use std::sync::Arc;
use std::time::{Duration, Instant};

#[test]
fn a_remote_stop_comes_after_all_messages_queued_before_it() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(log_calls(&log, "work"));
    let address = stage.context(&thread).register_receiver(log_messages(&log, "m"));
    address.send(1).unwrap();
    address.send(2).unwrap();
    thread.remote_stop();
    address.send(3).unwrap();
    assert_eq!(stage.iterate(&thread), Next::Stopped);
    assert_eq!(log.take(), "m1 m2");
    assert_eq!(thread.counters().undelivered, 1);
    assert_eq!(stage.iterate(&thread), Next::Stopped, "for good");
}

#[test]
fn a_stop_from_inside_takes_effect_at_once() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(log_calls(&log, "a"));
    stage.context(&thread).register_worker(fn_worker(|thread| {
        thread.stop();
        true
    }));
    stage.context(&thread).register_worker(log_calls(&log, "b"));
    assert_eq!(stage.iterate(&thread), Next::Stopped);
    assert_eq!(log.take(), "a");
    assert!(thread.is_stopped());
}

#[test]
fn objects_are_dropped_in_reverse_order_workers_first() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let context = stage.context(&thread);
    let part = |name| worker_holding(LogOnDrop(log.clone(), name));
    let device = LogOnDrop(log.clone(), "device");
    context.register_receiver(fn_receiver(move |_: u32, _: &mut Context| {
        let LogOnDrop(..) = &device;
    }));
    context.register_last_worker(part("present"));
    context.register_worker(part("scene"));
    context.register_worker(part("model"));
    thread.remote_stop();
    stage.iterate(&thread);
    assert_eq!(log.take(), "present model scene device");
}

#[test]
fn messages_left_in_a_stopped_thread_are_dropped() {
    let thread = Thread::start("left").unwrap();
    let content = Arc::new(());
    let address = thread.handle().register_receiver(|_| fn_receiver(|_: Arc<()>, _| ()));
    // Paused so that the stop and the message are in one batch.
    thread.handle().pause();
    thread.handle().run(|thread| thread.stop()).unwrap();
    address.send(Arc::clone(&content)).unwrap();
    thread.handle().resume();
    Thread::wait_for(&[thread.handle().clone()], deadline()).unwrap();
    assert_eq!(Arc::strong_count(&content), 1);
}

#[test]
fn a_paused_thread_does_nothing_until_it_is_resumed() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    stage.context(&thread).register_worker(log_calls(&log, "|"));
    let address = stage.context(&thread).register_receiver(log_messages(&log, "m"));
    thread.pause();
    address.send(1).unwrap();
    assert_eq!(stage.iterate(&thread), Next::OnMessage);
    assert_eq!(log.take(), "");
    thread.resume();
    assert_eq!(stage.iterate(&thread), Next::OnMessage);
    assert_eq!(log.take(), "m1 |");
}

#[test]
fn a_pause_takes_effect_between_two_calls() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("thread");
    let lines = log.clone();
    let receiver = fn_receiver(move |message: u32, thread: &mut Context| {
        lines.add(message.to_string());
        if message == 1 {
            thread.pause();
        }
    });
    let address = stage.context(&thread).register_receiver(receiver);
    address.send(1).unwrap();
    address.send(2).unwrap();
    stage.iterate(&thread);
    assert_eq!(log.take(), "1");
    thread.resume();
    stage.iterate(&thread);
    assert_eq!(log.take(), "2", "undelivered messages come first");
}

#[test]
fn a_stop_ends_a_pause_and_a_sleep() {
    for rest in [|thread: &mut Context| thread.pause(), |thread: &mut Context| thread.sleep(LIMIT)] {
        let thread = Thread::start("resting").unwrap();
        let (receiver, received) = forwarder();
        let address = thread.handle().register_receiver(|_| receiver);
        thread.handle().run(rest).unwrap();
        address.send(1_u32).unwrap();
        let begin = Instant::now();
        thread.handle().remote_stop();
        Thread::wait_for(&[thread.handle().clone()], deadline()).unwrap();
        assert!(begin.elapsed() < LIMIT / 2);
        assert_eq!(received.try_iter().collect::<Vec<_>>(), [1], "messages before the stop are delivered");
    }
}

#[test]
fn wait_for_waits_for_several_threads() {
    let threads: Vec<_> = (0..4).map(|_| Thread::start("several").unwrap()).collect();
    let handles: Vec<_> = threads.iter().map(|thread| thread.handle().clone()).collect();
    let stopper = handles.clone();
    let stopper = plain_thread(move || {
        for handle in stopper {
            handle.remote_stop();
        }
    });
    Thread::wait_for(&handles, deadline()).unwrap();
    assert!(handles.iter().all(|handle| handle.is_stopped()));
    stopper.join().unwrap();
}

#[test]
fn wait_for_returns_the_names_of_threads_still_running_at_the_deadline() {
    let threads = ["stays", "goes", "stays too"].map(|name| Thread::start(name).unwrap());
    let handles = threads.each_ref().map(|thread| thread.handle().clone());
    handles[1].remote_stop();
    Thread::wait_for(&handles[1..2], deadline()).unwrap();
    let soon = Instant::now() + Duration::from_millis(20);
    let running = Thread::wait_for(&handles, soon).unwrap_err();
    assert!(Instant::now() >= soon);
    assert_eq!(running, ["stays", "stays too"]);
}

#[test]
fn dropping_a_thread_stops_it_after_its_messages() {
    let (receiver, received) = forwarder();
    let thread = Thread::start("dropped").unwrap();
    let address = thread.handle().register_receiver(|_| receiver);
    for message in 0..1000_u32 {
        address.send(message).unwrap();
    }
    drop(thread);
    assert_eq!(received.try_iter().count(), 1000);
    assert!(address.send(1).is_err());
}

#[test]
fn a_captured_thread_that_is_dropped_is_stopped() {
    let (mut captured, log) = (Thread::capture("window", || ()), Log::default());
    let address = captured.context().register_receiver(log_messages(&log, "m"));
    captured.context().register_worker(worker_holding(LogOnDrop(log.clone(), "dropped")));
    let handle = captured.handle().clone();
    address.send(1).unwrap();
    drop(captured);
    assert_eq!(log.take(), "dropped");
    assert!(handle.is_stopped() && address.send(2).is_err());
    Thread::wait_for(&[handle], deadline()).unwrap();
}
