//! The cases that queues and actors share, and the amount of work in each.

use super::peer::{Message, Peer, WordMessage};
use super::work::{burst, late, one_way, round_trip};
use crate::plan::StudyMode;
use crate::{RunValues, Study, Variant};
use std::time::Duration;

/// Cases by name, each with its variants.
pub struct Cases {
    mode: StudyMode,
    group: &'static str,
    all: Vec<(String, Vec<Variant<'static>>)>,
}

impl Cases {
    /// Returns an empty list. `group` is the first part of the names of its cases.
    pub fn new(group: &'static str, study: &Study) -> Self {
        Self { mode: study.mode, group, all: Vec::new() }
    }

    /// Adds a peer to every case.
    pub fn add<P: Peer>(&mut self, name: &'static str) {
        self.add_one_way::<P>(name);
        self.round_trips(name, round_trip::run::<P>);
    }

    /// Adds a peer that can exist only once at a time, to all cases except round trips, which
    /// need two.
    pub fn add_one_way<P: Peer>(&mut self, name: &'static str) {
        self.one_way::<P, WordMessage<1>>(name, 1, "one_way/1_producer/8_bytes");
        self.one_way::<P, WordMessage<8>>(name, 1, "one_way/1_producer/64_bytes");
        self.one_way::<P, WordMessage<1>>(name, 2, "one_way/2_producers/8_bytes");
        self.one_way::<P, WordMessage<8>>(name, 2, "one_way/2_producers/64_bytes");
        let burst = self.mode.pick(1000, 100_000, 100_000);
        self.variant("burst", name, move |measured| burst::run::<P>(burst, measured));
        self.late::<P>(name, 1_000, self.mode.pick(20, 100, 500));
        self.late::<P>(name, 10_000, self.mode.pick(200, 1_000, 5_000));
    }

    /// Adds round trips with a function of the peer's own.
    pub fn round_trips(&mut self, name: &'static str, run: fn(round_trip::RoundTripPlan, &mut RunValues)) {
        let at_once = round_trip::RoundTripPlan { trips: self.mode.pick(50, 2_000, 20_000), rest: None };
        self.variant("round_trip/at_once", name, move |measured| run(at_once, measured));
        let rest = Some(Duration::from_micros(300));
        let rested = round_trip::RoundTripPlan { trips: self.mode.pick(10, 150, 500), rest };
        self.variant("round_trip/rested", name, move |measured| run(rested, measured));
    }

    fn one_way<P: Peer, M: Message>(&mut self, name: &'static str, producers: u64, case: &str) {
        let messages = self.mode.pick(1_000, 100_000, 400_000) / producers;
        let plan = one_way::OneWayPlan { producers, messages };
        self.variant(case, name, move |measured| one_way::run::<P, M>(plan, measured));
    }

    fn late<P: Peer>(&mut self, name: &'static str, hertz: u64, messages: u64) {
        let plan = late::LatePlan { period: Duration::from_nanos(1_000_000_000 / hertz), messages };
        self.variant(&format!("late/{hertz}_hz"), name, move |measured| late::run::<P>(plan, measured));
    }

    /// Adds a variant to the case of this name.
    pub fn variant(&mut self, case: &str, name: &'static str, run: impl FnMut(&mut RunValues) + 'static) {
        let case = format!("{}/{case}", self.group);
        let variant = Variant::new(name, run);
        match self.all.iter_mut().find(|(known, _)| *known == case) {
            Some((_, variants)) => variants.push(variant),
            None => self.all.push((case, vec![variant])),
        }
    }
}

/// Measures all cases.
pub fn measure(study: &mut Study, cases: Cases) {
    let repeats = study.mode.pick(1, 3, 7);
    for (case, variants) in cases.all {
        study.compare(&case, repeats, variants);
    }
}
