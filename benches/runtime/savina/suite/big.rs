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
    let sink = world.spawn(0, Sink { workers: Workers::default(), pings, done: 0, answered: 0, ended: 0 });
    let create = |index: usize| {
        let random = Random::new(index as u64);
        let sink = sink.clone();
        let worker =
            Worker { index, sink, random, workers: None, left: pings, expected: usize::MAX, answered: 0 };
        world.spawn(index, worker)
    };
    let workers: Vec<Address<Worker>> = (0..workers).map(create).collect();
    let workers: Workers = workers.into();
    for worker in workers.iter() {
        world.send(worker, WorkerMessage::Know(Arc::clone(&workers)));
    }
    world.send(&sink, SinkMessage::Begin(workers));
}

type Workers = Arc<[Address<Worker>]>;

struct Worker {
    index: usize,
    sink: Address<Sink>,
    random: Random,
    workers: Option<Workers>,
    left: u64,
    /// The actor whose pong is expected.
    expected: usize,
    answered: u64,
}

enum WorkerMessage {
    Know(Workers),
    Begin,
    Ping { from: usize },
    Pong { from: usize },
    End,
}

impl Actor for Worker {
    type Message = WorkerMessage;

    fn receive(&mut self, message: WorkerMessage, cx: &mut Cx<Self>) {
        match message {
            WorkerMessage::Know(workers) => self.workers = Some(workers),
            WorkerMessage::Begin => self.ping(cx),
            WorkerMessage::Ping { from } => {
                self.answered += 1;
                let workers = self.workers.as_ref().expect("all have the list before one begins");
                cx.send(&workers[from], WorkerMessage::Pong { from: self.index });
            }
            WorkerMessage::Pong { from } => {
                assert_eq!(from, self.expected, "who was pinged answers");
                self.ping(cx);
            }
            WorkerMessage::End => {
                cx.send(&self.sink, SinkMessage::Ended { answered: self.answered });
                cx.stop();
            }
        }
    }
}

impl Worker {
    /// Pings the next actor, or reports the end.
    fn ping(&mut self, cx: &mut Cx<Self>) {
        if self.left == 0 {
            return cx.send(&self.sink, SinkMessage::Done);
        }
        self.left -= 1;
        let workers = self.workers.as_ref().expect("all have the list before one begins");
        self.expected = self.random.below(workers.len());
        cx.send(&workers[self.expected], WorkerMessage::Ping { from: self.index });
    }
}

struct Sink {
    workers: Workers,
    pings: u64,
    done: usize,
    answered: u64,
    ended: usize,
}

enum SinkMessage {
    Begin(Workers),
    Done,
    Ended { answered: u64 },
}

impl Actor for Sink {
    type Message = SinkMessage;

    fn receive(&mut self, message: SinkMessage, cx: &mut Cx<Self>) {
        match message {
            SinkMessage::Begin(workers) => {
                workers.iter().for_each(|worker| cx.send(worker, WorkerMessage::Begin));
                self.workers = workers;
            }
            SinkMessage::Done => {
                self.done += 1;
                if self.done == self.workers.len() {
                    self.workers.iter().for_each(|worker| cx.send(worker, WorkerMessage::End));
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
