//! Files of results: the measured numbers, the machine and the command, as CSV.

use std::fmt::Write as _;
use std::path::Path;

/// Prefix of the metrics that are goals, not measurements.
pub const GOAL: &str = "goal: ";

const HEADER: &str = "task,variant,metric,unit,value,others";

/// One measured number.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Task: `sample/pab/walk/forward`.
    pub task: String,
    /// Code that does the task: `avx2/compressed`, `sketch`, `ozz`.
    pub variant: String,
    /// Measured quantity: `median`, `p99`, `bytes`.
    pub metric: String,
    /// Unit of the value: `ns/bone`, `bytes`, `mm`.
    pub unit: String,
    /// The measured number, or a goal.
    pub value: f64,
    /// Number of cores that other programs kept busy during the measurement, on average.
    pub others: f64,
}

impl Figure {
    /// Creates a figure that was measured without other programs.
    pub fn new(task: &str, variant: &str, metric: &str, unit: &str, value: f64) -> Self {
        let [task, variant, metric, unit] = [task, variant, metric, unit].map(str::to_owned);
        Self { task, variant, metric, unit, value, others: 0.0 }
    }
}

/// The content of one file: names and values that describe the run, and a row for each number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Results {
    /// Machine, versions, flags, commit, command; written as `# name: value`.
    pub run: Vec<(String, String)>,
    /// The figures, in the order in which they were measured.
    pub rows: Vec<Figure>,
}

impl Results {
    /// Reads what [`text`](Self::text) returns. Fails at the first line that is no figure.
    pub fn parse(text: &str) -> Result<Self, String> {
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
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(path).map_err(|error| error.to_string());
        text.and_then(|text| Self::parse(&text)).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Returns the text of the file.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for (name, value) in &self.run {
            let _ = writeln!(text, "# {name}: {}", value.replace('\n', " "));
        }
        text += HEADER;
        text.push('\n');
        for Figure { task, variant, metric, unit, value, others } in &self.rows {
            let value = rounded(*value);
            let _ = writeln!(text, "{task},{variant},{metric},{unit},{value},{others:.2}");
        }
        text
    }

    /// Returns the value of this task, variant and metric, if it was recorded.
    pub fn value(&self, task: &str, variant: &str, metric: &str) -> Option<f64> {
        let wanted = |row: &&Figure| row.task == task && row.variant == variant && row.metric == metric;
        self.rows.iter().find(wanted).map(|row| row.value)
    }

    /// Returns the variants of a task, in the order of the rows.
    pub fn variants(&self, task: &str) -> Vec<&str> {
        let mut variants: Vec<&str> = Vec::new();
        for row in self.rows.iter().filter(|row| row.task == task) {
            if !variants.contains(&row.variant.as_str()) {
                variants.push(&row.variant);
            }
        }
        variants
    }

    /// Returns the value of `name` in the description of the run: `machine`, `commit`.
    pub fn about(&self, name: &str) -> &str {
        self.run.iter().find(|(other, _)| other == name).map_or("unknown", |(_, value)| value)
    }

    /// Returns the largest load by other programs during any row.
    pub fn others(&self) -> f64 {
        self.rows.iter().map(|row| row.others).fold(0.0, f64::max)
    }
}

/// Returns the value with the digits that are significant: four decimals, or four digits of a value below 1.
fn rounded(value: f64) -> f64 {
    let decimals = (4.0 - value.abs().log10().ceil()).clamp(4.0, 12.0);
    let scale = 10_f64.powf(decimals);
    (value * scale).round() / scale
}
