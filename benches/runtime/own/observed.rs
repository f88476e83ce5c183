//! Cost of observation: the trace, off and on; the watchdog; and an iteration without work.

use super::peer::ConsumerReceiver;
use crate::runtime::peer::{Message, SmallMessage};
use crate::runtime::queue::one_thread::{BATCH, timed};
use crate::{RunValues, Study, Variant};
use dragonfly_runtime::{Captured, Context, STALL_LIMIT, Thread, Watchdog, Worker};
use std::cell::Cell;
use std::ops::ControlFlow;
use std::rc::Rc;
use std::time::Instant;

/// Measures messages to the own thread, and iterations without work.
pub fn all(study: &mut Study) {
    let repeats = study.mode.pick(1, 5, 11);
    let rounds = study.mode.pick(2, 100, 1_000);
    let variants = vec![
        Variant::new("not looked at", move |measured| messages(rounds, |_| (), measured)),
        Variant::new("traced, 1000 records", move |measured| {
            messages(rounds, |thread| thread.context().set_trace(1_000), measured);
        }),
        Variant::new("another is traced", move |measured| {
            let mut other = Thread::capture("other", || {});
            other.context().set_trace(1_000);
            messages(rounds, |_| (), measured);
        }),
        Variant::new("watched", move |measured| {
            let watchdog = Watchdog::start(STALL_LIMIT, |_| ()).expect("the system has a thread left");
            messages(rounds, |thread| watchdog.watch(thread.handle()), measured);
        }),
    ];
    study.compare("own/observed", repeats, variants);
    let iterations = study.mode.pick(100, 100_000, 1_000_000);
    let variants = vec![
        Variant::new("no worker", move |measured| idle(iterations, 0, measured)),
        Variant::new("1 worker", move |measured| idle(iterations, 1, measured)),
        Variant::new("10 workers", move |measured| idle(iterations, 10, measured)),
    ];
    study.compare("own/idle_iteration", repeats, variants);
}

fn messages(rounds: u64, look: impl FnOnce(&mut Captured), measured: &mut RunValues) {
    let mut thread = Thread::capture("observed", || {});
    look(&mut thread);
    let sum = Rc::new(Cell::new(0));
    let add = Rc::clone(&sum);
    let address = thread.context().register_receiver(ConsumerReceiver::new(move |message: SmallMessage| {
        add.set(add.get() + message.number());
        ControlFlow::Continue(())
    }));
    thread.iterate();
    timed(rounds, measured, || {
        (0..BATCH).for_each(|number| address.send(SmallMessage::of(number)).expect("the thread lives"));
        assert_eq!(address.queue_len() as u64, BATCH, "the queue's length is visible");
        thread.iterate();
        sum.take()
    });
}

struct CallCounter(Rc<Cell<u64>>);

impl Worker for CallCounter {
    fn update(&mut self, _: &mut Context) -> bool {
        self.0.set(self.0.get() + 1);
        true
    }
}

fn idle(iterations: u64, workers: u64, measured: &mut RunValues) {
    let mut thread = Thread::capture("idle", || {});
    let calls = Rc::new(Cell::new(0));
    (0..workers).for_each(|_| _ = thread.context().register_worker(CallCounter(Rc::clone(&calls))));
    (0..iterations / 10).for_each(|_| _ = thread.iterate());
    calls.set(0);
    let begin = Instant::now();
    (0..iterations).for_each(|_| _ = thread.iterate());
    measured.value("iteration", "ns", begin.elapsed().as_nanos() as f64 / iterations as f64);
    assert_eq!(calls.get(), iterations * workers);
}
