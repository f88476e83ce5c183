//! The stopwatch: the cases of a group take turns, so that background load affects all of them equally.

use crate::case::{BenchCase, RunCase, baseline_of};
use crate::rivals;
use dragonfly_kit::figures::percentile;
use dragonfly_kit::load::CpuLoad;

/// Number of rounds in which each case of a group is timed once: enough for a 99th percentile.
const ROUNDS: usize = 400;

/// Smallest number of rounds, for long cases.
const MIN_ROUNDS: usize = 100;

/// Shortest time of a batch, in nanoseconds; short cases are called several times in it.
const BATCH: f64 = 25_000.0;

/// Time of one call, in nanoseconds, from which a case is long.
const LONG: f64 = 1e6;

/// Time after which a group gets no more than [`MIN_ROUNDS`], in nanoseconds.
const GROUP: f64 = 2.5e9;

/// Times of one case, in nanoseconds per unit.
pub(crate) struct CaseTimes {
    pub(crate) variant: String,
    pub(crate) task: String,
    pub(crate) unit: &'static str,
    /// Name of the case that this one is compared with.
    pub(crate) baseline: Option<String>,
    /// Number of cores that other programs kept busy while the group was measured, on average.
    pub(crate) others: f64,
    /// One time per round.
    rounds: Vec<f64>,
}

impl CaseTimes {
    pub(crate) fn name(&self) -> String {
        format!("{}/{}", self.variant, self.task)
    }

    pub(crate) fn min(&self) -> f64 {
        percentile(&self.rounds, 0)
    }

    pub(crate) fn median(&self) -> f64 {
        percentile(&self.rounds, 50)
    }

    pub(crate) fn p99(&self) -> f64 {
        percentile(&self.rounds, 99)
    }

    /// Returns how many times as long as `other` the case takes: the median of the ratios of single rounds.
    pub(crate) fn ratio(&self, other: &Self) -> f64 {
        let ratios: Vec<f64> = self.rounds.iter().zip(&other.rounds).map(|(a, b)| a / b).collect();
        percentile(&ratios, 50)
    }
}

/// A case that is set up, and the number of its calls in a batch.
struct RunningCase {
    case: Box<dyn RunCase>,
    calls: usize,
    units: f64,
    /// Whether one call takes so long that the state of the caches at its start does not matter.
    is_long: bool,
}

impl RunningCase {
    fn new(case: BenchCase) -> (Self, f64) {
        let units = case.units as f64;
        let mut running = Self { case: case.start(), calls: 1, units, is_long: true };
        let call = (running.batch() * units).max(1.0);
        running.calls = (BATCH / call).ceil().max(1.0) as usize;
        running.is_long = call > LONG;
        let calls = running.calls + usize::from(!running.is_long);
        (running, call * calls as f64)
    }

    /// Runs one batch. Returns the nanoseconds per unit.
    fn batch(&mut self) -> f64 {
        self.case.run(self.calls) / self.calls as f64 / self.units
    }

    /// Takes one turn: a call that brings its data back into the caches, then a timed batch.
    fn turn(&mut self) -> f64 {
        if !self.is_long {
            self.case.call();
        }
        self.batch()
    }
}

/// Measures the cases of one group in turns.
pub(crate) fn measure(cases: Vec<BenchCase>) -> Vec<CaseTimes> {
    let mut measured: Vec<CaseTimes> = cases
        .iter()
        .map(|case| CaseTimes {
            variant: case.variant.clone(),
            task: case.task.clone(),
            unit: case.unit,
            baseline: baseline_of(case, cases.iter()),
            others: 0.0,
            rounds: Vec::new(),
        })
        .collect();
    let (mut running, turns): (Vec<RunningCase>, Vec<f64>) = cases.into_iter().map(RunningCase::new).unzip();
    let rounds = ((GROUP / turns.iter().sum::<f64>()) as usize).clamp(MIN_ROUNDS, ROUNDS);
    let load = CpuLoad::with(&rivals::processes());
    for _ in 0..rounds {
        for (running, measured) in running.iter_mut().zip(&mut measured) {
            measured.rounds.push(running.turn());
        }
    }
    let others = load.background_since();
    measured.iter_mut().for_each(|one| one.others = others);
    measured
}
