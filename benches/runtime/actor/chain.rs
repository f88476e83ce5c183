//! From one actor to another on the same thread: a batch of messages, then one back, which asks for the next batch.

use super::local::Local;
use crate::Measured;
use crate::runtime::peer::{Message, Small, sum_below};
use dragonfly_kit::counting;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant};
use tokio::sync::oneshot;

/// How much.
#[derive(Clone, Copy)]
pub struct Plan {
    /// Batches on the clock; a tenth of them goes before, for warming up.
    pub batches: u64,
    /// Messages in each.
    pub batch: u64,
}

/// What is to be done after a message.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// Wait for the next.
    Wait,
    /// Ask for the next batch.
    Again,
    /// That was all.
    Over,
}

/// The one that gets the batches: counts, and measures.
pub struct Score {
    plan: Plan,
    seen: u64,
    sum: u64,
    batches: u64,
    begin: Instant,
    allocated: u64,
    result: Arc<Mutex<(Duration, u64)>>,
}

impl Score {
    /// And where the time and the allocations will be.
    pub fn new(plan: Plan) -> (Self, Arc<Mutex<(Duration, u64)>>) {
        let result: Arc<Mutex<(Duration, u64)>> = Arc::default();
        let begin = Instant::now();
        let own = Arc::clone(&result);
        (Self { plan, seen: 0, sum: 0, batches: 0, begin, allocated: 0, result: own }, result)
    }

    /// One has come.
    #[inline]
    pub fn add<M: Message>(&mut self, message: M) -> Turn {
        self.seen += 1;
        self.sum += message.number();
        if self.seen < self.plan.batch { Turn::Wait } else { self.end_batch() }
    }

    fn end_batch(&mut self) -> Turn {
        assert_eq!(self.sum, sum_below(self.plan.batch), "messages were lost");
        (self.seen, self.sum) = (0, 0);
        self.batches += 1;
        let warm_up = self.plan.batches.div_ceil(10);
        if self.batches == warm_up {
            self.begin = Instant::now();
            self.allocated = counting::so_far().allocations;
        }
        if self.batches < warm_up + self.plan.batches {
            return Turn::Again;
        }
        let allocations = counting::so_far().allocations - self.allocated;
        *self.result.lock().expect("nobody panicked with it") = (self.begin.elapsed(), allocations);
        Turn::Over
    }
}

/// Writes down what [`Score`] found.
pub fn write(plan: Plan, result: &Mutex<(Duration, u64)>, measured: &mut Measured) {
    let (time, allocations) = *result.lock().expect("nobody panicked with it");
    let messages = (plan.batches * plan.batch) as f64;
    measured.value("per_message", "ns", time.as_nanos() as f64 / messages);
    measured.value("allocations", "1/msg", allocations as f64 / messages);
}

/// With the actors of `P`.
pub fn run<P: Local, M: Message>(plan: Plan, measured: &mut Measured) {
    let (mut score, result) = Score::new(plan);
    let mut stage = P::stage();
    let (tell, over) = oneshot::channel();
    let source: Arc<OnceLock<P::Address<Small>>> = Arc::default();
    let (home, mut tell) = (Arc::clone(&source), Some(tell));
    let sink = P::start_in::<M>(
        &mut stage,
        Box::new(move |message| {
            match score.add(message) {
                Turn::Wait => {}
                Turn::Again => P::send(home.get().expect("it is known before the first batch"), Small::of(0)),
                Turn::Over => _ = tell.take().map(|tell| tell.send(())),
            }
            ControlFlow::Continue(())
        }),
    );
    let ask = P::start_in::<Small>(
        &mut stage,
        Box::new(move |_| {
            (0..plan.batch).for_each(|number| P::send(&sink, M::of(number)));
            ControlFlow::Continue(())
        }),
    );
    P::send(&ask, Small::of(0));
    let _ = source.set(ask);
    P::run(&mut stage, over);
    write(plan, &result, measured);
}
