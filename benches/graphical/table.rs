//! Prints one line for each method with the main metrics; the raw data contains the rest.

use crate::DataRow;

/// Heading, metric, and divisor.
const COLUMNS: [(&str, &str, f64); 18] = [
    ("block50", "blocked.p50", 1e3),
    ("block99", "blocked.p99", 1e3),
    ("blockmax", "blocked.max", 1e3),
    ("frame50", "frame.p50", 1e3),
    ("frame99", "frame.p99", 1e3),
    ("late99", "jitter.p99", 1e3),
    ("missed", "missed", 1.0),
    ("visib50", "visible.p50", 1e3),
    ("visib99", "visible.p99", 1e3),
    ("visibmax", "visible.max", 1e3),
    ("answ50", "answer.p50", 1e3),
    ("answ99", "answer.p99", 1e3),
    ("ask99", "asking.p99", 1e3),
    ("posted/s", "posted", 1.0),
    ("shown/s", "shown", 1.0),
    ("backlog", "backlog", 1.0),
    ("MB", "memory", 1e6),
    ("cores", "cores", 1.0),
];

/// Prints the rows of `case`, without empty columns.
pub fn print(case: &str, variants: &[&str], rows: &[DataRow]) {
    let background = rows.iter().map(|row| row.background).fold(0.0, f64::max);
    println!("\n## {case} (background load: at most {background:.2} cores)");
    let columns: Vec<_> =
        COLUMNS.iter().filter(|column| rows.iter().any(|row| row.metric == column.1)).collect();
    print!("{:<20}", "");
    columns.iter().for_each(|(heading, ..)| print!("{heading:>10}"));
    println!();
    for variant in variants {
        print!("{variant:<20}");
        for (_, metric, unit) in &columns {
            let of = |row: &&DataRow| row.variant == *variant && row.metric == *metric;
            let mut values: Vec<f64> = rows.iter().filter(of).map(|row| row.value / unit).collect();
            values.sort_by(f64::total_cmp);
            match values.get(values.len() / 2) {
                Some(value) if *value < 10.0 => print!("{value:>10.2}"),
                Some(value) => print!("{value:>10.0}"),
                None => print!("{:>10}", "-"),
            }
        }
        println!();
    }
}
