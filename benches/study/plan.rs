//! Order and number of the measurements.

use crate::machine::Machine;
use crate::record::{self, DataRow, RunValues};
use crate::report;
use crate::summary::{Summary, summarize};
use dragonfly_kit::load::CpuLoad;
use dragonfly_kit::random::Random;
use std::time::Instant;

/// Thoroughness of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StudyMode {
    /// Everything once with little data: for tests, which check results and not times.
    Check,
    /// All of the study in under two minutes: rough numbers.
    Short,
    /// The numbers of the study, written to `benches/results`.
    Full,
}

impl StudyMode {
    /// Returns the one of three values that belongs to this mode.
    pub fn pick<T>(self, check: T, short: T, full: T) -> T {
        match self {
            Self::Check => check,
            Self::Short => short,
            Self::Full => full,
        }
    }
}

/// One of the alternatives that a case compares: its name, and a closure that measures it once.
pub struct Variant<'a> {
    name: &'a str,
    run: Box<dyn FnMut(&mut RunValues) + 'a>,
}

impl<'a> Variant<'a> {
    /// Returns a variant. `run` prepares the work, does it, checks its result, and records the measured values.
    pub fn new(name: &'a str, run: impl FnMut(&mut RunValues) + 'a) -> Self {
        Self { name, run: Box::new(run) }
    }
}

/// One run of one bench program.
pub struct Study {
    /// Thoroughness of the run.
    pub mode: StudyMode,
    /// Whether results are printed during the run. `false` for a bench that prints tables of its own.
    pub prints: bool,
    name: &'static str,
    only: Option<String>,
    order: Random,
    rows: Vec<DataRow>,
    begin: Instant,
}

impl Study {
    /// Reads the program's arguments: `--full`, `--check`, `--seed N`, and a part of a name, which selects cases. Prints
    /// the properties of the machine.
    pub fn start(name: &'static str) -> Self {
        let mut mode = StudyMode::Short;
        let (mut only, mut seed) = (None, 1);
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--full" => mode = StudyMode::Full,
                "--check" => mode = StudyMode::Check,
                "--seed" => seed = arguments.next().and_then(|word| word.parse().ok()).unwrap_or(seed),
                // Cargo passes such arguments to every bench.
                word if word.starts_with("--") => {}
                word => only = Some(word.to_owned()),
            }
        }
        let study = Self {
            mode,
            prints: true,
            name,
            only,
            order: Random::new(seed),
            rows: Vec::new(),
            begin: Instant::now(),
        };
        let load = CpuLoad::now();
        let machine = Machine::measure();
        let background = load.background_since();
        println!("# {name}, {mode:?}, order by seed {seed}");
        println!("# {}, {} cores, Linux {}", machine.processor, machine.cores, machine.kernel);
        println!("# clock: {:.0} ns per call, steps of {} ns", machine.clock_cost, machine.clock_step);
        let (wake, late) = (&machine.wake_ups, &machine.overshoot);
        println!(
            "# two wake-ups: p50 {} ns, p99 {} ns; lateness of a sleep of 1 ms: p50 {} ns, p99 {} ns",
            wake.percentile(50.0),
            wake.percentile(99.0),
            late.percentile(50.0),
            late.percentile(99.0),
        );
        let mut measured = RunValues::default();
        measured.value("cores", "count", machine.cores as f64);
        measured.value("order.seed", "count", seed as f64);
        measured.value("clock.cost", "ns", machine.clock_cost);
        measured.value("clock.step", "ns", machine.clock_step as f64);
        measured.distribution("two_wake_ups", wake);
        measured.distribution("overshoot_1ms", late);
        let mut study = study;
        let name = format!("{}, Linux {}", machine.processor, machine.kernel);
        study.keep("machine", &name, 0, measured, background);
        study
    }

    /// Returns a run for tests: everything once, nothing printed or written.
    pub fn check() -> Self {
        Self {
            mode: StudyMode::Check,
            prints: false,
            name: "check",
            only: None,
            order: Random::new(1),
            rows: Vec::new(),
            begin: Instant::now(),
        }
    }

    /// Measures every variant of `case`, `repeats` times, each time in another order. Prints a line for each variant.
    ///
    /// Does nothing when the arguments of the program select other cases.
    pub fn compare(&mut self, case: &str, repeats: u32, variants: Vec<Variant>) {
        if !self.wants(case) {
            return;
        }
        let mut variants = variants;
        let first = self.rows.len();
        let names: Vec<String> = variants.iter().map(|variant| variant.name.to_owned()).collect();
        for repeat in 0..repeats {
            for place in (1..variants.len()).rev() {
                variants.swap(place, self.order.below(place + 1));
            }
            // The load is measured over all variants of a repeat, because the kernel counts in steps of 10 ms, too
            // coarse for a short variant.
            let load = CpuLoad::now();
            let begin = self.rows.len();
            for variant in &mut variants {
                let mut measured = RunValues::default();
                (variant.run)(&mut measured);
                self.keep(case, variant.name, repeat, measured, 0.0);
            }
            let background = load.background_since();
            self.rows[begin..].iter_mut().for_each(|row| row.background = background);
        }
        if self.prints && self.mode != StudyMode::Check {
            self.print(first, &names);
        }
    }

    /// Returns whether `case` is selected.
    pub fn wants(&self, case: &str) -> bool {
        self.only.as_ref().is_none_or(|only| case.contains(only.as_str()))
    }

    fn keep(&mut self, case: &str, variant: &str, repeat: u32, measured: RunValues, background: f64) {
        self.rows.extend(measured.values.into_iter().map(|(metric, unit, value)| DataRow {
            case: case.to_owned(),
            variant: variant.to_owned(),
            repeat,
            metric,
            unit,
            value,
            background,
        }));
    }

    /// Prints a line for each variant and metric: the median of the repeats, their spread, and the background load.
    fn print(&self, first: usize, variants: &[String]) {
        let all = summarize(&self.rows[first..]);
        for variant in variants {
            for one in all.iter().filter(|one| one.variant == *variant) {
                let Summary { case, metric, unit, median, low, high, background, .. } = one;
                println!(
                    "{case:<44} {variant:<18} {metric:<22} {median:>14.1} {unit:<5} [{low:.1} .. {high:.1}] background {background:.2}"
                );
            }
        }
    }

    /// Returns everything measured so far.
    pub fn rows(&self) -> &[DataRow] {
        &self.rows
    }

    /// Writes the raw data and prints its path. A full run of all cases is written to `benches/results`, and the tables and
    /// charts are made again; any other run is written to the target folder.
    pub fn finish(self) -> Vec<DataRow> {
        let kept = self.mode == StudyMode::Full && self.only.is_none();
        let folder = if kept {
            report::folder().join("results")
        } else {
            std::env::current_exe().ok().and_then(|path| Some(path.parent()?.to_owned())).unwrap_or_default()
        };
        let path = folder.join(format!("{}.csv", self.name));
        match std::fs::create_dir_all(&folder)
            .map_err(Into::into)
            .and_then(|()| record::write(&path, &self.rows))
        {
            Ok(()) => println!("# {} s; raw data: {}", self.begin.elapsed().as_secs(), path.display()),
            Err(error) => eprintln!("cannot write {}: {error}", path.display()),
        }
        if self.only.is_none() {
            let missing = report::missing(self.name, &self.rows);
            missing.iter().for_each(|what| println!("# no data for: {what}"));
        }
        if kept {
            match report::update(&folder, &report::folder()) {
                Ok(changed) => changed.iter().for_each(|path| println!("# updated: {}", path.display())),
                Err(error) => eprintln!("cannot make the report: {error}"),
            }
        }
        self.rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variant_runs_in_every_repeat_in_shuffled_order() {
        let turns = std::cell::RefCell::new(String::new());
        let mut study = Study::check();
        let variant = |name: &'static str| {
            let turns = &turns;
            Variant::new(name, move |measured| {
                turns.borrow_mut().push_str(name);
                measured.value("metric", "ns", 1.0);
            })
        };
        study.compare("case", 8, vec![variant("a"), variant("b"), variant("c")]);
        let turns = turns.into_inner();
        let rounds: Vec<&[u8]> = turns.as_bytes().chunks(3).collect();
        assert_eq!(rounds.len(), 8);
        for round in &rounds {
            let mut sorted = round.to_vec();
            sorted.sort_unstable();
            assert_eq!(sorted, b"abc");
        }
        assert!(rounds.iter().any(|round| round != &rounds[0]), "{turns}");
        assert_eq!(study.rows().len(), 24);
    }
}
