//! Burst: many messages are queued while the consumer is busy, which then receives them all.

use super::threads;
use crate::RunValues;
use crate::runtime::peer::{Message, Peer, SmallMessage, sum_below};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

/// Message that makes the consumer wait until all messages of the burst are sent.
const HOLD: u64 = u64::MAX;

/// Sends two bursts of `messages` each, the first as a warm-up. Measures the time of the sender and of the consumer in
/// the second.
pub fn run<P: Peer>(messages: u64, measured: &mut RunValues) {
    let over: Arc<[AtomicBool; 2]> = Arc::default();
    let (tell, drained) = mpsc::channel();
    let (mut seen, mut sum, mut round) = (0, 0, 0);
    let mut begin = Instant::now();
    let gates = Arc::clone(&over);
    let (address, running) = P::start::<SmallMessage>(Box::new(move |message| {
        let number = message.number();
        if number == HOLD {
            while !gates[round].load(Ordering::Acquire) {
                thread::park_timeout(Duration::from_micros(50));
            }
            begin = Instant::now();
            return ControlFlow::Continue(());
        }
        seen += 1;
        sum += number;
        if seen < messages {
            return ControlFlow::Continue(());
        }
        let _ = tell.send((begin.elapsed(), sum));
        (seen, sum, round) = (0, 0, round + 1);
        if round == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }));
    let producer = threads::start("producer", move || {
        let burst = |gate: &AtomicBool| {
            P::send(&address, SmallMessage::of(HOLD));
            let begin = Instant::now();
            (0..messages).for_each(|number| P::send(&address, SmallMessage::of(number)));
            let sending = begin.elapsed();
            gate.store(true, Ordering::Release);
            let (draining, sum) = drained.recv().expect("the consumer tells when it has had everything");
            assert_eq!(sum, sum_below(messages), "messages of a burst were lost");
            (sending, draining)
        };
        burst(&over[0]);
        burst(&over[1])
    });
    P::wait(running);
    let (sending, draining) = threads::join(producer);
    measured.value("send", "ns", sending.as_nanos() as f64 / messages as f64);
    measured.value("drain", "ns", draining.as_nanos() as f64 / messages as f64);
}
