//! stakker within its thread: a call from one actor to another is a closure on its queue.

use super::chain::{self, Plan, Score, Turn};
use super::creation;
use crate::Measured;
use crate::runtime::peer::{Message, Small};
use ::stakker::{Actor, ActorOwn, CX, Stakker, actor, call, ret_nop};
use dragonfly_kit::counting;
use std::cell::Cell;
use std::rc::Rc;
use std::time::Instant;

struct Source<M: Message> {
    sink: Actor<Sink<M>>,
    plan: Plan,
}

impl<M: Message> Source<M> {
    fn init(_: CX![], sink: Actor<Sink<M>>, plan: Plan) -> Option<Self> {
        Some(Self { sink, plan })
    }

    fn send(&mut self, cx: CX![]) {
        for number in 0..self.plan.batch {
            let message = M::of(number);
            call!([self.sink, cx], receive(message));
        }
    }
}

struct Sink<M: Message> {
    score: Score,
    source: Actor<Source<M>>,
}

impl<M: Message> Sink<M> {
    fn init(_: CX![], score: Score, source: Actor<Source<M>>) -> Option<Self> {
        Some(Self { score, source })
    }

    fn receive(&mut self, cx: CX![], message: M) {
        match self.score.add(message) {
            Turn::Wait => {}
            Turn::Again => call!([self.source, cx], send()),
            Turn::Over => cx.stop(),
        }
    }
}

/// As [`chain::run`].
pub fn chain<M: Message>(plan: Plan, measured: &mut Measured) {
    let (score, result) = Score::new(plan);
    let mut stakker = Stakker::new(Instant::now());
    let core = &mut stakker;
    let source: ActorOwn<Source<M>> = ::stakker::actor_new!(core, Source<M>, ret_nop!());
    let sink: ActorOwn<Sink<M>> = ::stakker::actor_new!(core, Sink<M>, ret_nop!());
    call!([source], <Source<M>>::init(sink.clone(), plan));
    call!([sink], <Sink<M>>::init(score, source.clone()));
    call!([source], send());
    core.run(Instant::now(), false);
    chain::write(plan, &result, measured);
}

/// An actor that counts.
struct Idle {
    left: Rc<Cell<u64>>,
}

impl Idle {
    fn init(_: CX![], left: Rc<Cell<u64>>) -> Option<Self> {
        Some(Self { left })
    }

    fn receive(&mut self, _: CX![], _: Small) {
        self.left.set(self.left.get() - 1);
    }
}

/// As [`creation::run`].
pub fn creation(count: u64, measured: &mut Measured) {
    let mut stakker = Stakker::new(Instant::now());
    let left = Rc::new(Cell::new(count));
    let begin = Instant::now();
    let (bytes, (actors, made, used)) = counting::peak(|| {
        let core = &mut stakker;
        let actors: Vec<ActorOwn<Idle>> =
            (0..count).map(|_| actor!(core, Idle::init(Rc::clone(&left)), ret_nop!())).collect();
        core.run(Instant::now(), false);
        let made = begin.elapsed();
        let begin = Instant::now();
        for actor in &actors {
            let message = Small::of(0);
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
