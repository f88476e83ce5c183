//! All actors write to all: each actor pings a random other one, and the next one when the pong arrives.
//!
//! Original: 120 actors, 20,000 pings each. Counted: pings and pongs. Checked: a pong comes from the actor that was
//! pinged, and every ping was answered.

use super::super::{Actor, Address, Cx, World};
use crate::StudyMode;
use dragonfly_kit::random::Random;
use std::sync::Arc;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let (workers, pings) = mode.pick((6, 50), (120, 1_000), (120, 4_000));
    let sink =
        world.spawn(0, BigSink { workers: BigWorkers::default(), pings, done: 0, answered: 0, ended: 0 });
    let create = |index: usize| {
        let random = Random::new(index as u64);
        let sink = sink.clone();
        let worker =
            BigWorker { index, sink, random, workers: None, left: pings, expected: usize::MAX, answered: 0 };
        world.spawn(index, worker)
    };
    let workers: Vec<Address<BigWorker>> = (0..workers).map(create).collect();
    let workers: BigWorkers = workers.into();
    for worker in workers.iter() {
        world.send(worker, BigMessage::Know(Arc::clone(&workers)));
    }
    world.send(&sink, SinkMessage::Begin(workers));
}

type BigWorkers = Arc<[Address<BigWorker>]>;

struct BigWorker {
    index: usize,
    sink: Address<BigSink>,
    random: Random,
    workers: Option<BigWorkers>,
    left: u64,
    /// The actor whose pong is expected.
    expected: usize,
    answered: u64,
}

enum BigMessage {
    Know(BigWorkers),
    Begin,
    Ping { from: usize },
    Pong { from: usize },
    End,
}

impl Actor for BigWorker {
    type Message = BigMessage;

    fn receive(&mut self, message: BigMessage, cx: &mut Cx<Self>) {
        match message {
            BigMessage::Know(workers) => self.workers = Some(workers),
            BigMessage::Begin => self.ping(cx),
            BigMessage::Ping { from } => {
                self.answered += 1;
                let workers = self.workers.as_ref().expect("all have the list before one begins");
                cx.send(&workers[from], BigMessage::Pong { from: self.index });
            }
            BigMessage::Pong { from } => {
                assert_eq!(from, self.expected, "who was pinged answers");
                self.ping(cx);
            }
            BigMessage::End => {
                cx.send(&self.sink, SinkMessage::Ended { answered: self.answered });
                cx.stop();
            }
        }
    }
}

impl BigWorker {
    /// Pings the next actor, or reports the end.
    fn ping(&mut self, cx: &mut Cx<Self>) {
        if self.left == 0 {
            return cx.send(&self.sink, SinkMessage::Done);
        }
        self.left -= 1;
        let workers = self.workers.as_ref().expect("all have the list before one begins");
        self.expected = self.random.below(workers.len());
        cx.send(&workers[self.expected], BigMessage::Ping { from: self.index });
    }
}

struct BigSink {
    workers: BigWorkers,
    pings: u64,
    done: usize,
    answered: u64,
    ended: usize,
}

enum SinkMessage {
    Begin(BigWorkers),
    Done,
    Ended { answered: u64 },
}

impl Actor for BigSink {
    type Message = SinkMessage;

    fn receive(&mut self, message: SinkMessage, cx: &mut Cx<Self>) {
        match message {
            SinkMessage::Begin(workers) => {
                workers.iter().for_each(|worker| cx.send(worker, BigMessage::Begin));
                self.workers = workers;
            }
            SinkMessage::Done => {
                self.done += 1;
                if self.done == self.workers.len() {
                    self.workers.iter().for_each(|worker| cx.send(worker, BigMessage::End));
                }
            }
            SinkMessage::Ended { answered } => {
                self.answered += answered;
                self.ended += 1;
                if self.ended == self.workers.len() {
                    let pings = self.pings * self.ended as u64;
                    assert_eq!(self.answered, pings, "every ping was answered");
                    cx.finish(2 * pings, None);
                    cx.stop();
                }
            }
        }
    }
}
