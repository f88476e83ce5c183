//! One work that is measured: its time by a stopwatch, or its instructions under a counter.

use std::hint::black_box;
use std::time::Instant;

/// A work, and how many units of it one call does.
pub(crate) struct Case {
    /// way, work, rig, case, with slashes between
    name: String,
    units: f64,
    unit: &'static str,
    work: Box<dyn FnMut()>,
}

/// Batches that are timed.
const BATCHES: usize = 400;

/// How long a batch takes at least, nanoseconds.
const BATCH: f64 = 25_000.0;

impl Case {
    /// `work` does `units` of `unit` in each call; wrap what it computes in [`black_box`].
    pub(crate) fn new(
        name: impl Into<String>,
        units: usize,
        unit: &'static str,
        work: impl FnMut() + 'static,
    ) -> Self {
        Self { name: name.into(), units: units as f64, unit, work: Box::new(work) }
    }

    /// Times many batches and prints nanoseconds a unit: the smallest, the median and the 99th percentile.
    ///
    /// Skipped when the first argument of the program, as `cargo bench -- part` passes it, is not part of the name.
    pub(crate) fn measure(&mut self) {
        let wanted = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
        if wanted.is_some_and(|part| !self.name.contains(&part)) {
            return;
        }
        (self.work)();
        let begin = Instant::now();
        (self.work)();
        let calls = (BATCH / (begin.elapsed().as_nanos() as f64).max(1.0)).ceil().max(1.0) as usize;
        let mut times: Vec<f64> = (0..BATCHES).map(|_| self.batch(calls)).collect();
        times.sort_by(f64::total_cmp);
        let [least, median, late] = [0, BATCHES / 2, BATCHES * 99 / 100].map(|at| times[at]);
        let Self { name, unit, .. } = self;
        println!("{name:<44} least {least:>9.2}   median {median:>9.2}   p99 {late:>9.2} ns a {unit}");
    }

    fn batch(&mut self, calls: usize) -> f64 {
        let begin = Instant::now();
        for _ in 0..calls {
            (self.work)();
        }
        begin.elapsed().as_nanos() as f64 / calls as f64 / self.units
    }
}

/// What the counter of instructions looks for by its name: nothing outside of it is counted.
#[inline(never)]
fn counted_region(work: &mut dyn FnMut(), calls: usize) {
    for _ in 0..calls {
        black_box(&mut *work)();
    }
}

/// With `--count NAME CALLS` runs only the case of that name, so often, and says how many units that were; with
/// `--list` says all names. Was it asked for one of them?
pub(crate) fn counted(cases: impl FnOnce() -> Vec<Case>) -> bool {
    let arguments: Vec<String> = std::env::args().collect();
    if arguments.iter().any(|argument| argument == "--list") {
        cases().iter().for_each(|case| println!("{}", case.name));
        return true;
    }
    let Some(at) = arguments.iter().position(|argument| argument == "--count") else { return false };
    let (Some(name), Some(Ok(calls))) =
        (arguments.get(at + 1), arguments.get(at + 2).map(|calls| calls.parse()))
    else {
        println!("--count NAME CALLS");
        return true;
    };
    for mut case in cases().into_iter().filter(|case| &case.name == name) {
        (case.work)();
        counted_region(&mut case.work, calls);
        println!("UNITS {} {}", case.units * calls as f64, case.unit);
    }
    true
}
