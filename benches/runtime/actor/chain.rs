//! Messages between two actors on the same thread: a batch, then one message back, which requests the next batch.

use super::local::LocalPeer;
use crate::RunValues;
use crate::runtime::peer::{Message, SmallMessage, sum_below};
use dragonfly_kit::counting;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant};
use tokio::sync::oneshot;

/// Number and size of the batches.
#[derive(Clone, Copy)]
pub struct ChainPlan {
    /// Number of measured batches. Before them runs a warm-up of a tenth of this number.
    pub batches: u64,
    /// Number of messages in each batch.
    pub batch: u64,
}

/// The next action of an actor after a message.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum ChainTurn {
    /// Wait for the next message.
    Wait,
    /// Request the next batch.
    Again,
    /// Stop: that was the last one.
    Over,
}

/// State of the actor that receives the batches: it counts and measures.
pub struct Score {
    plan: ChainPlan,
    seen: u64,
    sum: u64,
    batches: u64,
    begin: Instant,
    allocated: u64,
    result: Arc<Mutex<(Duration, u64)>>,
}

impl Score {
    /// Returns the state, and the place of its result: time and allocations.
    pub fn new(plan: ChainPlan) -> (Self, Arc<Mutex<(Duration, u64)>>) {
        let result: Arc<Mutex<(Duration, u64)>> = Arc::default();
        let begin = Instant::now();
        let own = Arc::clone(&result);
        (Self { plan, seen: 0, sum: 0, batches: 0, begin, allocated: 0, result: own }, result)
    }

    /// Counts a message.
    #[inline]
    pub fn add<M: Message>(&mut self, message: M) -> ChainTurn {
        self.seen += 1;
        self.sum += message.number();
        if self.seen < self.plan.batch { ChainTurn::Wait } else { self.end_batch() }
    }

    fn end_batch(&mut self) -> ChainTurn {
        assert_eq!(self.sum, sum_below(self.plan.batch), "messages were lost");
        (self.seen, self.sum) = (0, 0);
        self.batches += 1;
        let warm_up = self.plan.batches.div_ceil(10);
        if self.batches == warm_up {
            self.begin = Instant::now();
            self.allocated = counting::so_far().allocations;
        }
        if self.batches < warm_up + self.plan.batches {
            return ChainTurn::Again;
        }
        let allocations = counting::so_far().allocations - self.allocated;
        *self.result.lock().expect("no thread panics with the lock") = (self.begin.elapsed(), allocations);
        ChainTurn::Over
    }
}

/// Records the result of [`Score`].
pub fn write(plan: ChainPlan, result: &Mutex<(Duration, u64)>, measured: &mut RunValues) {
    let (time, allocations) = *result.lock().expect("no thread panics with the lock");
    let messages = (plan.batches * plan.batch) as f64;
    measured.value("per_message", "ns", time.as_nanos() as f64 / messages);
    measured.value("allocations", "1/msg", allocations as f64 / messages);
}

/// Measures the actors of `P`.
pub fn run<P: LocalPeer, M: Message>(plan: ChainPlan, measured: &mut RunValues) {
    let (mut score, result) = Score::new(plan);
    let mut stage = P::stage();
    let (tell, over) = oneshot::channel();
    let source: Arc<OnceLock<P::Address<SmallMessage>>> = Arc::default();
    let (home, mut tell) = (Arc::clone(&source), Some(tell));
    let sink = P::start_in::<M>(
        &mut stage,
        Box::new(move |message| {
            match score.add(message) {
                ChainTurn::Wait => {}
                ChainTurn::Again => {
                    P::send(home.get().expect("it is known before the first batch"), SmallMessage::of(0))
                }
                ChainTurn::Over => _ = tell.take().map(|tell| tell.send(())),
            }
            ControlFlow::Continue(())
        }),
    );
    let ask = P::start_in::<SmallMessage>(
        &mut stage,
        Box::new(move |_| {
            (0..plan.batch).for_each(|number| P::send(&sink, M::of(number)));
            ControlFlow::Continue(())
        }),
    );
    P::send(&ask, SmallMessage::of(0));
    let _ = source.set(ask);
    P::run(&mut stage, over);
    write(plan, &result, measured);
}
