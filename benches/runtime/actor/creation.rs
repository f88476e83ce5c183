//! Cost of creating an actor, of its first message, and of an idle actor's memory.

use super::local::LocalPeer;
use super::tonari::Tonari;
use crate::RunValues;
use crate::runtime::peer::{Message, Peer, SmallMessage};
use dragonfly_kit::counting;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
use tokio::sync::oneshot;

/// Records the cost of `count` actors. The memory is the peak between the creation of the first actor and the delivery
/// of the last message, without the stacks of threads, which the allocator does not see.
pub fn write(
    count: u64,
    made: Duration,
    used: Duration,
    ended: Duration,
    bytes: u64,
    measured: &mut RunValues,
) {
    let each = |time: Duration| time.as_nanos() as f64 / count as f64;
    measured.value("make", "ns", each(made));
    measured.value("first_message", "ns", each(used));
    measured.value("end_with_all", "ns", each(ended));
    measured.value("memory", "bytes", bytes as f64 / count as f64);
}

/// Measures the actors of `P`, all on this thread.
pub fn run<P: LocalPeer>(count: u64, measured: &mut RunValues) {
    let mut stage = P::stage();
    let (tell, over) = oneshot::channel();
    let tell = Arc::new(Mutex::new(Some(tell)));
    let left = Arc::new(AtomicU64::new(count));
    let mut made = Duration::ZERO;
    let mut used = Duration::ZERO;
    let (bytes, actors) = counting::peak(|| {
        let begin = Instant::now();
        let actors: Vec<P::Address<SmallMessage>> = (0..count)
            .map(|_| {
                let (left, tell) = (Arc::clone(&left), Arc::clone(&tell));
                let take = move |_| {
                    if left.fetch_sub(1, Ordering::Relaxed) == 1 {
                        let _ = tell
                            .lock()
                            .expect("no thread panics with the lock")
                            .take()
                            .map(|tell| tell.send(()));
                    }
                    ControlFlow::Continue(())
                };
                P::start_in::<SmallMessage>(&mut stage, Box::new(take))
            })
            .collect();
        made = begin.elapsed();
        let begin = Instant::now();
        actors.iter().for_each(|actor| P::send(actor, SmallMessage::of(0)));
        P::run(&mut stage, over);
        used = begin.elapsed();
        actors
    });
    let begin = Instant::now();
    drop(actors);
    drop(stage);
    write(count, made, used, begin.elapsed(), bytes, measured);
}

/// Measures the actors of tonari-actor, which have an OS thread each.
pub fn threads(count: u64, measured: &mut RunValues) {
    let mut all = Vec::new();
    let begin = Instant::now();
    let (bytes, made) = counting::peak(|| {
        all.extend((0..count).map(|_| Tonari::start::<SmallMessage>(Box::new(|_| ControlFlow::Break(())))));
        begin.elapsed()
    });
    let begin = Instant::now();
    all.iter().for_each(|(address, _)| Tonari::send(address, SmallMessage::of(0)));
    all.iter().for_each(|(_, running)| running.wait_for_last_message());
    let used = begin.elapsed();
    let begin = Instant::now();
    all.into_iter().for_each(|(_, running)| running.end());
    write(count, made, used, begin.elapsed(), bytes, measured);
}
