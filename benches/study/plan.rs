//! In which order things are measured, and how often.

use crate::machine::Machine;
use crate::record::{self, Measured, Row};
use crate::report;
use crate::summary::{Summary, summarise};
use dragonfly_kit::load::CpuLoad;
use dragonfly_kit::random::Random;
use std::time::Instant;

/// How thorough a run is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Does everything once with little data: for tests, which look at results and not at times.
    Check,
    /// Under two minutes for all of the study: rough figures.
    Short,
    /// The figures of the study; written down in `benches/results`.
    Full,
}

impl Mode {
    /// One of three values, by thoroughness.
    pub fn pick<T>(self, check: T, short: T, full: T) -> T {
        match self {
            Self::Check => check,
            Self::Short => short,
            Self::Full => full,
        }
    }
}

/// One of the things a case compares: its name, and what to do to measure it once.
pub struct Variant<'a> {
    name: &'a str,
    run: Box<dyn FnMut(&mut Measured) + 'a>,
}

impl<'a> Variant<'a> {
    /// `run` sets up what it needs, does the work, checks its result, and writes down what it measured.
    pub fn new(name: &'a str, run: impl FnMut(&mut Measured) + 'a) -> Self {
        Self { name, run: Box::new(run) }
    }
}

/// One run of one bench program.
pub struct Study {
    /// How thorough it is.
    pub mode: Mode,
    /// Are results printed as they come? A bench that prints tables of its own says no.
    pub prints: bool,
    name: &'static str,
    only: Option<String>,
    order: Random,
    rows: Vec<Row>,
    begin: Instant,
}

impl Study {
    /// Reads the program's arguments: `--full`, `--check`, `--seed N`, and a part of a case's name to measure only those.
    /// Prints what the machine is and what its clock and wake-ups cost.
    pub fn start(name: &'static str) -> Self {
        let mut mode = Mode::Short;
        let (mut only, mut seed) = (None, 1);
        let mut arguments = std::env::args().skip(1);
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--full" => mode = Mode::Full,
                "--check" => mode = Mode::Check,
                "--seed" => seed = arguments.next().and_then(|word| word.parse().ok()).unwrap_or(seed),
                // What cargo itself says to every bench.
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
        let others = load.others_since();
        println!("# {name}, {mode:?}, order by seed {seed}");
        println!("# {}, {} cores, Linux {}", machine.processor, machine.cores, machine.kernel);
        println!("# clock: {:.0} ns a look, steps of {} ns", machine.clock_cost, machine.clock_step);
        let (wake, late) = (&machine.wake_ups, &machine.overshoot);
        println!(
            "# two wake-ups: p50 {} ns, p99 {} ns; a sleep of 1 ms is late by p50 {} ns, p99 {} ns",
            wake.percentile(50.0),
            wake.percentile(99.0),
            late.percentile(50.0),
            late.percentile(99.0),
        );
        let mut measured = Measured::default();
        measured.value("cores", "count", machine.cores as f64);
        measured.value("order.seed", "count", seed as f64);
        measured.value("clock.cost", "ns", machine.clock_cost);
        measured.value("clock.step", "ns", machine.clock_step as f64);
        measured.distribution("two_wake_ups", wake);
        measured.distribution("overshoot_1ms", late);
        let mut study = study;
        let name = format!("{}, Linux {}", machine.processor, machine.kernel);
        study.keep("machine", &name, 0, measured, others);
        study
    }

    /// For tests: everything once, nothing printed or written.
    pub fn check() -> Self {
        Self {
            mode: Mode::Check,
            prints: false,
            name: "check",
            only: None,
            order: Random::new(1),
            rows: Vec::new(),
            begin: Instant::now(),
        }
    }

    /// Measures every variant of `case`, `repeats` times, each time in another order. One line a variant is printed.
    ///
    /// Skipped when the program was told to measure something else.
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
            // Over all variants of the repeat: the kernel counts in steps of 10 ms, too coarse for one that is short.
            let load = CpuLoad::now();
            let begin = self.rows.len();
            for variant in &mut variants {
                let mut measured = Measured::default();
                (variant.run)(&mut measured);
                self.keep(case, variant.name, repeat, measured, 0.0);
            }
            let others = load.others_since();
            self.rows[begin..].iter_mut().for_each(|row| row.others = others);
        }
        if self.prints && self.mode != Mode::Check {
            self.print(first, &names);
        }
    }

    /// Is `case` to be measured?
    pub fn wants(&self, case: &str) -> bool {
        self.only.as_ref().is_none_or(|only| case.contains(only.as_str()))
    }

    fn keep(&mut self, case: &str, variant: &str, repeat: u32, measured: Measured, others: f64) {
        self.rows.extend(measured.values.into_iter().map(|(metric, unit, value)| Row {
            case: case.to_owned(),
            variant: variant.to_owned(),
            repeat,
            metric,
            unit,
            value,
            others,
        }));
    }

    /// One line for each variant and metric: the median of the repeats, their spread, and the load of others.
    fn print(&self, first: usize, variants: &[String]) {
        let all = summarise(&self.rows[first..]);
        for variant in variants {
            for one in all.iter().filter(|one| one.variant == *variant) {
                let Summary { case, metric, unit, median, low, high, others, .. } = one;
                println!(
                    "{case:<44} {variant:<18} {metric:<22} {median:>14.1} {unit:<5} [{low:.1} .. {high:.1}] others {others:.2}"
                );
            }
        }
    }

    /// Everything measured so far.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Writes the raw data, and says where: of a full and whole run to `benches/results`, with the tables and charts made
    /// anew; of any other run to the target folder.
    pub fn finish(self) -> Vec<Row> {
        let kept = self.mode == Mode::Full && self.only.is_none();
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
            missing.iter().for_each(|what| println!("# not to be shown: {what}"));
        }
        if kept {
            match report::update(&folder, &report::folder()) {
                Ok(changed) => changed.iter().for_each(|path| println!("# made anew: {}", path.display())),
                Err(error) => eprintln!("the report is not made: {error}"),
            }
        }
        self.rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variant_has_its_turn_in_every_repeat_and_not_always_in_the_same_order() {
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
