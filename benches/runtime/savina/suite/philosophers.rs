//! Philosophers ask an arbitrator for their two forks, and ask again at once when they are refused.
//!
//! Original: 20 philosophers, 10,000 meals each. Counted: three messages for each meal: the request, the permission and
//! the return. The number of refused requests depends on the order of delivery and is a metric of its own (`retries`).
//! Checked: no philosopher eats with a fork that another one has, with marks on the forks that the arbitrator does not
//! use; every philosopher had all of its meals.

use super::super::{Actor, Address, Cx, World};
use crate::StudyMode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

pub(super) fn start(world: &mut World, mode: StudyMode) {
    let (philosophers, meals) = mode.pick((5, 20), (20, 1_000), (20, 10_000));
    let table = Arc::new(ForkMarks { held: (0..philosophers).map(|_| AtomicBool::new(false)).collect() });
    let arbitrator = Arbitrator {
        table: Arc::clone(&table),
        taken: vec![false; philosophers],
        philosophers: Vec::new(),
        meals,
        eaten: 0,
        refused: 0,
        gone: 0,
    };
    let arbitrator = world.spawn(0, arbitrator);
    let create = |index: usize| {
        let (arbitrator, table) = (arbitrator.clone(), Arc::clone(&table));
        world.spawn(index, Philosopher { index, arbitrator, table, left: meals })
    };
    let philosophers = (0..philosophers).map(create).collect();
    world.send(&arbitrator, ArbitratorMessage::Open(philosophers));
}

/// Marks on the forks, set by the philosophers that eat with them.
struct ForkMarks {
    held: Vec<AtomicBool>,
}

impl ForkMarks {
    fn forks(&self, philosopher: usize) -> [&AtomicBool; 2] {
        [&self.held[philosopher], &self.held[(philosopher + 1) % self.held.len()]]
    }

    /// Marks both forks of a philosopher as used.
    fn take(&self, philosopher: usize) {
        for fork in self.forks(philosopher) {
            assert!(!fork.swap(true, Ordering::SeqCst), "{philosopher} takes a fork that another holds");
        }
    }

    /// Removes both marks.
    fn release_forks(&self, philosopher: usize) {
        for fork in self.forks(philosopher) {
            assert!(fork.swap(false, Ordering::SeqCst), "{philosopher} gives back a fork that no one holds");
        }
    }
}

struct Arbitrator {
    table: Arc<ForkMarks>,
    taken: Vec<bool>,
    philosophers: Vec<Address<Philosopher>>,
    /// Number of meals of each philosopher.
    meals: u64,
    eaten: u64,
    refused: u64,
    gone: usize,
}

enum ArbitratorMessage {
    Open(Vec<Address<Philosopher>>),
    Hungry(usize),
    Sated(usize),
    Leave,
}

impl Actor for Arbitrator {
    type Message = ArbitratorMessage;

    fn receive(&mut self, message: ArbitratorMessage, cx: &mut Cx<Self>) {
        match message {
            ArbitratorMessage::Open(philosophers) => {
                philosophers.iter().for_each(|philosopher| cx.send(philosopher, PhilosopherMessage::Begin));
                self.philosophers = philosophers;
            }
            ArbitratorMessage::Hungry(who) => {
                let forks = [who, (who + 1) % self.taken.len()];
                if forks.iter().any(|fork| self.taken[*fork]) {
                    self.refused += 1;
                    return cx.send(&self.philosophers[who], PhilosopherMessage::Refused);
                }
                forks.iter().for_each(|fork| self.taken[*fork] = true);
                cx.send(&self.philosophers[who], PhilosopherMessage::Eat);
            }
            ArbitratorMessage::Sated(who) => {
                self.eaten += 1;
                self.table.release_forks(who);
                [who, (who + 1) % self.taken.len()].iter().for_each(|fork| self.taken[*fork] = false);
            }
            ArbitratorMessage::Leave => {
                self.gone += 1;
                if self.gone == self.philosophers.len() {
                    assert_eq!(self.eaten, self.meals * self.gone as u64, "every meal was eaten");
                    cx.finish(3 * self.eaten, Some(self.refused));
                    cx.stop();
                }
            }
        }
    }
}

struct Philosopher {
    index: usize,
    arbitrator: Address<Arbitrator>,
    table: Arc<ForkMarks>,
    left: u64,
}

enum PhilosopherMessage {
    Begin,
    Eat,
    Refused,
}

impl Actor for Philosopher {
    type Message = PhilosopherMessage;

    fn receive(&mut self, message: PhilosopherMessage, cx: &mut Cx<Self>) {
        if let PhilosopherMessage::Eat = message {
            self.table.take(self.index);
            self.left -= 1;
            cx.send(&self.arbitrator, ArbitratorMessage::Sated(self.index));
        }
        if self.left > 0 {
            return cx.send(&self.arbitrator, ArbitratorMessage::Hungry(self.index));
        }
        cx.send(&self.arbitrator, ArbitratorMessage::Leave);
        cx.stop();
    }
}
