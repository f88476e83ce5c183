//! One actor sends messages to 60 actors in turn, each of which computes a little.
//!
//! Original: 60 actors, 10,000 messages each. Counted: those messages. Checked: each actor received all of its
//! messages, in the order of sending.
//!
//! The original sends from its main thread; here an actor sends.

use super::super::{Actor, Address, Cx, World};
use super::compute;
use crate::StudyMode;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let (workers, messages) = mode.pick((6, 20), (60, 2_500), (60, 10_000));
    let workers =
        (0..workers).map(|place| world.spawn(place, ForkJoinWorker { next: 0, messages })).collect();
    let source = world.spawn(0, ForkJoinSource { workers, messages, done: 0 });
    world.send(&source, SourceMessage::Begin);
}

struct ForkJoinSource {
    workers: Vec<Address<ForkJoinWorker>>,
    messages: u64,
    done: usize,
}

enum SourceMessage {
    Begin,
    Done,
}

impl Actor for ForkJoinSource {
    type Message = SourceMessage;

    fn receive(&mut self, message: SourceMessage, cx: &mut Cx<Self>) {
        match message {
            SourceMessage::Begin => {
                for number in 0..self.messages {
                    for worker in &self.workers {
                        cx.send(worker, ForkJoinMessage::Work(number));
                    }
                }
                for worker in &self.workers {
                    let me = cx.me();
                    cx.send(worker, ForkJoinMessage::End(me));
                }
            }
            SourceMessage::Done => {
                self.done += 1;
                if self.done == self.workers.len() {
                    cx.finish(self.messages * self.done as u64, None);
                    cx.stop();
                }
            }
        }
    }
}

struct ForkJoinWorker {
    next: u64,
    messages: u64,
}

enum ForkJoinMessage {
    Work(u64),
    End(Address<ForkJoinSource>),
}

impl Actor for ForkJoinWorker {
    type Message = ForkJoinMessage;

    fn receive(&mut self, message: ForkJoinMessage, cx: &mut Cx<Self>) {
        match message {
            ForkJoinMessage::Work(number) => {
                assert_eq!(number, self.next, "messages come in the order of sending");
                self.next += 1;
                compute();
            }
            ForkJoinMessage::End(source) => {
                assert_eq!(self.next, self.messages, "every message came");
                cx.send(&source, SourceMessage::Done);
                cx.stop();
            }
        }
    }
}
