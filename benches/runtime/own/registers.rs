//! Cost of registering and removing objects, from inside of the thread and by message.

use super::peer::{ConsumerReceiver, wait_for};
use crate::runtime::peer::{Message, SmallMessage};
use crate::{RunValues, Study, Variant};
use dragonfly_runtime::{Context, Thread, Worker, WorkerId};
use std::ops::ControlFlow;
use std::time::Instant;

struct IdleWorker;

impl Worker for IdleWorker {
    fn update(&mut self, _: &mut Context) -> bool {
        true
    }
}

/// Measures receivers and workers. Their number makes the register larger than a cache line.
pub fn all(study: &mut Study) {
    let count = study.mode.pick(10, 1_000, 1_000);
    let variants = vec![
        Variant::new("receiver, inside", move |measured| receivers_inside(count, measured)),
        Variant::new("receiver, by message", move |measured| receivers_by_message(count, measured)),
        Variant::new("worker, inside", move |measured| workers_inside(count, measured)),
    ];
    study.compare("own/registers", study.mode.pick(1, 11, 51), variants);
}

fn sink() -> ConsumerReceiver<SmallMessage, impl FnMut(SmallMessage) -> ControlFlow<()>> {
    ConsumerReceiver::new(|message: SmallMessage| {
        assert_eq!(message.number(), 0);
        ControlFlow::Continue(())
    })
}

fn receivers_inside(count: u64, measured: &mut RunValues) {
    let mut thread = Thread::capture("registers", || {});
    let context = thread.context();
    let begin = Instant::now();
    let all: Vec<_> = (0..count).map(|_| context.register_receiver(sink())).collect();
    let made = begin.elapsed();
    let begin = Instant::now();
    all.iter().for_each(|address| assert!(context.unregister_receiver(address)));
    write(count, made, begin.elapsed(), measured);
}

fn workers_inside(count: u64, measured: &mut RunValues) {
    let mut thread = Thread::capture("registers", || {});
    let context = thread.context();
    let begin = Instant::now();
    let all: Vec<WorkerId> = (0..count).map(|_| context.register_worker(IdleWorker)).collect();
    let made = begin.elapsed();
    let begin = Instant::now();
    all.into_iter().for_each(|id| assert!(context.unregister_worker(id)));
    write(count, made, begin.elapsed(), measured);
}

/// Measures the time from the first request to register until the thread has processed all requests,
/// and the same for the removal.
fn receivers_by_message(count: u64, measured: &mut RunValues) {
    let thread = Thread::start("registers").expect("the system has a thread left");
    let handle = thread.handle();
    let (tell, done) = std::sync::mpsc::channel();
    let ended = tell.clone();
    let begin = Instant::now();
    let all: Vec<_> = (0..count).map(|_| handle.register_receiver(|_| sink())).collect();
    let _ = handle.run(move |_| _ = tell.send(Instant::now()));
    let made = done.recv().expect("the thread runs it") - begin;
    let begin = Instant::now();
    all.iter().for_each(|address| handle.unregister_receiver(address));
    let _ = handle.run(move |thread| {
        let _ = ended.send(Instant::now());
        thread.stop();
    });
    let removed = done.recv().expect("the thread runs it") - begin;
    wait_for(handle);
    write(count, made, removed, measured);
}

fn write(count: u64, made: std::time::Duration, removed: std::time::Duration, measured: &mut RunValues) {
    measured.value("register", "ns", made.as_nanos() as f64 / count as f64);
    measured.value("remove", "ns", removed.as_nanos() as f64 / count as f64);
}
