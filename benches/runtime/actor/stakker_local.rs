//! stakker within its thread: a call from one actor to another is a closure in its queue.

use super::chain::{self, ChainPlan, ChainTurn, Score};
use super::creation;
use crate::RunValues;
use crate::runtime::peer::{Message, SmallMessage};
use ::stakker::{Actor, ActorOwn, CX, Stakker, actor, call, ret_nop};
use dragonfly_kit::counting;
use std::cell::Cell;
use std::rc::Rc;
use std::time::Instant;

struct BatchSource<M: Message> {
    sink: Actor<BatchSink<M>>,
    plan: ChainPlan,
}

impl<M: Message> BatchSource<M> {
    fn init(_: CX![], sink: Actor<BatchSink<M>>, plan: ChainPlan) -> Option<Self> {
        Some(Self { sink, plan })
    }

    fn send(&mut self, cx: CX![]) {
        for number in 0..self.plan.batch {
            let message = M::of(number);
            call!([self.sink, cx], receive(message));
        }
    }
}

struct BatchSink<M: Message> {
    score: Score,
    source: Actor<BatchSource<M>>,
}

impl<M: Message> BatchSink<M> {
    fn init(_: CX![], score: Score, source: Actor<BatchSource<M>>) -> Option<Self> {
        Some(Self { score, source })
    }

    fn receive(&mut self, cx: CX![], message: M) {
        match self.score.add(message) {
            ChainTurn::Wait => {}
            ChainTurn::Again => call!([self.source, cx], send()),
            ChainTurn::Over => cx.stop(),
        }
    }
}

/// Like [`chain::run`].
pub fn chain<M: Message>(plan: ChainPlan, measured: &mut RunValues) {
    let (score, result) = Score::new(plan);
    let mut stakker = Stakker::new(Instant::now());
    let core = &mut stakker;
    let source: ActorOwn<BatchSource<M>> = ::stakker::actor_new!(core, BatchSource<M>, ret_nop!());
    let sink: ActorOwn<BatchSink<M>> = ::stakker::actor_new!(core, BatchSink<M>, ret_nop!());
    call!([source], <BatchSource<M>>::init(sink.clone(), plan));
    call!([sink], <BatchSink<M>>::init(score, source.clone()));
    call!([source], send());
    core.run(Instant::now(), false);
    chain::write(plan, &result, measured);
}

/// An actor that counts its messages.
struct CountingActor {
    left: Rc<Cell<u64>>,
}

impl CountingActor {
    fn init(_: CX![], left: Rc<Cell<u64>>) -> Option<Self> {
        Some(Self { left })
    }

    fn receive(&mut self, _: CX![], _: SmallMessage) {
        self.left.set(self.left.get() - 1);
    }
}

/// Like [`creation::run`].
pub fn creation(count: u64, measured: &mut RunValues) {
    let mut stakker = Stakker::new(Instant::now());
    let left = Rc::new(Cell::new(count));
    let begin = Instant::now();
    let (bytes, (actors, made, used)) = counting::peak(|| {
        let core = &mut stakker;
        let actors: Vec<ActorOwn<CountingActor>> =
            (0..count).map(|_| actor!(core, CountingActor::init(Rc::clone(&left)), ret_nop!())).collect();
        core.run(Instant::now(), false);
        let made = begin.elapsed();
        let begin = Instant::now();
        for actor in &actors {
            let message = SmallMessage::of(0);
            call!([actor], receive(message));
        }
        core.run(Instant::now(), false);
        (actors, made, begin.elapsed())
    });
    assert_eq!(left.get(), 0, "messages were lost");
    let begin = Instant::now();
    drop(actors);
    stakker.run(Instant::now(), false);
    drop(stakker);
    creation::write(count, made, used, begin.elapsed(), bytes, measured);
}
