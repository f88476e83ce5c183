//! Throughput in one direction at full speed: from the first send to the last delivery.

use super::threads;
use crate::RunValues;
use crate::runtime::peer::{Message, Peer, sum_below};
use dragonfly_kit::counting;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Barrier, mpsc};
use std::time::Instant;

/// Number of producers and messages.
#[derive(Clone, Copy)]
pub struct OneWayPlan {
    /// Number of OS threads that send at the same time.
    pub producers: u64,
    /// Number of measured messages of each producer.
    pub messages: u64,
}

/// Recorded by the consumer at the last message.
struct OneWayEnd {
    when: Instant,
    sum: u64,
    allocations: u64,
}

/// Sends a tenth of the messages as a warm-up, and measures the others once these are delivered.
pub fn run<P: Peer, M: Message>(plan: OneWayPlan, measured: &mut RunValues) {
    let warm_up = (plan.messages / 10).max(1);
    let (warm, total) = (warm_up * plan.producers, (warm_up + plan.messages) * plan.producers);
    let is_warm = Arc::new(AtomicBool::new(false));
    let (tell, end) = mpsc::channel();
    let (mut seen, mut sum, mut allocated) = (0, 0, 0);
    let ready = Arc::clone(&is_warm);
    let (address, running) = P::start::<M>(Box::new(move |message| {
        seen += 1;
        sum += message.number();
        if seen == warm {
            allocated = counting::so_far().allocations;
            ready.store(true, Ordering::Release);
        }
        if seen < total {
            return ControlFlow::Continue(());
        }
        let allocations = counting::so_far().allocations.saturating_sub(allocated);
        let _ = tell.send(OneWayEnd { when: Instant::now(), sum, allocations });
        ControlFlow::Break(())
    }));
    let together = Arc::new(Barrier::new(plan.producers as usize));
    let producers: Vec<_> = (0..plan.producers)
        .map(|_| {
            let (address, is_warm, together) = (address.clone(), Arc::clone(&is_warm), Arc::clone(&together));
            threads::start("producer", move || {
                (0..warm_up).for_each(|number| P::send(&address, M::of(number)));
                threads::wait_for(&is_warm);
                together.wait();
                let begin = Instant::now();
                let send = || (0..plan.messages).for_each(|number| P::send(&address, M::of(number)));
                let (count, ()) = counting::count(send);
                (begin, begin.elapsed(), count.allocations)
            })
        })
        .collect();
    drop(address);
    P::wait(running);
    let producers: Vec<_> = producers.into_iter().map(threads::join).collect();
    let end = end.recv().expect("the consumer had everything");
    assert_eq!(
        end.sum,
        plan.producers * (sum_below(warm_up) + sum_below(plan.messages)),
        "messages were lost"
    );
    let begin = producers.iter().map(|(begin, ..)| *begin).min().expect("there is a producer");
    let messages = (plan.messages * plan.producers) as f64;
    measured.value("per_message", "ns", (end.when - begin).as_nanos() as f64 / messages);
    let sending: f64 = producers.iter().map(|(_, took, _)| took.as_nanos() as f64).sum();
    measured.value("send", "ns", sending / messages);
    if !P::MIGRATES {
        let sent: u64 = producers.iter().map(|(.., allocations)| allocations).sum();
        measured.value("allocations", "1/msg", (sent + end.allocations) as f64 / messages);
    }
}
