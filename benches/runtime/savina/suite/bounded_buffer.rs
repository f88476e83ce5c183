//! Producers, consumers, and a buffer between them that slows down the faster side.
//!
//! Original: 40 producers of 1,000 items each, 40 consumers, a buffer of 50. Counted: four messages for each item: the
//! request, the item from the producer, the item to the consumer, and the consumer's return. Checked: the buffer never
//! holds more than its capacity, and every item was consumed exactly once.
//!
//! The original computes about 2,500 logarithms for every item on each side, which would hide the cost of the messages;
//! here each side does 25 steps of a generator.

use super::super::{Actor, Address, Cx, World};
use super::work;
use crate::StudyMode;
use dragonfly_kit::random::Random;
use std::collections::VecDeque;

/// Steps of work for an item, on each side.
const STEPS: usize = 25;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let (producers, consumers, items, limit) =
        mode.pick((4, 3, 20, 6), (40, 40, 200, 50), (40, 40, 1_000, 50));
    let buffer = ItemBuffer {
        limit,
        items,
        held: VecDeque::new(),
        producers: Vec::new(),
        consumers: Vec::new(),
        idle_producers: VecDeque::new(),
        idle_consumers: (0..consumers).collect(),
        ended: 0,
        consumed: vec![false; producers * items],
        reports: 0,
    };
    let buffer = world.spawn(0, buffer);
    let produce = |index: usize| {
        let random = Random::new(index as u64);
        world.spawn(
            index,
            BufferProducer { index, buffer: buffer.clone(), next: index * items, left: items, random },
        )
    };
    let producers = (0..producers).map(produce).collect();
    let consume = |index: usize| {
        let random = Random::new(index as u64);
        world.spawn(index, Consumer { index, buffer: buffer.clone(), consumed: Vec::new(), random })
    };
    let consumers = (0..consumers).map(consume).collect();
    world.send(&buffer, BufferMessage::Open(producers, consumers));
}

struct ItemBuffer {
    limit: usize,
    /// Number of items of each producer.
    items: usize,
    held: VecDeque<usize>,
    producers: Vec<Address<BufferProducer>>,
    consumers: Vec<Address<Consumer>>,
    idle_producers: VecDeque<usize>,
    idle_consumers: VecDeque<usize>,
    /// Number of producers that have no more items.
    ended: usize,
    consumed: Vec<bool>,
    /// Number of consumers that have reported what they consumed.
    reports: usize,
}

enum BufferMessage {
    Open(Vec<Address<BufferProducer>>, Vec<Address<Consumer>>),
    Item { from: usize, item: usize },
    Exhausted,
    Idle { from: usize },
    Consumed(Vec<usize>),
}

impl Actor for ItemBuffer {
    type Message = BufferMessage;

    fn receive(&mut self, message: BufferMessage, cx: &mut Cx<Self>) {
        match message {
            BufferMessage::Open(producers, consumers) => {
                producers.iter().for_each(|producer| cx.send(producer, BufferProducerMessage::Produce));
                (self.producers, self.consumers) = (producers, consumers);
            }
            BufferMessage::Item { from, item } => {
                match self.idle_consumers.pop_front() {
                    Some(consumer) => cx.send(&self.consumers[consumer], ConsumerMessage::Item(item)),
                    None => self.held.push_back(item),
                }
                assert!(self.held.len() <= self.limit, "the buffer holds {}", self.held.len());
                // Every other producer may already be about to deliver an item.
                if self.held.len() + self.producers.len() > self.limit {
                    self.idle_producers.push_back(from);
                } else {
                    cx.send(&self.producers[from], BufferProducerMessage::Produce);
                }
            }
            BufferMessage::Idle { from } => {
                match self.held.pop_front() {
                    Some(item) => cx.send(&self.consumers[from], ConsumerMessage::Item(item)),
                    None => self.idle_consumers.push_back(from),
                }
                if let Some(producer) = self.idle_producers.pop_front() {
                    cx.send(&self.producers[producer], BufferProducerMessage::Produce);
                }
                self.end_if_empty(cx);
            }
            BufferMessage::Exhausted => {
                self.ended += 1;
                self.end_if_empty(cx);
            }
            BufferMessage::Consumed(items) => self.check(&items, cx),
        }
    }
}

impl ItemBuffer {
    fn end_if_empty(&self, cx: &mut Cx<Self>) {
        if self.ended == self.producers.len() && self.idle_consumers.len() == self.consumers.len() {
            self.consumers.iter().for_each(|consumer| cx.send(consumer, ConsumerMessage::End));
        }
    }

    fn check(&mut self, items: &[usize], cx: &mut Cx<Self>) {
        for item in items {
            assert!(!self.consumed[*item], "item {item} was consumed twice");
            self.consumed[*item] = true;
        }
        self.reports += 1;
        if self.reports == self.consumers.len() {
            assert!(self.consumed.iter().all(|consumed| *consumed), "every item was consumed");
            cx.finish(4 * (self.items * self.producers.len()) as u64, None);
            cx.stop();
        }
    }
}

struct BufferProducer {
    index: usize,
    buffer: Address<ItemBuffer>,
    next: usize,
    left: usize,
    random: Random,
}

enum BufferProducerMessage {
    Produce,
}

impl Actor for BufferProducer {
    type Message = BufferProducerMessage;

    fn receive(&mut self, BufferProducerMessage::Produce: BufferProducerMessage, cx: &mut Cx<Self>) {
        if self.left == 0 {
            cx.send(&self.buffer, BufferMessage::Exhausted);
            return cx.stop();
        }
        work(&mut self.random, STEPS);
        cx.send(&self.buffer, BufferMessage::Item { from: self.index, item: self.next });
        self.next += 1;
        self.left -= 1;
    }
}

struct Consumer {
    index: usize,
    buffer: Address<ItemBuffer>,
    consumed: Vec<usize>,
    random: Random,
}

enum ConsumerMessage {
    Item(usize),
    End,
}

impl Actor for Consumer {
    type Message = ConsumerMessage;

    fn receive(&mut self, message: ConsumerMessage, cx: &mut Cx<Self>) {
        match message {
            ConsumerMessage::Item(item) => {
                work(&mut self.random, STEPS);
                self.consumed.push(item);
                cx.send(&self.buffer, BufferMessage::Idle { from: self.index });
            }
            ConsumerMessage::End => {
                cx.send(&self.buffer, BufferMessage::Consumed(std::mem::take(&mut self.consumed)));
                cx.stop();
            }
        }
    }
}
