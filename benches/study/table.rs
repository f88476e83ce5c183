//! Tables in Markdown, from summaries.

use crate::amount;
use crate::summary::Summary;
use std::fmt::Write as _;

/// A metric and the heading of its column.
pub type TableColumn = (&'static str, &'static str);

/// Returns a table with a row for each variant of each case, sorted by the first column, and a column for each metric that
/// at least one of them has. The last column is the largest background load.
pub fn wide(all: &[Summary], columns: &[TableColumn]) -> String {
    let in_use = |column: &&TableColumn| all.iter().any(|one| one.metric == column.0);
    let columns: Vec<&TableColumn> = columns.iter().filter(in_use).collect();
    let cases = distinct(all.iter().map(|one| one.case.as_str()));
    let prefix = common_folder(&cases);
    let mut text = String::from(if cases.len() > 1 { "| case | variant |" } else { "| variant |" });
    for (_, heading) in &columns {
        let _ = write!(text, " {heading} |");
    }
    text += " background load |\n";
    let count = columns.len() + usize::from(cases.len() > 1) + 2;
    text += &format!("|{}\n", "---|".repeat(count));
    for case in &cases {
        let of_case: Vec<&Summary> = all.iter().filter(|one| one.case == *case).collect();
        let mut variants = distinct(of_case.iter().map(|one| one.variant.as_str()));
        let find = |variant: &str, metric: &str| {
            of_case.iter().find(|one| one.variant == variant && one.metric == metric)
        };
        let first = |variant: &str| {
            let found = columns.iter().find_map(|(metric, _)| find(variant, metric));
            found.map_or(f64::INFINITY, |one| one.median)
        };
        variants.sort_by(|a, b| first(a).total_cmp(&first(b)).then(a.cmp(b)));
        for variant in variants {
            if cases.len() > 1 {
                let _ = write!(text, "| {} ", &case[prefix..]);
            }
            let _ = write!(text, "| {variant} |");
            let mut background = 0.0_f64;
            for (metric, _) in &columns {
                match find(variant, metric) {
                    Some(one) => {
                        background = background.max(one.background);
                        let _ =
                            write!(text, " {} |", amount::spread(one.median, one.low, one.high, &one.unit));
                    }
                    None => text += " – |",
                }
            }
            let _ = writeln!(text, " {background:.2} |");
        }
    }
    text
}

/// Returns a table with a row for each summary.
pub fn long(all: &[Summary]) -> String {
    let mut text = String::from(
        "| case | variant | metric | median [min .. max] | repeats | background load |\n|---|---|---|---|---|---|\n",
    );
    for one in all {
        let value = amount::spread(one.median, one.low, one.high, &one.unit);
        let Summary { case, variant, metric, repeats, background, .. } = one;
        let _ = writeln!(text, "| {case} | {variant} | {metric} | {value} | {repeats} | {background:.2} |");
    }
    text
}

/// Returns each name once, in the order of first appearance.
pub fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut found = Vec::new();
    for name in names {
        if !found.contains(&name) {
            found.push(name);
        }
    }
    found
}

/// Returns the length of the start that all names share, in whole folders.
pub fn common_folder(names: &[&str]) -> usize {
    let Some(first) = names.first() else { return 0 };
    let shared = |end: &usize| names.iter().all(|name| name.starts_with(&first[..*end]));
    first.match_indices('/').map(|(slash, _)| slash + 1).filter(shared).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::{summarize, tests::row};

    #[test]
    fn a_table_has_every_variant_sorted_and_a_dash_for_each_missing_value() {
        let all = summarize(&[
            row("queue/trip/a", "slow", 0, "p50", "ns", 20_000.0),
            row("queue/trip/a", "slow", 1, "p50", "ns", 30_000.0),
            row("queue/trip/a", "slow", 2, "p50", "ns", 25_000.0),
            row("queue/trip/a", "fast", 0, "p50", "ns", 900.0),
            row("queue/trip/a", "fast", 0, "allocations", "1/msg", 0.5),
            row("queue/trip/b", "fast", 0, "p50", "ns", 1.0),
        ]);
        let columns = [("p50", "median"), ("allocations", "allocations"), ("p99", "rare")];
        let expected = "\
| case | variant | median | allocations | background load |
|---|---|---|---|---|
| a | fast | 900 ns | 0.50 per message | 0.00 |
| a | slow | 25.0 [20.0 .. 30.0] µs | – | 0.20 |
| b | fast | 1.00 ns | – | 0.00 |
";
        assert_eq!(wide(&all, &columns), expected);
        assert_eq!(long(&all).lines().count(), 2 + all.len());
    }

    #[test]
    fn case_names_are_shortened_by_whole_folders_only() {
        assert_eq!(common_folder(&["a/b/cc", "a/b/cd"]), 4);
        assert_eq!(common_folder(&["a/b", "ab/b"]), 0);
        assert_eq!(common_folder(&["alone/here"]), 6);
    }
}
