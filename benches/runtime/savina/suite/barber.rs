//! A barber, a waiting room, and customers who come back at once when it is full.
//!
//! Original: 5,000 haircuts, a waiting room for 1,000. Counted: seven messages for each haircut: the customer's
//! creation, its way through the waiting room to the barber, the barber's call for the next customer, and the
//! customer's departure. The number of times that a customer found the room full depends on the order of delivery and
//! is a metric of its own (`retries`). Checked: the room never holds more than its capacity, and every customer got one
//! haircut.
//!
//! The original's factory creates all customers in one message, with busy waiting in between; here it creates one for
//! each message, so that it does not block the other actors of its thread. Work is steps of a generator, 500 on average
//! as in the original.

use super::super::{Actor, Address, Cx, World};
use super::work;
use crate::StudyMode;
use dragonfly_kit::random::Random;
use std::collections::VecDeque;

/// Largest number of steps that a haircut, or the creation of a customer, takes.
const STEPS: usize = 1_000;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let (haircuts, seats) = mode.pick((50, 10), (1_000, 200), (2_500, 500));
    let barber = world.spawn(0, Barber { room: None, random: Random::new(1), haircuts: 0 });
    let room = WaitingRoom {
        barber: barber.clone(),
        waiting: VecDeque::with_capacity(seats),
        seats,
        asleep: true,
        refused: 0,
    };
    let room = world.spawn(0, room);
    world.send(&barber, BarberMessage::Hired(room.clone()));
    let factory = CustomerFactory { room, random: Random::new(2), haircuts, made: 0, left: haircuts };
    let factory = world.spawn(1, factory);
    world.send(&factory, FactoryMessage::Make);
}

struct CustomerFactory {
    room: Address<WaitingRoom>,
    random: Random,
    haircuts: usize,
    made: usize,
    left: usize,
}

enum FactoryMessage {
    Make,
    /// Sent back to a customer who found the room full.
    Returned(Address<Customer>),
    Done,
}

impl Actor for CustomerFactory {
    type Message = FactoryMessage;

    fn receive(&mut self, message: FactoryMessage, cx: &mut Cx<Self>) {
        match message {
            FactoryMessage::Make => {
                let steps = self.random.below(STEPS);
                work(&mut self.random, steps);
                let factory = cx.me();
                let customer = cx.spawn(self.made, Customer { factory, state: CustomerState::Outside });
                cx.send(&self.room, RoomMessage::Enter(customer));
                self.made += 1;
                if self.made < self.haircuts {
                    let me = cx.me();
                    cx.send(&me, FactoryMessage::Make);
                }
            }
            FactoryMessage::Returned(customer) => cx.send(&self.room, RoomMessage::Enter(customer)),
            FactoryMessage::Done => {
                self.left -= 1;
                if self.left == 0 {
                    cx.send(&self.room, RoomMessage::Close { haircuts: self.haircuts });
                    cx.stop();
                }
            }
        }
    }
}

struct WaitingRoom {
    barber: Address<Barber>,
    waiting: VecDeque<Address<Customer>>,
    seats: usize,
    asleep: bool,
    refused: u64,
}

enum RoomMessage {
    Enter(Address<Customer>),
    /// Sent by the barber when it is free.
    Next,
    Close {
        haircuts: usize,
    },
}

impl Actor for WaitingRoom {
    type Message = RoomMessage;

    fn receive(&mut self, message: RoomMessage, cx: &mut Cx<Self>) {
        match message {
            RoomMessage::Enter(customer) if self.waiting.len() == self.seats => {
                self.refused += 1;
                cx.send(&customer, CustomerMessage::Full);
            }
            RoomMessage::Enter(customer) => {
                if !self.asleep {
                    cx.send(&customer, CustomerMessage::Wait);
                }
                self.waiting.push_back(customer);
                assert!(self.waiting.len() <= self.seats, "more wait than there are seats");
                if self.asleep {
                    self.asleep = false;
                    let me = cx.me();
                    cx.send(&me, RoomMessage::Next);
                }
            }
            RoomMessage::Next => match self.waiting.pop_front() {
                Some(customer) => cx.send(&self.barber, BarberMessage::Enter(customer)),
                None => self.asleep = true,
            },
            RoomMessage::Close { haircuts } => {
                assert!(self.waiting.is_empty(), "a customer still waits");
                cx.send(&self.barber, BarberMessage::Close { haircuts, refused: self.refused });
                cx.stop();
            }
        }
    }
}

struct Barber {
    room: Option<Address<WaitingRoom>>,
    random: Random,
    haircuts: usize,
}

enum BarberMessage {
    Hired(Address<WaitingRoom>),
    Enter(Address<Customer>),
    Close { haircuts: usize, refused: u64 },
}

impl Actor for Barber {
    type Message = BarberMessage;

    fn receive(&mut self, message: BarberMessage, cx: &mut Cx<Self>) {
        match message {
            BarberMessage::Hired(room) => self.room = Some(room),
            BarberMessage::Enter(customer) => {
                cx.send(&customer, CustomerMessage::Start);
                let steps = self.random.below(STEPS);
                work(&mut self.random, steps);
                self.haircuts += 1;
                // First to the room, which may close as soon as the last customer has left.
                let room = self.room.as_ref().expect("the barber knows the room before a customer enters");
                cx.send(room, RoomMessage::Next);
                cx.send(&customer, CustomerMessage::Done);
            }
            BarberMessage::Close { haircuts, refused } => {
                assert_eq!(self.haircuts, haircuts, "everybody got a haircut");
                cx.finish(7 * haircuts as u64, Some(refused));
                cx.stop();
            }
        }
    }
}

struct Customer {
    factory: Address<CustomerFactory>,
    state: CustomerState,
}

#[derive(Debug, PartialEq)]
enum CustomerState {
    Outside,
    Waiting,
    Chair,
}

enum CustomerMessage {
    Full,
    Wait,
    Start,
    Done,
}

impl Actor for Customer {
    type Message = CustomerMessage;

    fn receive(&mut self, message: CustomerMessage, cx: &mut Cx<Self>) {
        match message {
            CustomerMessage::Full => {
                assert_eq!(self.state, CustomerState::Outside, "who is in is not turned away");
                let me = cx.me();
                cx.send(&self.factory, FactoryMessage::Returned(me));
            }
            CustomerMessage::Wait => {
                assert_eq!(self.state, CustomerState::Outside, "a seat is given once");
                self.state = CustomerState::Waiting;
            }
            CustomerMessage::Start => {
                assert_ne!(self.state, CustomerState::Chair, "a haircut begins once");
                self.state = CustomerState::Chair;
            }
            CustomerMessage::Done => {
                assert_eq!(self.state, CustomerState::Chair, "a haircut ends that has begun");
                cx.send(&self.factory, FactoryMessage::Done);
                cx.stop();
            }
        }
    }
}
