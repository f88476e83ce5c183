//! The stopwatch: works of a group take turns, so that whatever else the machine does meets all of them alike.

use crate::case::{Case, Work, rival_of};
use std::time::Instant;

/// Rounds in which each work of a group is timed once: enough for a 99th percentile.
const ROUNDS: usize = 400;

/// Fewer where works are long, but so many.
const LEAST_ROUNDS: usize = 100;

/// Nanoseconds that a timed stretch takes at least; short works are called several times in it.
const STRETCH: f64 = 25_000.0;

/// Nanoseconds from which on a work is long.
const LONG: f64 = 1e6;

/// Nanoseconds after which a group has no more than [`LEAST_ROUNDS`].
const GROUP: f64 = 2.5e9;

/// Times of one case, nanoseconds a unit.
pub(crate) struct Measured {
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    /// Whom it stands beside.
    pub(crate) rival: Option<String>,
    /// One a round.
    rounds: Vec<f64>,
}

impl Measured {
    pub(crate) fn least(&self) -> f64 {
        part(&self.rounds, 0)
    }

    pub(crate) fn median(&self) -> f64 {
        part(&self.rounds, 50)
    }

    pub(crate) fn p99(&self) -> f64 {
        part(&self.rounds, 99)
    }

    /// How often the time of `other` it takes: the median of the ratios of single rounds.
    pub(crate) fn ratio(&self, other: &Self) -> f64 {
        let ratios: Vec<f64> = self.rounds.iter().zip(&other.rounds).map(|(a, b)| a / b).collect();
        part(&ratios, 50)
    }
}

/// The number that `percent` of `numbers` are below.
fn part(numbers: &[f64], percent: usize) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() * percent / 100).copied().unwrap_or(f64::NAN)
}

/// A work, and how often it is called in a stretch.
struct Running {
    work: Work,
    calls: usize,
    units: f64,
    /// Does it not matter what it finds in the caches when it begins?
    is_long: bool,
}

impl Running {
    fn new(case: Case) -> (Self, f64) {
        let units = case.units as f64;
        let mut running = Self { work: case.start(), calls: 1, units, is_long: true };
        let call = (running.stretch() * units).max(1.0);
        running.calls = (STRETCH / call).ceil().max(1.0) as usize;
        running.is_long = call > LONG;
        let calls = running.calls + usize::from(!running.is_long);
        (running, call * calls as f64)
    }

    /// Nanoseconds a unit.
    fn stretch(&mut self) -> f64 {
        let begin = Instant::now();
        for _ in 0..self.calls {
            (self.work)();
        }
        begin.elapsed().as_nanos() as f64 / self.calls as f64 / self.units
    }

    /// Its turn in a round: once to bring back what the others drove out of the caches, then timed.
    fn turn(&mut self) -> f64 {
        if !self.is_long {
            (self.work)();
        }
        self.stretch()
    }
}

/// Measures the cases of one group.
pub(crate) fn measure(cases: Vec<Case>) -> Vec<Measured> {
    let mut measured: Vec<Measured> = cases
        .iter()
        .map(|case| Measured {
            name: case.name(),
            unit: case.unit,
            rival: rival_of(case, cases.iter()),
            rounds: Vec::new(),
        })
        .collect();
    let (mut running, turns): (Vec<Running>, Vec<f64>) = cases.into_iter().map(Running::new).unzip();
    let rounds = ((GROUP / turns.iter().sum::<f64>()) as usize).clamp(LEAST_ROUNDS, ROUNDS);
    for _ in 0..rounds {
        for (running, measured) in running.iter_mut().zip(&mut measured) {
            measured.rounds.push(running.turn());
        }
    }
    measured
}
