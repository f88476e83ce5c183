//! The things on which the place of one thing depends at a time: what holds it, what those look at, and so on.

use super::holds::MOST_FADES;
use super::thing::PlannedThing;
use crate::stage::time::StageTime;

/// Work to find what places depend on.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NeededWork {
    /// Things, each of which is placed and posed.
    pub(super) things: usize,
    /// Attachments and looks that had begun.
    pub(super) cues: usize,
}

/// A set of things that contains everything on which its members depend at one time. The memory is used again for the next time.
#[derive(Debug)]
pub(super) struct NeededThings {
    /// Place of each thing in the order in which those that hold others come first.
    ranks: Vec<usize>,
    /// Number of the last call in which each thing was found.
    found_in: Vec<u32>,
    call: u32,
    /// Number of things found, and of attachments and looks that were considered, in all calls.
    pub(super) work: NeededWork,
    /// The things found, by their ranks.
    pub(super) by_rank: Vec<usize>,
    /// The same by their positions in the cast.
    pub(super) by_index: Vec<usize>,
}

impl NeededThings {
    /// Creates an empty set for things of which those that hold others come first in `order`.
    pub(super) fn new(order: &[usize]) -> Self {
        let mut ranks = vec![0; order.len()];
        for (rank, &thing) in order.iter().enumerate() {
            ranks[thing] = rank;
        }
        let found_in = vec![0; order.len()];
        Self {
            ranks,
            found_in,
            call: 0,
            work: NeededWork::default(),
            by_rank: Vec::new(),
            by_index: Vec::new(),
        }
    }

    /// Finds what the place of `thing` needs at `time`, `thing` included.
    pub(super) fn find(&mut self, things: &[PlannedThing], thing: usize, time: StageTime) {
        self.call += 1;
        self.by_rank.clear();
        self.add(thing);
        let mut done = 0;
        while let Some(&next) = self.by_rank.get(done) {
            done += 1;
            let planned = &things[next];
            let begun = planned.holds.partition_point(|hold| hold.begin <= time);
            // A detachment whose place is not known yet counts for nothing; a known one hides what is before it.
            // An attachment fades into at most MOST_FADES others.
            let mut latest = MOST_FADES + 1;
            for hold in planned.holds[..begun].iter().rev() {
                self.work.cues += 1;
                if !hold.is_known() {
                    continue;
                }
                if latest == 0 || !hold.attaches() {
                    break;
                }
                latest -= 1;
                if let Some(holder) = hold.holder() {
                    self.add(holder);
                }
            }
            let begun = planned.looks.partition_point(|look| look.span.begin <= time);
            // They are considered again where the head turns.
            self.work.cues += 2 * begun;
            let active = planned.looks[..begun].iter().filter(|look| look.span.weight(time) > 0.0);
            for seen in active.filter_map(|look| look.at.thing()) {
                self.add(seen);
            }
        }
        self.work.things += self.by_rank.len();
        self.by_index.clone_from(&self.by_rank);
        self.by_index.sort_unstable();
        let ranks = &self.ranks;
        self.by_rank.sort_unstable_by_key(|&thing| ranks[thing]);
    }

    fn add(&mut self, thing: usize) {
        if std::mem::replace(&mut self.found_in[thing], self.call) != self.call {
            self.by_rank.push(thing);
        }
    }
}
