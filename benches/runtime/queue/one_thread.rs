//! Sending and receiving on one thread: cost of a queue without wake-ups and without contention.

use crate::runtime::own::peer::ConsumerReceiver;
use crate::runtime::peer::{Message, sum_below};
use crate::{RunValues, Study, Variant};
use dragonfly_kit::counting;
use dragonfly_runtime::Thread;
use std::cell::Cell;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::rc::Rc;
use std::sync::mpsc;
use std::time::Instant;

/// Number of messages that are sent before the first is received.
pub const BATCH: u64 = 1000;

/// Measures queues for messages of 8 and of 64 bytes.
pub fn all(study: &mut Study) {
    use crate::runtime::peer::WordMessage;
    let rounds = study.mode.pick(2, 200, 2000);
    study.compare("queue/one_thread/8_bytes", study.mode.pick(1, 5, 11), variants::<WordMessage<1>>(rounds));
    study.compare("queue/one_thread/64_bytes", study.mode.pick(1, 5, 11), variants::<WordMessage<8>>(rounds));
}

/// A channel whose two ends stay on the measuring thread.
macro_rules! channel {
    ($name:literal, $rounds:ident, $make:expr) => {
        Variant::new($name, move |measured| {
            let (enter, leave) = $make;
            let send = |message: M| enter.send(message).expect(HERE);
            batches($rounds, measured, send, || leave.recv().expect(HERE));
        })
    };
}

/// Message for errors that cannot happen.
const HERE: &str = "the other end lives here as well";

fn variants<M: Message>(rounds: u64) -> Vec<Variant<'static>> {
    vec![
        channel!("std", rounds, mpsc::channel()),
        channel!("crossbeam", rounds, crossbeam_channel::unbounded()),
        channel!("flume", rounds, flume::unbounded()),
        channel!("kanal", rounds, kanal::unbounded()),
        Variant::new("dragonfly", move |measured| dragonfly::<M>(rounds, measured)),
    ]
}

fn batches<M: Message>(rounds: u64, measured: &mut RunValues, send: impl Fn(M), receive: impl Fn() -> M) {
    timed(rounds, measured, || {
        (0..BATCH).for_each(|number| send(black_box(M::of(number))));
        (0..BATCH).map(|_| black_box(receive()).number()).sum()
    });
}

/// Measures a captured thread, so that sending and delivering happen on the measuring thread.
fn dragonfly<M: Message>(rounds: u64, measured: &mut RunValues) {
    let mut thread = Thread::capture("one thread", || {});
    let sum = Rc::new(Cell::new(0));
    let add = Rc::clone(&sum);
    let address = thread.context().register_receiver(ConsumerReceiver::new(move |message: M| {
        add.set(add.get() + message.number());
        ControlFlow::Continue(())
    }));
    timed(rounds, measured, || {
        (0..BATCH).for_each(|number| address.send(black_box(M::of(number))).expect(HERE));
        thread.iterate();
        sum.take()
    });
}

/// Runs a tenth of the rounds as a warm-up, then measures all of them.
pub fn timed(rounds: u64, measured: &mut RunValues, mut round: impl FnMut() -> u64) {
    let mut rounds_of = |count: u64| (0..count).for_each(|_| assert_eq!(round(), sum_below(BATCH)));
    rounds_of(rounds.div_ceil(10));
    let begin = Instant::now();
    let (count, ()) = counting::count(|| rounds_of(rounds));
    let messages = (rounds * BATCH) as f64;
    measured.value("per_message", "ns", begin.elapsed().as_nanos() as f64 / messages);
    measured.value("allocations", "1/msg", count.allocations as f64 / messages);
}
