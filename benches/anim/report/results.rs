//! Files of results: the measured numbers, the machine and the command, as CSV.

use std::fmt::Write as _;
use std::path::Path;

/// Prefix of the metrics that are goals, not measurements.
pub(crate) const GOAL: &str = "goal: ";

const HEADER: &str = "task,variant,metric,unit,value,others";

/// One measured number.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Figure {
    /// Task: `sample/pab/walk/forward`.
    pub(crate) task: String,
    /// Code that does the task: `avx2/compressed`, `sketch`, `ozz`.
    pub(crate) variant: String,
    /// Measured quantity: `median`, `p99`, `bytes`.
    pub(crate) metric: String,
    /// Unit of the value: `ns/bone`, `bytes`, `mm`.
    pub(crate) unit: String,
    pub(crate) value: f64,
    /// Number of cores that other programs kept busy during the measurement, on average.
    pub(crate) others: f64,
}

impl Figure {
    pub(crate) fn new(task: &str, variant: &str, metric: &str, unit: &str, value: f64) -> Self {
        let [task, variant, metric, unit] = [task, variant, metric, unit].map(str::to_owned);
        Self { task, variant, metric, unit, value, others: 0.0 }
    }
}

/// The content of one file: names and values that describe the run, and a row for each number.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Results {
    /// Machine, versions, flags, commit, command; written as `# name: value`.
    pub(crate) run: Vec<(String, String)>,
    pub(crate) rows: Vec<Figure>,
}

impl Results {
    /// Reads what [`text`](Self::text) returns.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let mut results = Self::default();
        for line in text.lines().filter(|line| *line != HEADER) {
            if let Some(line) = line.strip_prefix("# ") {
                let (name, value) = line.split_once(": ").ok_or_else(|| format!("no value: {line}"))?;
                results.run.push((name.to_owned(), value.to_owned()));
                continue;
            }
            let [task, variant, metric, unit, value, others] = line.split(',').collect::<Vec<_>>()[..] else {
                return Err(format!("not six columns: {line}"));
            };
            let number = |text: &str| text.parse().map_err(|error| format!("{error}: {line}"));
            let figure = Figure::new(task, variant, metric, unit, number(value)?);
            results.rows.push(Figure { others: number(others)?, ..figure });
        }
        Ok(results)
    }

    /// Reads a file. An error contains its path.
    pub(crate) fn read(path: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(path).map_err(|error| error.to_string());
        text.and_then(|text| Self::parse(&text)).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Returns the text of the file.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        for (name, value) in &self.run {
            let _ = writeln!(text, "# {name}: {}", value.replace('\n', " "));
        }
        text += HEADER;
        text.push('\n');
        for Figure { task, variant, metric, unit, value, others } in &self.rows {
            // Further digits would not be significant.
            let value = (value * 1e4).round() / 1e4;
            let _ = writeln!(text, "{task},{variant},{metric},{unit},{value},{others:.2}");
        }
        text
    }

    /// Returns the value of this task, variant and metric, if it was recorded.
    pub(crate) fn value(&self, task: &str, variant: &str, metric: &str) -> Option<f64> {
        let wanted = |row: &&Figure| row.task == task && row.variant == variant && row.metric == metric;
        self.rows.iter().find(wanted).map(|row| row.value)
    }

    /// Returns the value of `name` in the description of the run: `machine`, `commit`.
    pub(crate) fn about(&self, name: &str) -> &str {
        self.run.iter().find(|(other, _)| other == name).map_or("unknown", |(_, value)| value)
    }

    /// Returns the largest load by other programs during any row.
    pub(crate) fn others(&self) -> f64 {
        self.rows.iter().map(|row| row.others).fold(0.0, f64::max)
    }
}
