//! One actor sends, the other one counts: messages in one direction at full speed.
//!
//! Original: 1,000,000 messages. Counted: each of them. Checked: the counter has counted all of them.

use super::super::{Actor, Address, Cx, World};
use crate::StudyMode;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let messages = mode.pick(100, 250_000, 1_000_000);
    let counter = world.spawn(1, Counter { count: 0 });
    let producer = world.spawn(0, Producer { counter, messages });
    world.send(&producer, ProducerMessage::Begin);
}

struct Producer {
    counter: Address<Counter>,
    messages: u64,
}

enum ProducerMessage {
    Begin,
    Counted(u64),
}

impl Actor for Producer {
    type Message = ProducerMessage;

    fn receive(&mut self, message: ProducerMessage, cx: &mut Cx<Self>) {
        match message {
            ProducerMessage::Begin => {
                for _ in 0..self.messages {
                    cx.send(&self.counter, CounterMessage::Increment);
                }
                let me = cx.me();
                cx.send(&self.counter, CounterMessage::Tell(me));
            }
            ProducerMessage::Counted(count) => {
                assert_eq!(count, self.messages, "every message was counted");
                cx.finish(count, None);
                cx.stop();
            }
        }
    }
}

struct Counter {
    count: u64,
}

enum CounterMessage {
    Increment,
    Tell(Address<Producer>),
}

impl Actor for Counter {
    type Message = CounterMessage;

    fn receive(&mut self, message: CounterMessage, cx: &mut Cx<Self>) {
        match message {
            CounterMessage::Increment => self.count += 1,
            CounterMessage::Tell(producer) => {
                cx.send(&producer, ProducerMessage::Counted(self.count));
                cx.stop();
            }
        }
    }
}
