//! A token goes round: one message at a time, but among many actors.
//!
//! Original: 100 actors, 100,000 hops. Counted: hops, those of the word that all is over included. Checked: the token
//! comes in the order of the ring, and that word reaches everybody once.
//!
//! Neighbours share a thread where there are several, as a program would have it; the token changes it once for each
//! of them and round.

use super::super::{Actor, Address, Cx, World};
use crate::Mode;

pub(super) fn start(world: &mut World, mode: Mode) {
    let (actors, hops) = mode.pick((10, 105), (100, 20_000), (100, 100_000));
    // As many places as any system has threads here, each with its stretch of the ring.
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
                // The others are told; nobody sends to this one any more.
                let left = if left == 0 { self.actors - 1 } else { left - 1 };
                cx.send(next, NodeMessage::End { left });
            }
        }
        if let NodeMessage::Token { left: 0 } | NodeMessage::End { .. } = message {
            cx.stop();
        }
    }
}
