//! A token goes around a ring: one message at a time, but among many actors.
//!
//! Original: 100 actors, 100,000 hops. Counted: hops, including those of the final message. Checked: the token arrives
//! in the order of the ring, and the final message reaches every actor once.
//!
//! Neighbors share a thread where there are several threads, as in a real program; in each round, the token enters
//! each thread once.

use super::super::{Actor, Address, Cx, World};
use crate::StudyMode;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let (actors, hops) = mode.pick((10, 105), (100, 20_000), (100, 100_000));
    // Two placements, because a system has at most two threads here. Each gets a contiguous part of the ring.
    let place = |index: usize| index * 2 / actors;
    let nodes: Vec<Address<Node>> = (0..actors)
        .map(|index| world.spawn(place(index), Node { index, actors, hops, next: None }))
        .collect();
    for (index, node) in nodes.iter().enumerate() {
        world.send(node, NodeMessage::Next(nodes[(index + 1) % actors].clone()));
    }
    world.send(&nodes[0], NodeMessage::Token { left: hops });
}

struct Node {
    index: usize,
    actors: usize,
    hops: usize,
    next: Option<Address<Node>>,
}

enum NodeMessage {
    Next(Address<Node>),
    Token { left: usize },
    End { left: usize },
}

impl Actor for Node {
    type Message = NodeMessage;

    fn receive(&mut self, message: NodeMessage, cx: &mut Cx<Self>) {
        let (hops, left) = match message {
            NodeMessage::Next(next) => return self.next = Some(next),
            NodeMessage::Token { left } => (self.hops - left, left),
            NodeMessage::End { left } => (self.hops + self.actors - left, left),
        };
        assert_eq!(hops % self.actors, self.index, "it comes in turn");
        let next = self.next.as_ref().expect("all are told before the token leaves");
        match message {
            NodeMessage::Token { left: 1.. } => cx.send(next, NodeMessage::Token { left: left - 1 }),
            NodeMessage::End { left: 1 } => cx.finish(hops as u64, None),
            _ => {
                // The end goes around the ring once; `left` is the number of actors that it still has to reach.
                let left = if left == 0 { self.actors - 1 } else { left - 1 };
                cx.send(next, NodeMessage::End { left });
            }
        }
        if let NodeMessage::Token { left: 0 } | NodeMessage::End { .. } = message {
            cx.stop();
        }
    }
}
