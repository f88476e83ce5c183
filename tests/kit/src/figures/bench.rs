//! A bench that prints its figures, and records them with `-- --record`.

use super::page::FigurePage;
use super::results::{Figure, GOAL, Results};
use super::run;
use crate::load::CpuLoad;
use std::process::ExitCode;

/// Returns the percentile: `percent` of `numbers` are below it; the largest one for 100, NaN without numbers.
pub fn percentile(numbers: &[f64], percent: usize) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    let index = (sorted.len() * percent / 100).min(sorted.len().saturating_sub(1));
    sorted.get(index).copied().unwrap_or(f64::NAN)
}

/// Mode of a bench.
#[derive(Clone, Copy, PartialEq)]
enum FigureMode {
    /// Prints the figures.
    Print,
    /// As [`Print`](Self::Print), and writes the files of results and the tables of the page.
    Record,
    /// Only writes the tables of the page, from the files of earlier runs.
    Report,
}

/// A bench whose figures are shown on a page.
///
/// The name of a case is crate/file/task/variant; `file` is the name of its file of results. Arguments that are parts of
/// names choose cases: `cargo bench -- editor/frame`.
pub struct FigureBench {
    page: &'static FigurePage,
    crate_name: &'static str,
    mode: FigureMode,
    parts: Vec<String>,
    /// Figures of the file that is measured now.
    rows: Vec<Figure>,
    /// The file that is measured now.
    file: &'static str,
    measured: Vec<(&'static str, Vec<Figure>)>,
}

impl FigureBench {
    /// Runs `work`: measures, prints, and writes if `--record` is among the arguments. With `--report`, only makes the tables of
    /// the page again. `command` starts this program: `cargo bench -p dragonfly --bench drag`.
    pub fn run(
        page: &'static FigurePage,
        crate_name: &'static str,
        command: &str,
        work: impl FnOnce(&mut Self),
    ) -> ExitCode {
        let (options, parts): (Vec<String>, Vec<String>) =
            std::env::args().skip(1).partition(|argument| argument.starts_with("--"));
        let has = |option: &str| options.iter().any(|given| given == option);
        let mode = match () {
            () if has("--report") => FigureMode::Report,
            () if has("--record") => FigureMode::Record,
            () => FigureMode::Print,
        };
        let mut this =
            Self { page, crate_name, mode, parts, rows: Vec::new(), file: "", measured: Vec::new() };
        match this.measure(command, work) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("{error}");
                ExitCode::FAILURE
            }
        }
    }

    fn measure(&mut self, command: &str, work: impl FnOnce(&mut Self)) -> Result<(), String> {
        if self.mode == FigureMode::Report {
            return self.page.update();
        }
        let is_file = |part: &&String| self.page.names().iter().any(|name| **part == self.prefix(name));
        if self.mode == FigureMode::Record && !self.parts.iter().all(|part| is_file(&part)) {
            let files: Vec<String> = self.page.names().iter().map(|name| self.prefix(name)).collect();
            return Err(format!("--record measures whole files: name some of {}", files.join(", ")));
        }
        work(self);
        if self.measured.is_empty() {
            return Err(format!("no case has {} in its name", self.parts.join(" or ")));
        }
        if self.mode == FigureMode::Record {
            self.record(command)?;
        }
        self.failed_goals()
    }

    /// Measures the cases of one file of results, if one of them is wanted.
    pub fn file(&mut self, name: &'static str, work: impl FnOnce(&mut Self)) {
        let prefix = self.prefix(name);
        let is_wanted = |part: &String| prefix.contains(part.as_str()) || part.starts_with(&prefix);
        if !self.parts.is_empty() && !self.parts.iter().any(is_wanted) {
            return;
        }
        self.file = name;
        let load = CpuLoad::now();
        work(self);
        let others = load.background_since();
        println!("{prefix}: other programs used {others:.2} cores");
        let rows = std::mem::take(&mut self.rows);
        self.measured.push((name, rows.into_iter().map(|row| Figure { others, ..row }).collect()));
    }

    /// Returns whether the cases of a task in the current file are wanted.
    pub fn wants(&self, task: &str) -> bool {
        let name = format!("{}/{task}", self.prefix(self.file));
        self.parts.is_empty() || self.parts.iter().any(|part| name.contains(part.as_str()))
    }

    /// Prints and keeps the median, the 99th percentile, the maximum and the number of `times`, in milliseconds.
    ///
    /// # Panics
    /// If there are no times.
    pub fn times(&mut self, task: &str, variant: &str, times: &[f64]) {
        assert!(!times.is_empty(), "{}: nothing was measured", self.name(task, variant));
        let [median, p99, worst] = [50, 99, 100].map(|percent| percentile(times, percent));
        let name = self.name(task, variant);
        let count = times.len();
        println!(
            "{name:<64} median {median:>9.4} ms   p99 {p99:>9.4} ms   worst {worst:>9.4} ms   of {count}"
        );
        for (metric, value) in [("median", median), ("p99", p99), ("worst", worst)] {
            self.rows.push(Figure::new(task, variant, metric, "ms", value));
        }
        self.rows.push(Figure::new(task, variant, "samples", "count", count as f64));
    }

    /// Prints and keeps one number.
    pub fn value(&mut self, task: &str, variant: &str, metric: &str, unit: &str, value: f64) {
        println!("{:<64} {metric} {value} {unit}", self.name(task, variant));
        self.rows.push(Figure::new(task, variant, metric, unit, value));
    }

    /// Sets the largest allowed value of a metric that was kept; the bench fails if it is exceeded.
    pub fn goal(&mut self, task: &str, variant: &str, metric: &str, unit: &str, value: f64) {
        self.rows.push(Figure::new(task, variant, &format!("{GOAL}{metric}"), unit, value));
    }

    fn prefix(&self, file: &str) -> String {
        format!("{}/{file}", self.crate_name)
    }

    fn name(&self, task: &str, variant: &str) -> String {
        let name = format!("{}/{task}/{variant}", self.prefix(self.file));
        name.trim_end_matches('/').to_owned()
    }

    /// Returns an error that lists the goals that were not reached.
    fn failed_goals(&self) -> Result<(), String> {
        let mut failed = Vec::new();
        for (file, rows) in &self.measured {
            for goal in rows {
                let Some(metric) = goal.metric.strip_prefix(GOAL) else { continue };
                let is_measured = |row: &&Figure| {
                    row.task == goal.task && row.variant == goal.variant && row.metric == metric
                };
                if let Some(row) = rows.iter().find(is_measured).filter(|row| row.value > goal.value) {
                    let (name, unit) = (format!("{}/{}", self.prefix(file), goal.task), &goal.unit);
                    failed.push(format!("{name}: {metric} {} {unit}, at most {}", row.value, goal.value));
                }
            }
        }
        if failed.is_empty() { Ok(()) } else { Err(failed.join("\n")) }
    }

    /// Writes the files of results and the tables of the page.
    fn record(&self, command: &str) -> Result<(), String> {
        let parts = self.parts.iter().map(|part| format!(" {part}")).collect::<String>();
        let command = format!("{command} -- --record{parts}");
        let run = run::description(&command, self.page);
        for (name, rows) in &self.measured {
            let path = self.page.file(name);
            let text = Results { run: run.clone(), rows: rows.clone() }.text();
            std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        }
        self.page.update()
    }
}
