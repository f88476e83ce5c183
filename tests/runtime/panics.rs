//! R5: a panic costs one message, or one object, never the thread.

use crate::helpers::{
    FnWorker, LIMIT, Log, deadline, fn_receiver, fn_worker, forwarder, log_calls, log_messages, panic_quietly,
};
use dragonfly_kit::process::{alone, resident_bytes};
use dragonfly_runtime::{Context, Fault, Outcome, Receiver, Stage, Thread};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Returns a list that collects the faults of a thread on a stage.
fn faults(thread: &mut Context) -> Rc<RefCell<Vec<Fault>>> {
    let seen = Rc::new(RefCell::new(Vec::new()));
    let list = Rc::clone(&seen);
    thread.observe(move |fault| list.borrow_mut().push(fault.clone()));
    seen
}

#[test]
fn a_worker_that_panics_is_removed_and_reported_and_the_others_continue() {
    struct Clumsy;
    impl dragonfly_runtime::Worker for Clumsy {
        fn update(&mut self, _: &mut Context) -> bool {
            panic!("dropped {}", "everything")
        }
    }

    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("kitchen");
    let seen = faults(stage.context(&thread));
    stage.context(&thread).register_worker(log_calls(&log, "a"));
    stage.context(&thread).register_worker(Clumsy);
    stage.context(&thread).register_worker(log_calls(&log, "b"));
    stage.iterate(&thread);
    assert_eq!(log.take(), "a", "workers after it may depend on it: as if it had returned false");
    stage.iterate(&thread);
    assert_eq!(log.take(), "a b");
    let seen = seen.borrow();
    assert_eq!(seen.len(), 1);
    assert_eq!((&*seen[0].thread, &*seen[0].object, seen[0].call), ("kitchen", "Clumsy", "update"));
    assert_eq!((&*seen[0].reason, seen[0].outcome), ("dropped everything", Outcome::Removed));
    assert_eq!(thread.counters().panics, 1);
}

#[test]
fn a_receiver_that_panics_is_removed_and_reported_with_its_message_type() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("kitchen");
    let seen = faults(stage.context(&thread));
    let bad = fn_receiver(|_: String, _: &mut Context| panic_quietly("no"));
    let bad = stage.context(&thread).register_receiver(bad);
    let good = stage.context(&thread).register_receiver(log_messages(&log, "good"));
    bad.send("one".to_owned()).unwrap();
    good.send(1).unwrap();
    bad.send("two".to_owned()).unwrap();
    good.send(2).unwrap();
    stage.iterate(&thread);
    assert_eq!(log.take(), "good1 good2");
    let seen = seen.borrow();
    assert_eq!((seen.len(), seen[0].call, &*seen[0].reason), (1, "String", "no"));
    assert_eq!((thread.counters().delivered, thread.counters().undeliverable), (3, 1));
}

#[test]
fn a_panic_in_a_closure_a_factory_or_a_drop_does_not_end_the_thread() {
    struct Sticky;
    impl Receiver for Sticky {
        type Message = ();
        fn receive(&mut self, (): (), _: &mut Context) {}
    }
    impl Drop for Sticky {
        fn drop(&mut self) {
            panic_quietly("would not go")
        }
    }

    let mut stage = Stage::new();
    let thread = stage.start("kitchen");
    let seen = faults(stage.context(&thread));
    thread.run(|_| panic_quietly("in a closure")).unwrap();
    thread.register_worker(|_| -> FnWorker<fn(&mut Context) -> bool> { panic_quietly("in the making") });
    let sticky = thread.register_receiver(|_| Sticky);
    thread.unregister_receiver(&sticky);
    thread.register_receiver(|_| Sticky); // Dropped at the end of the thread.
    stage.iterate(&thread);
    thread.remote_stop();
    stage.iterate(&thread);
    let reasons: Vec<_> = seen.borrow().iter().map(|fault| fault.reason.clone()).collect();
    assert_eq!(reasons, ["in a closure", "in the making", "would not go", "would not go"]);
    assert!(thread.is_stopped());
}

#[test]
fn a_message_that_panics_when_dropped_does_not_end_the_thread() {
    struct Grudge;
    impl Drop for Grudge {
        fn drop(&mut self) {
            panic_quietly("never forgotten")
        }
    }

    let thread = Thread::start("grudge").unwrap();
    let handle = thread.handle().clone();
    let gone = handle.reserve_address::<Grudge>();
    let (receiver, received) = forwarder();
    let alive = handle.register_receiver(|_| receiver);
    gone.send(Grudge).unwrap();
    gone.latest().send(Grudge).unwrap();
    alive.send(1).unwrap();
    assert_eq!(received.recv_timeout(LIMIT), Ok(1));
    assert_eq!(handle.counters().undeliverable, 2);
    handle.pause();
    handle.run(|thread| thread.stop()).unwrap();
    gone.send(Grudge).unwrap();
    gone.send(Grudge).unwrap();
    handle.resume();
    Thread::wait_for(std::slice::from_ref(&handle), deadline()).unwrap();
    assert_eq!(handle.counters().undelivered, 2);
}

#[test]
fn an_observer_that_panics_is_removed() {
    let mut stage = Stage::new();
    let thread = stage.start("kitchen");
    let asked = Rc::new(RefCell::new(0));
    let count = Rc::clone(&asked);
    stage.context(&thread).observe(move |_| {
        *count.borrow_mut() += 1;
        panic_quietly("the observer too");
    });
    for _ in 0..3 {
        thread.run(|_| panic_quietly("again")).unwrap();
    }
    stage.iterate(&thread);
    assert_eq!((*asked.borrow(), thread.counters().panics), (1, 3));
}

/// Returns a factory of receivers that count their messages and panic with every multiple of `trap`.
fn trapped(trap: u32, log: &Log) -> impl FnMut(&mut Context) -> Trapped + use<> {
    let log = log.clone();
    move |_| Trapped { trap, count: 0, log: log.clone() }
}

struct Trapped {
    trap: u32,
    count: u32,
    log: Log,
}

impl Receiver for Trapped {
    type Message = u32;
    fn receive(&mut self, message: u32, _: &mut Context) {
        if message.is_multiple_of(self.trap) {
            panic_quietly("trapped");
        }
        self.count += 1;
        self.log.add(format!("{message}:{}", self.count));
    }
}

#[test]
fn a_restarted_receiver_has_new_state_and_loses_only_one_message() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("kitchen");
    let seen = faults(stage.context(&thread));
    let address = thread.reserve_address();
    stage.context(&thread).register_restartable_receiver_at(&address, trapped(3, &log));
    for message in 1..=8 {
        address.send(message).unwrap();
    }
    stage.iterate(&thread);
    assert_eq!(log.take(), "1:1 2:2 4:1 5:2 7:1 8:2");
    assert!(seen.borrow().iter().all(|fault| fault.outcome == Outcome::Restarted));
    assert_eq!(thread.counters().restarts, 2);
}

#[test]
fn a_restarted_worker_keeps_its_position() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("kitchen");
    stage.context(&thread).register_worker(log_calls(&log, "a"));
    let (lines, mut made) = (log.clone(), 0);
    stage.context(&thread).register_restartable_worker(move |_| {
        made += 1;
        let (lines, made) = (lines.clone(), made);
        fn_worker(move |_: &mut Context| {
            if made == 1 {
                panic_quietly("the first one");
            }
            lines.add(format!("made{made}"));
            true
        })
    });
    stage.context(&thread).register_worker(log_calls(&log, "b"));
    stage.iterate(&thread);
    stage.iterate(&thread);
    assert_eq!(log.take(), "a a made2 b");
}

#[test]
fn restartable_objects_can_be_registered_from_another_thread() {
    let thread = Thread::start("outside").unwrap();
    let (inside, outside) = std::sync::mpsc::channel();
    let said = inside.clone();
    let mut made = 0;
    let receiver = move |_: &mut Context| {
        made += 1;
        let (said, made) = (said.clone(), made);
        fn_receiver(move |message: u32, _: &mut Context| match message {
            0 => panic_quietly("zero"),
            _ => said.send((made, message)).unwrap(),
        })
    };
    let mut turns = 0;
    let worker = move |_: &mut Context| {
        turns += 1;
        let (inside, turns) = (inside.clone(), turns);
        fn_worker(move |_: &mut Context| match turns {
            1 => panic_quietly("the first one"),
            _ => inside.send((turns, 0)).is_ok(),
        })
    };
    let address = thread.handle().reserve_address();
    let own = address.clone();
    let register = move |thread: &mut Context| {
        thread.register_restartable_receiver_at(&own, receiver);
        thread.register_restartable_worker(worker);
    };
    thread.handle().run(register).unwrap();
    for message in [1, 0, 2] {
        address.send(message).unwrap();
    }
    thread.handle().remote_sleep(Duration::ZERO); // Ends the batch: one more iteration.
    address.send(3).unwrap();
    let mut seen: Vec<(u32, u32)> = Vec::new();
    while !(seen.contains(&(2, 3)) && seen.contains(&(2, 0))) {
        address.send(4).unwrap();
        seen.push(outside.recv_timeout(LIMIT).unwrap());
    }
    assert!(seen.contains(&(1, 1)) && seen.contains(&(2, 2)), "{seen:?}");
    assert_eq!(thread.handle().counters().restarts, 2);
}

#[test]
fn an_object_is_given_up_after_more_than_three_panics_in_ten_seconds() {
    let (mut stage, log) = (Stage::new(), Log::default());
    let thread = stage.start("kitchen");
    let seen = faults(stage.context(&thread));
    let address = thread.reserve_address();
    stage.context(&thread).register_restartable_receiver_at(&address, trapped(1, &log));
    // One panic every four seconds: a thousand of them are tolerated.
    for _ in 0..1000 {
        stage.advance(Duration::from_secs(4));
        address.send(1).unwrap();
        stage.iterate(&thread);
    }
    assert!(seen.borrow().iter().all(|fault| fault.outcome == Outcome::Restarted));
    // Panics in quick succession: the object is not restarted after the fourth.
    stage.advance(Duration::from_secs(10));
    seen.borrow_mut().clear();
    for _ in 0..5 {
        address.send(1).unwrap();
    }
    stage.iterate(&thread);
    let outcomes: Vec<_> = seen.borrow().iter().map(|fault| fault.outcome).collect();
    assert_eq!(outcomes[..3], [Outcome::Restarted; 3]);
    assert_eq!(outcomes[3..], [Outcome::GivenUp]);
    assert_eq!(thread.counters().undeliverable, 1, "the fifth message");
}

/// In an OS thread: 1,200 panics, in receivers and in workers, among 60,000 messages.
#[test]
fn a_thousand_panics_lose_no_other_message_and_leak_no_memory() {
    alone("panics::a_thousand_panics_lose_no_other_message_and_leak_no_memory", || {
        const ROUNDS: u64 = 1000;
        let thread = Thread::start("panicky").unwrap();
        let handle = thread.handle().clone();
        let reported = Arc::new(AtomicU64::new(0));
        let reports = Arc::clone(&reported);
        handle.observe(move |_| {
            reports.fetch_add(1, Ordering::Relaxed);
        });
        let (receiver, received) = forwarder();
        let steady = handle.register_receiver(|_| receiver);
        let round = |round: u64| {
            let bad = handle.register_receiver(|_| fn_receiver(|_: Vec<u8>, _| panic_quietly("injected")));
            handle.register_worker(|_| fn_worker(|_| panic_quietly("injected")));
            for message in 0..49 {
                steady.send(round * 98 + message).unwrap();
            }
            bad.send(vec![0; 1000]).unwrap();
            for message in 49..98 {
                steady.send(round * 98 + message).unwrap();
            }
            bad.send(vec![0; 1000]).unwrap();
            for message in 0..98 {
                assert_eq!(received.recv_timeout(LIMIT), Ok(round * 98 + message));
            }
        };
        (0..ROUNDS / 10).for_each(round); // Lets the allocator grow to its usual size.
        let before = resident_bytes();
        (ROUNDS / 10..ROUNDS / 10 + ROUNDS / 2).for_each(round);
        let grown = resident_bytes().saturating_sub(before);
        handle.remote_stop();
        Thread::wait_for(std::slice::from_ref(&handle), deadline()).unwrap();
        let counters = handle.counters();
        println!("R5: {} panics, {} messages, {grown} bytes grown", counters.panics, counters.delivered);
        assert!(counters.panics >= ROUNDS, "{counters:?}");
        assert_eq!(reported.load(Ordering::Relaxed), counters.panics);
        assert!(grown <= 1 << 20, "{grown} bytes");
    });
}
