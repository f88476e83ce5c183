//! The tables, one for each subject.

use dragonfly_kit::figures::{GOAL, RecordedResults, Results, digits, filled, header, line, percentile};
use std::collections::BTreeMap;

/// Share of the size of a model from which a difference is counted.
const NOTICED: f64 = 1e-3;

/// Returns all tables with their names, in no order.
pub(super) fn all(recorded: &RecordedResults) -> Result<Vec<(&'static str, String)>, String> {
    Ok(vec![
        ("round-trips-run", run(recorded.of("round-trips"))),
        ("round-trips", round_trips(recorded.of("round-trips"))?),
        ("speed-run", run(recorded.of("speed"))),
        ("speed", speed(recorded.of("speed"))?),
    ])
}

/// Returns what the results depend on, as a list.
fn run(results: &Results) -> String {
    let mut text = format!("- `{}`, commit {}.\n", results.about("command"), results.about("commit"));
    text +=
        &format!("- {}, {}; {}.\n", results.about("machine"), results.about("system"), results.about("rust"));
    text + &format!("- Background load: up to {} cores.\n", digits(results.others()))
}

/// Returns a row for each pair of formats.
fn round_trips(results: &Results) -> Result<String, String> {
    let columns = [
        "from → to",
        "files",
        "median mm",
        "largest mm",
        "file",
        "largest share of size",
        "files above 0.1 %",
    ];
    let mut table = header(&columns);
    let mut pairs: BTreeMap<&str, Vec<(&str, f64, f64)>> = BTreeMap::new();
    for row in results.rows.iter().filter(|row| row.metric == "largest") {
        let relative = results.value(&row.task, &row.variant, "relative").unwrap_or(f64::NAN);
        pairs.entry(&row.task).or_default().push((&row.variant, row.value, relative));
    }
    for (pair, mut files) in pairs {
        files.sort_by(|a, b| a.1.total_cmp(&b.1));
        let distances: Vec<f64> = files.iter().map(|file| file.1).collect();
        let &(name, largest, _) = files.last().ok_or("a pair without files")?;
        let share = files.iter().map(|file| file.2).fold(0.0, f64::max);
        let noticed = files.iter().filter(|file| file.2 > NOTICED).count();
        table += &line(&[
            pair.replace('/', " → "),
            files.len().to_string(),
            scientific(percentile(&distances, 50)),
            scientific(largest),
            name.to_owned(),
            scientific(share),
            noticed.to_string(),
        ]);
    }
    filled("round-trips", table)
}

fn scientific(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

/// Returns a row for each task and rival, with its goal.
fn speed(results: &Results) -> Result<String, String> {
    let mut table =
        header(&["work", "ours", "compared with", "theirs", "ours ÷ theirs", "goal: at most", "reached"]);
    for goal in results.rows.iter().filter(|row| row.metric.starts_with(GOAL)) {
        let metric = goal.metric.trim_start_matches(GOAL);
        let Some(value) = results.value(&goal.task, &goal.variant, metric) else { continue };
        let rival = metric.trim_start_matches("ratio to ");
        let time = |variant: &str| {
            results
                .value(&goal.task, variant, "median")
                .map_or(String::new(), |time| format!("{} ms", digits(time)))
        };
        let reached = if value <= goal.value { "yes" } else { "no" };
        table += &line(&[
            goal.task.clone(),
            time(&goal.variant),
            rival.to_owned(),
            time(rival),
            format!("{value:.3}"),
            format!("{:.3}", goal.value),
            reached.to_owned(),
        ]);
    }
    filled("speed", table)
}
