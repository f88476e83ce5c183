//! Tables in Markdown, from summaries.

use crate::amount;
use crate::summary::Summary;
use std::fmt::Write as _;

/// A metric and what its column is called.
pub type Column = (&'static str, &'static str);

/// A row for each variant of each case, a column for each metric that some of them have; the best of the first column
/// first. The last column is what other programs did to the machine meanwhile, at worst.
pub fn wide(all: &[Summary], columns: &[Column]) -> String {
    let in_use = |column: &&Column| all.iter().any(|one| one.metric == column.0);
    let columns: Vec<&Column> = columns.iter().filter(in_use).collect();
    let cases = distinct(all.iter().map(|one| one.case.as_str()));
    let prefix = common_folder(&cases);
    let mut text = String::from(if cases.len() > 1 { "| case | who |" } else { "| who |" });
    for (_, heading) in &columns {
        let _ = write!(text, " {heading} |");
    }
    text += " others |\n";
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
            let mut others = 0.0_f64;
            for (metric, _) in &columns {
                match find(variant, metric) {
                    Some(one) => {
                        others = others.max(one.others);
                        let _ =
                            write!(text, " {} |", amount::spread(one.median, one.low, one.high, &one.unit));
                    }
                    None => text += " – |",
                }
            }
            let _ = writeln!(text, " {others:.2} |");
        }
    }
    text
}

/// A row for everything.
pub fn long(all: &[Summary]) -> String {
    let mut text = String::from(
        "| case | who | what | median [min .. max] | repeats | others |\n|---|---|---|---|---|---|\n",
    );
    for one in all {
        let value = amount::spread(one.median, one.low, one.high, &one.unit);
        let Summary { case, variant, metric, repeats, others, .. } = one;
        let _ = writeln!(text, "| {case} | {variant} | {metric} | {value} | {repeats} | {others:.2} |");
    }
    text
}

/// Each once, in the order of first appearance.
pub fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut found = Vec::new();
    for name in names {
        if !found.contains(&name) {
            found.push(name);
        }
    }
    found
}

/// How much of all names is the folders that they share.
pub fn common_folder(names: &[&str]) -> usize {
    let Some(first) = names.first() else { return 0 };
    let shared = |end: &usize| names.iter().all(|name| name.starts_with(&first[..*end]));
    first.match_indices('/').map(|(slash, _)| slash + 1).filter(shared).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::{summarise, tests::row};

    #[test]
    fn a_table_has_every_variant_the_best_first_and_says_what_is_missing() {
        let all = summarise(&[
            row("queue/trip/a", "slow", 0, "p50", "ns", 20_000.0),
            row("queue/trip/a", "slow", 1, "p50", "ns", 30_000.0),
            row("queue/trip/a", "slow", 2, "p50", "ns", 25_000.0),
            row("queue/trip/a", "fast", 0, "p50", "ns", 900.0),
            row("queue/trip/a", "fast", 0, "allocations", "1/msg", 0.5),
            row("queue/trip/b", "fast", 0, "p50", "ns", 1.0),
        ]);
        let columns = [("p50", "median"), ("allocations", "allocations"), ("p99", "rare")];
        let expected = "\
| case | who | median | allocations | others |
|---|---|---|---|---|
| a | fast | 900 ns | 0.50 a message | 0.00 |
| a | slow | 25.0 [20.0 .. 30.0] µs | – | 0.20 |
| b | fast | 1.00 ns | – | 0.00 |
";
        assert_eq!(wide(&all, &columns), expected);
        assert_eq!(long(&all).lines().count(), 2 + all.len());
    }

    #[test]
    fn names_are_cut_at_folders_only() {
        assert_eq!(common_folder(&["a/b/cc", "a/b/cd"]), 4);
        assert_eq!(common_folder(&["a/b", "ab/b"]), 0);
        assert_eq!(common_folder(&["alone/here"]), 6);
    }
}
