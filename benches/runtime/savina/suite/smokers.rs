//! An arbiter allows one of many smokers to smoke at a time, at random.
//!
//! Original: 200 smokers, 1,000 rounds. Counted: two messages for each round, there and back. Checked: no two smokers
//! smoke at once, with a mark that stays until the arbiter receives the end; the number of rounds is correct.
//!
//! The original's smoker answers before it smokes, so that the next one can smoke at the same time; here it answers
//! afterwards.

use super::super::{Actor, Address, Cx, World};
use super::work;
use crate::StudyMode;
use dragonfly_kit::random::Random;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Largest number of steps that smoking takes.
const STEPS: usize = 1_000;

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let (smokers, rounds) = mode.pick((10, 50), (200, 1_000), (200, 1_000));
    let smoke = Arc::new(AtomicBool::new(false));
    let arbiter = Arbiter {
        smoke: Arc::clone(&smoke),
        smokers: Vec::new(),
        random: Random::new(1),
        chosen: 0,
        rounds,
        left: rounds,
        smoked: 0,
        ended: 0,
    };
    let arbiter = world.spawn(0, arbiter);
    let create = |index: usize| {
        let (arbiter, smoke, random) = (arbiter.clone(), Arc::clone(&smoke), Random::new(index as u64));
        world.spawn(index, Smoker { index, arbiter, smoke, random, smoked: 0 })
    };
    let smokers = (0..smokers).map(create).collect();
    world.send(&arbiter, ArbiterMessage::Open(smokers));
}

struct Arbiter {
    /// Whether a smoker smokes.
    smoke: Arc<AtomicBool>,
    smokers: Vec<Address<Smoker>>,
    random: Random,
    chosen: usize,
    rounds: u64,
    left: u64,
    smoked: u64,
    ended: usize,
}

enum ArbiterMessage {
    Open(Vec<Address<Smoker>>),
    Smoked { from: usize },
    Ended { smoked: u64 },
}

impl Actor for Arbiter {
    type Message = ArbiterMessage;

    fn receive(&mut self, message: ArbiterMessage, cx: &mut Cx<Self>) {
        match message {
            ArbiterMessage::Open(smokers) => {
                self.smokers = smokers;
                self.choose(cx);
            }
            ArbiterMessage::Smoked { from } => {
                assert_eq!(from, self.chosen, "who was chosen smokes");
                assert!(self.smoke.swap(false, Ordering::SeqCst), "a smoker has smoked");
                self.choose(cx);
            }
            ArbiterMessage::Ended { smoked } => {
                self.smoked += smoked;
                self.ended += 1;
                if self.ended == self.smokers.len() {
                    assert_eq!(self.smoked, self.rounds, "every round was smoked");
                    cx.finish(2 * self.rounds, None);
                    cx.stop();
                }
            }
        }
    }
}

impl Arbiter {
    fn choose(&mut self, cx: &mut Cx<Self>) {
        if self.left == 0 {
            return self.smokers.iter().for_each(|smoker| cx.send(smoker, SmokerMessage::End));
        }
        self.left -= 1;
        self.chosen = self.random.below(self.smokers.len());
        let steps = self.random.below(STEPS);
        cx.send(&self.smokers[self.chosen], SmokerMessage::Smoke { steps });
    }
}

struct Smoker {
    index: usize,
    arbiter: Address<Arbiter>,
    smoke: Arc<AtomicBool>,
    random: Random,
    smoked: u64,
}

enum SmokerMessage {
    Smoke { steps: usize },
    End,
}

impl Actor for Smoker {
    type Message = SmokerMessage;

    fn receive(&mut self, message: SmokerMessage, cx: &mut Cx<Self>) {
        match message {
            SmokerMessage::Smoke { steps } => {
                assert!(!self.smoke.swap(true, Ordering::SeqCst), "two smoke at once");
                work(&mut self.random, steps);
                self.smoked += 1;
                cx.send(&self.arbiter, ArbiterMessage::Smoked { from: self.index });
            }
            SmokerMessage::End => {
                cx.send(&self.arbiter, ArbiterMessage::Ended { smoked: self.smoked });
                cx.stop();
            }
        }
    }
}
