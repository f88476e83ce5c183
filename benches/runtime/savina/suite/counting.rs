//! One actor sends, the other one counts: messages in one direction at full speed.
//!
//! Original: 1,000,000 messages. Counted: each of them. Checked: the counter has counted all of them.

use super::super::{Actor, Address, Cx, World};
use crate::StudyMode;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let messages = mode.pick(100, 250_000, 1_000_000);
    let counter = world.spawn(1, MessageCounter { count: 0 });
    let producer = world.spawn(0, CountingProducer { counter, messages });
    world.send(&producer, CountingProducerMessage::Begin);
}

struct CountingProducer {
    counter: Address<MessageCounter>,
    messages: u64,
}

enum CountingProducerMessage {
    Begin,
    Counted(u64),
}

impl Actor for CountingProducer {
    type Message = CountingProducerMessage;

    fn receive(&mut self, message: CountingProducerMessage, cx: &mut Cx<Self>) {
        match message {
            CountingProducerMessage::Begin => {
                for _ in 0..self.messages {
                    cx.send(&self.counter, CounterMessage::Increment);
                }
                let me = cx.me();
                cx.send(&self.counter, CounterMessage::Tell(me));
            }
            CountingProducerMessage::Counted(count) => {
                assert_eq!(count, self.messages, "every message was counted");
                cx.finish(count, None);
                cx.stop();
            }
        }
    }
}

struct MessageCounter {
    count: u64,
}

enum CounterMessage {
    Increment,
    Tell(Address<CountingProducer>),
}

impl Actor for MessageCounter {
    type Message = CounterMessage;

    fn receive(&mut self, message: CounterMessage, cx: &mut Cx<Self>) {
        match message {
            CounterMessage::Increment => self.count += 1,
            CounterMessage::Tell(producer) => {
                cx.send(&producer, CountingProducerMessage::Counted(self.count));
                cx.stop();
            }
        }
    }
}
