//! Summaries of the repeats of a measurement, for tables, for charts and for printing.

use crate::DataRow;

/// One metric of one variant of one case, over all its repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// The case, as in [`DataRow`].
    pub case: String,
    /// The variant, as in [`DataRow`].
    pub variant: String,
    /// The metric, as in [`DataRow`].
    pub metric: String,
    /// The unit, as in [`DataRow`].
    pub unit: String,
    /// Median of the repeats; for an even number of them, the mean of the two in the middle.
    pub median: f64,
    /// Smallest repeat.
    pub low: f64,
    /// Largest repeat.
    pub high: f64,
    /// Number of repeats.
    pub repeats: usize,
    /// Largest background load during a repeat, in cores.
    pub background: f64,
}

/// Summarizes the repeats in `rows`, in the order in which cases, variants and metrics first appear.
pub fn summarize(rows: &[DataRow]) -> Vec<Summary> {
    let mut groups: Vec<Vec<&DataRow>> = Vec::new();
    let key = |row: &DataRow| (row.case.clone(), row.variant.clone(), row.metric.clone());
    let mut places = std::collections::HashMap::new();
    for row in rows {
        let place = *places.entry(key(row)).or_insert(groups.len());
        match groups.get_mut(place) {
            Some(group) => group.push(row),
            None => groups.push(vec![row]),
        }
    }
    groups.iter().map(|group| of(group)).collect()
}

fn of(group: &[&DataRow]) -> Summary {
    let first = group[0];
    let [low, median, high] = spread(group.iter().map(|row| row.value));
    Summary {
        case: first.case.clone(),
        variant: first.variant.clone(),
        metric: first.metric.clone(),
        unit: first.unit.clone(),
        median,
        low,
        high,
        repeats: group.len(),
        background: group.iter().map(|row| row.background).fold(0.0, f64::max),
    }
}

/// Returns the smallest, the median and the largest of at least one value.
pub fn spread(values: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let upper = values[values.len() / 2];
    let lower = values[(values.len() - 1) / 2];
    [values[0], f64::midpoint(lower, upper), values[values.len() - 1]]
}

/// Returns whether a variant is one of this project.
pub fn is_ours(variant: &str) -> bool {
    variant.starts_with("dragonfly") || variant.starts_with("messages")
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// An invented row.
    pub(crate) fn row(
        case: &str,
        variant: &str,
        repeat: u32,
        metric: &str,
        unit: &str,
        value: f64,
    ) -> DataRow {
        DataRow {
            case: case.into(),
            variant: variant.into(),
            repeat,
            metric: metric.into(),
            unit: unit.into(),
            value,
            background: f64::from(repeat) / 10.0,
        }
    }

    #[test]
    fn repeats_become_a_median_and_a_spread() {
        let mut rows: Vec<DataRow> =
            [5.0, 1.0, 3.0].iter().zip(0..).map(|(value, n)| row("a", "x", n, "m", "ns", *value)).collect();
        rows.push(row("a", "y", 0, "m", "ns", 2.0));
        rows.push(row("a", "y", 1, "m", "ns", 4.0));
        let all = summarize(&rows);
        let shown: Vec<_> = all.iter().map(|one| (one.low, one.median, one.high, one.repeats)).collect();
        assert_eq!(shown, [(1.0, 3.0, 5.0, 3), (2.0, 3.0, 4.0, 2)]);
        assert_eq!(all[0].background, 0.2);
    }
}
