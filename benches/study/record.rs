//! Rows of raw data, and their CSV file.

use crate::Distribution;
use crate::distribution::PERCENTILES;
use std::path::Path;

/// One measured number.
#[derive(Clone, Debug, PartialEq)]
pub struct DataRow {
    /// Name of the case: `round_trip/parked`.
    pub case: String,
    /// Name of the variant: `dragonfly`, `flume`.
    pub variant: String,
    /// Number of the repeat, from 0.
    pub repeat: u32,
    /// Name of the metric: `latency.p99`, `per_message`.
    pub metric: String,
    /// Unit of the number: `ns`, `1/s`, `bytes`, `count`.
    pub unit: String,
    /// The number.
    pub value: f64,
    /// Background load during this run: the average number of cores that other programs used; 0 on an idle machine.
    pub background: f64,
}

/// The values that one run of one variant has measured.
#[derive(Default)]
pub struct RunValues {
    pub(crate) values: Vec<(String, String, f64)>,
}

impl RunValues {
    /// Adds one value.
    pub fn value(&mut self, metric: &str, unit: &str, value: f64) {
        self.values.push((metric.to_owned(), unit.to_owned(), value));
    }

    /// Adds the percentiles, the maximum and the count of a distribution of durations.
    pub fn distribution(&mut self, metric: &str, durations: &Distribution) {
        for (name, percent) in PERCENTILES {
            self.value(&format!("{metric}.{name}"), "ns", durations.percentile(percent) as f64);
        }
        self.value(&format!("{metric}.max"), "ns", durations.max() as f64);
        self.value(&format!("{metric}.count"), "count", durations.count() as f64);
    }
}

const HEADER: [&str; 7] = ["case", "variant", "repeat", "metric", "unit", "value", "others"];

/// Writes `rows` to `path` and replaces an existing file.
///
/// # Errors
/// When the file cannot be written.
pub fn write(path: &Path, rows: &[DataRow]) -> csv::Result<()> {
    let mut file = csv::Writer::from_path(path)?;
    file.write_record(HEADER)?;
    for row in rows {
        let (repeat, value, background) =
            (row.repeat.to_string(), row.value.to_string(), format!("{:.3}", row.background));
        file.write_record([&row.case, &row.variant, &repeat, &row.metric, &row.unit, &value, &background])?;
    }
    file.flush()?;
    Ok(())
}

/// Reads a file that [`write()`] wrote.
///
/// # Errors
/// When the file cannot be read, or one of its lines is not a row.
pub fn read(path: &Path) -> Result<Vec<DataRow>, Box<dyn std::error::Error>> {
    let mut rows = Vec::new();
    for record in csv::Reader::from_path(path)?.records() {
        let record = record?;
        let text = |column: usize| record.get(column).unwrap_or_default().to_owned();
        rows.push(DataRow {
            case: text(0),
            variant: text(1),
            repeat: text(2).parse()?,
            metric: text(3),
            unit: text(4),
            value: text(5).parse()?,
            background: text(6).parse()?,
        });
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_are_written_and_read_are_the_same() {
        let row = DataRow {
            case: "round_trip/parked".into(),
            variant: "dragonfly, with \"quotes\"".into(),
            repeat: 3,
            metric: "latency.p99".into(),
            unit: "ns".into(),
            value: 9120.5,
            background: 0.125,
        };
        let folder = std::env::temp_dir().join(format!("dragonfly-study-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("rows.csv");
        write(&path, std::slice::from_ref(&row)).unwrap();
        assert_eq!(read(&path).unwrap(), [row]);
        std::fs::write(&path, "case,variant,repeat,metric,unit,value,others\na,b,c,d,e,f,g\n").unwrap();
        assert!(read(&path).is_err());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
