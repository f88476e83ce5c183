//! Two actors and one message at a time: the cost of a switch to the other actor.
//!
//! Original: 40,000 rounds. Counted: every ping and pong. Checked: both actors have counted every round.

use super::super::{Actor, Address, Cx, World};
use crate::StudyMode;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let rounds = mode.pick(100, 10_000, 40_000);
    let pong = world.spawn(1, Pong { ping: None, pings: 0 });
    let ping = world.spawn(0, Ping { pong: pong.clone(), pongs: 0, rounds });
    world.send(&pong, PongMessage::Partner(ping.clone()));
    world.send(&ping, PingMessage::Begin);
}

struct Ping {
    pong: Address<Pong>,
    pongs: u64,
    rounds: u64,
}

enum PingMessage {
    Begin,
    Pong,
}

impl Actor for Ping {
    type Message = PingMessage;

    fn receive(&mut self, message: PingMessage, cx: &mut Cx<Self>) {
        if let PingMessage::Pong = message {
            self.pongs += 1;
        }
        if self.pongs < self.rounds {
            cx.send(&self.pong, PongMessage::Ping);
        } else {
            cx.send(&self.pong, PongMessage::End { pongs: self.pongs });
            cx.stop();
        }
    }
}

struct Pong {
    ping: Option<Address<Ping>>,
    pings: u64,
}

enum PongMessage {
    Partner(Address<Ping>),
    Ping,
    End { pongs: u64 },
}

impl Actor for Pong {
    type Message = PongMessage;

    fn receive(&mut self, message: PongMessage, cx: &mut Cx<Self>) {
        match message {
            PongMessage::Partner(ping) => self.ping = Some(ping),
            PongMessage::Ping => {
                self.pings += 1;
                let ping = self.ping.as_ref().expect("it was told before the first ping");
                cx.send(ping, PingMessage::Pong);
            }
            PongMessage::End { pongs } => {
                assert_eq!(self.pings, pongs, "as many pings came as pongs");
                cx.finish(self.pings + pongs, None);
                cx.stop();
            }
        }
    }
}
