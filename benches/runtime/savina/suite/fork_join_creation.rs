//! Short-lived actors: each is created, computes a little with its only message, and ends.
//!
//! Original: 40,000 actors. Counted: actors, so the metric is the cost of a creation, a message there and one back, and
//! an end. Checked: every actor has answered with the message that it was sent.
//!
//! The original creates the actors from its main thread and waits until all have ended; here an actor creates them, and
//! each actor reports to it before it ends.

use super::super::{Actor, Address, Cx, World};
use super::compute;
use crate::StudyMode;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let actors = mode.pick(40, 10_000, 40_000);
    let parent = world.spawn(0, CreatingParent { answered: vec![false; actors], missing: actors });
    world.send(&parent, ParentMessage::Begin);
}

struct CreatingParent {
    answered: Vec<bool>,
    missing: usize,
}

enum ParentMessage {
    Begin,
    Done(usize),
}

impl Actor for CreatingParent {
    type Message = ParentMessage;

    fn receive(&mut self, message: ParentMessage, cx: &mut Cx<Self>) {
        match message {
            ParentMessage::Begin => {
                for number in 0..self.answered.len() {
                    let parent = cx.me();
                    let child = cx.spawn(number, Child { parent });
                    cx.send(&child, number);
                }
            }
            ParentMessage::Done(number) => {
                assert!(!self.answered[number], "actor {number} answers once");
                self.answered[number] = true;
                self.missing -= 1;
                if self.missing == 0 {
                    cx.finish(self.answered.len() as u64, None);
                    cx.stop();
                }
            }
        }
    }
}

struct Child {
    parent: Address<CreatingParent>,
}

impl Actor for Child {
    type Message = usize;

    fn receive(&mut self, number: usize, cx: &mut Cx<Self>) {
        compute();
        cx.send(&self.parent, ParentMessage::Done(number));
        cx.stop();
    }
}
