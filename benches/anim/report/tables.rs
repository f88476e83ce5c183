//! The tables, one for each subject.

use dragonfly_kit::figures::{GOAL, RecordedResults, Results, digits, filled, grouped, header, line};

/// Tasks on the bench rig, in words, in the order of the tables; the unit is that of one row of the results.
const TASKS: [(&str, &str); 28] = [
    ("sample/pab/walk/forward", "sample the short take, forward"),
    ("sample/pab/walk/random", "sample the short take, random times"),
    ("sample/pab/atlas/forward", "sample the long take, forward"),
    ("sample/pab/atlas/backward", "sample the long take, backward"),
    ("sample/pab/atlas/random", "sample the long take, random times"),
    ("to_root/pab", "to-root matrices"),
    ("final/pab", "final matrices"),
    ("blend/pab/2/whole", "blend 2 poses"),
    ("blend/pab/4/whole", "blend 4 poses"),
    ("blend/pab/2/masked", "blend 2 poses with masks"),
    ("blend/pab/4/masked", "blend 4 poses with masks"),
    ("additive/pab/whole", "add a difference, weight 1"),
    ("additive/pab/part", "add a difference, weight 0.6"),
    ("two_bone/pab", "two-bone IK"),
    ("skin/pab/1", "skin vertices, 1 influence"),
    ("skin/pab/2", "skin vertices, 2 influences"),
    ("skin/pab/4", "skin vertices, 4 influences"),
    ("skin_by_matrix/pab/1", "skin vertices by the matrix, 1 influence"),
    ("skin_by_matrix/pab/2", "skin vertices by the matrix, 2 influences"),
    ("skin_by_matrix/pab/4", "skin vertices by the matrix, 4 influences"),
    ("pipeline/pab/1", "one character"),
    ("pipeline/pab/1_of_2_takes", "one character, two takes"),
    ("pipeline/pab/100", "crowd of 100"),
    ("pipeline/pab/1000", "crowd of 1,000"),
    ("hit/pab/ray", "nearest hit of a ray"),
    ("hit/pab/new_pose_and_ray", "a new pose, then a ray"),
    ("hit/pab/nearest", "nearest point of the surface"),
    ("hit/pab/bounds", "bounds of a pose"),
];

fn in_words(task: &str) -> &str {
    let task = task.replace("/fox/", "/pab/");
    TASKS.iter().find(|(name, _)| *name == task).map_or("", |(_, words)| words)
}

/// Returns all tables with their names, in no order.
pub(super) fn all(recorded: &RecordedResults) -> Result<Vec<(&'static str, String)>, String> {
    let [times, sizes, instructions] = ["times", "sizes", "instructions"].map(|name| recorded.of(name));
    Ok(vec![
        ("run", run(recorded)),
        ("sampling", compared(times, "/compressed", ["ozz", "ACL"], "sample/")?),
        ("every-key", compared(times, "", ["ozz/every_key"], "")?),
        ("steps", compared(times, "", ["ozz", "ACL"], "")?),
        ("characters", compared(times, "/compressed", ["ozz", "ACL"], "pipeline/")?),
        ("paths", paths(times)?),
        ("goals", goals(times)?),
        ("instructions", counted(instructions)?),
        ("sizes-fine", size_table(sizes, "0.1 mm at 3 cm")?),
        ("sizes-coarse", size_table(sizes, "1 mm at 10 cm")?),
        ("hits", hits(times)?),
    ])
}

/// Returns what the results depend on, as a list.
fn run(recorded: &RecordedResults) -> String {
    let [times, sizes, instructions] = ["times", "sizes", "instructions"].map(|name| recorded.of(name));
    let mut text = String::new();
    for (what, results) in [("Times", times), ("Sizes", sizes), ("Instructions", instructions)] {
        text += &format!("- {what}: `{}`, commit {}.\n", results.about("command"), results.about("commit"));
    }
    text += &format!("- Machine: {}, {}.\n", times.about("machine"), times.about("system"));
    text += &format!("- Background load: up to {} cores.\n", digits(times.others()));
    text += &format!(
        "- This library: {}; SIMD level {}, instructions counted at level {}.\n",
        times.about("rust"),
        times.about("level"),
        instructions.about("level"),
    );
    text += &format!("- Rivals: {}; {}.\n", times.about("rivals"), times.about("rivals built with"));
    text
}

/// Returns the median and the 99th percentile of a variant, in nanoseconds.
fn time(results: &Results, task: &str, variant: &str) -> Option<String> {
    let value = |metric| results.value(task, variant, metric);
    Some(format!("{} · {}", digits(value("median")?), digits(value("p99")?)))
}

/// Returns a table of the tasks that this library and one of `rivals` do, whose names start with `prefix`.
///
/// `form` is the end of this library's variant: `/compressed`, or nothing. Without a prefix, tasks that are also done with
/// compressed takes are shown for takes with every key only.
fn compared(
    results: &Results,
    form: &str,
    rivals: impl AsRef<[&'static str]>,
    prefix: &str,
) -> Result<String, String> {
    let (ours, rivals) = (format!("{}{form}", results.about("level")), rivals.as_ref());
    let names = rivals.iter().map(|rival| rival.split('/').next().unwrap_or_default());
    let columns: Vec<String> = ["work".to_owned(), "ours".to_owned()]
        .into_iter()
        .chain(names.clone().map(str::to_owned))
        .chain(names.map(|name| format!("{name} ÷ ours")))
        .collect();
    let mut table = header(&columns.iter().map(String::as_str).collect::<Vec<_>>());
    let has_takes = |task: &str| task.starts_with("sample/") || task.starts_with("pipeline/");
    let every_key = rivals.iter().any(|rival| rival.ends_with("every_key"));
    for (task, words) in TASKS {
        let shown = if prefix.is_empty() { has_takes(task) == every_key } else { task.starts_with(prefix) };
        let theirs: Vec<Option<String>> = rivals.iter().map(|rival| time(results, task, rival)).collect();
        let Some(own) = time(results, task, &ours).filter(|_| shown && theirs.iter().any(Option::is_some))
        else {
            continue;
        };
        let ratio = |rival: &&str| {
            let ratio = results.value(task, rival, "ratio to ours");
            ratio.map_or(String::new(), |ratio| format!("{} ×", digits(ratio)))
        };
        let unit = unit_of(results, task);
        let mut cells = vec![format!("{words}, per {unit}"), own];
        cells.extend(theirs.into_iter().map(Option::unwrap_or_default));
        cells.extend(rivals.iter().map(ratio));
        table += &line(&cells);
    }
    filled(&format!("of {rivals:?} {prefix}"), table)
}

/// Returns the unit of a task: `bone`, `character`.
fn unit_of(results: &Results, task: &str) -> String {
    let row = results.rows.iter().find(|row| row.task == task);
    row.and_then(|row| row.unit.split_once('/')).map_or(String::new(), |(_, unit)| unit.to_owned())
}

/// Returns the table of the open path and the fast path, with every key.
fn paths(results: &Results) -> Result<String, String> {
    let level = results.about("level");
    let mut table = header(&["work", "open path", "fast path", "open ÷ fast"]);
    for (task, words) in TASKS {
        let (Some(open), Some(fast)) = (time(results, task, "open"), time(results, task, level)) else {
            continue;
        };
        let ratio = results.value(task, "open", "ratio to ours").unwrap_or(f64::NAN);
        let cells =
            [format!("{words}, per {}", unit_of(results, task)), open, fast, format!("{} ×", digits(ratio))];
        table += &line(&cells);
    }
    filled("paths", table)
}

/// Returns the table of the goals in time.
fn goals(results: &Results) -> Result<String, String> {
    let mut table = header(&["work", "takes", "compared with", "ratio", "goal, at most", "reached"]);
    for row in &results.rows {
        let Some(metric) = row.metric.strip_prefix(GOAL) else { continue };
        let Some(ratio) = results.value(&row.task, &row.variant, metric) else { continue };
        let form = match (row.variant.ends_with("/compressed"), row.task.starts_with("sample/")) {
            (true, _) => "compressed",
            (false, true) => "every key",
            (false, false) if row.task.starts_with("pipeline/") => "every key",
            (false, false) => "",
        };
        let reached = if ratio <= row.value { "yes" } else { "no" };
        table += &line(&[
            in_words(&row.task).to_owned(),
            form.to_owned(),
            metric.trim_start_matches("ratio to ").to_owned(),
            digits(ratio),
            digits(row.value),
            reached.to_owned(),
        ]);
    }
    filled("goals", table)
}

/// Returns the table of instructions per unit.
fn counted(results: &Results) -> Result<String, String> {
    let level = results.about("level");
    let mut table = header(&["work", "takes", "ours", "goal, at most", "sketch", "ozz", "ACL"]);
    for (task, words) in TASKS {
        for (form, variant, rivals) in [
            ("compressed", format!("{level}/compressed"), ["sketch", "ozz", "ACL"]),
            ("every key", level.to_owned(), ["", "ozz/every_key", ""]),
            ("", level.to_owned(), ["sketch", "ozz", "ACL"]),
        ] {
            let has_takes = results.value(task, &format!("{level}/compressed"), "instructions").is_some();
            let Some(ours) = results.value(task, &variant, "instructions") else { continue };
            if has_takes == form.is_empty() {
                continue;
            }
            let cell = |value: Option<f64>| value.map_or(String::new(), digits);
            let goal = results.value(task, &variant, "goal: instructions");
            let mut cells = vec![
                format!("{words}, per {}", unit_of(results, task)),
                form.to_owned(),
                digits(ours),
                cell(goal),
            ];
            cells.extend(rivals.map(|rival| cell(results.value(task, rival, "instructions"))));
            table += &line(&cells);
        }
    }
    filled("instructions", table)
}

/// Returns the table of sizes and errors for one setting.
fn size_table(results: &Results, setting: &str) -> Result<String, String> {
    let columns =
        ["take", "raw bytes", "ours: bytes · error", "in memory", "ACL: bytes · error", "ozz: bytes · error"];
    let mut table = header(&columns);
    for take in ["walk", "jog", "run", "atlas"] {
        let task = format!("size/{take}/{setting}");
        let bytes =
            |codec: &str, metric: &str| results.value(&task, codec, metric).map_or(String::new(), grouped);
        let both = |codec: &str| {
            let error = results.value(&task, codec, "error");
            error.map_or(String::new(), |error| format!("{} · {error:.3} mm", bytes(codec, "bytes")))
        };
        table += &line(&[
            take.to_owned(),
            bytes("raw", "bytes"),
            both("ours"),
            bytes("ours", "in memory"),
            both("ACL"),
            both("ozz"),
        ]);
    }
    filled("sizes", table)
}

/// Returns the table of hits and bounds: every triangle or vertex, and the tree or the boxes of bones.
fn hits(results: &Results) -> Result<String, String> {
    let mut table = header(&["work", "model", "every triangle or vertex", "tree or boxes", "ratio"]);
    for (task, words) in TASKS.iter().filter(|(task, _)| task.starts_with("hit/")) {
        for model in ["pab", "fox"] {
            let task = task.replace("/pab/", &format!("/{model}/"));
            let fast = if task.ends_with("bounds") { "boxes" } else { "tree" };
            let (Some(all), Some(own)) = (time(results, &task, "open"), time(results, &task, fast)) else {
                continue;
            };
            let ratio = results.value(&task, "open", "ratio to ours").unwrap_or(f64::NAN);
            let model = if model == "pab" { "bench rig" } else { "fox" };
            table +=
                &line(&[(*words).to_owned(), model.to_owned(), all, own, format!("{} ×", digits(ratio))]);
        }
    }
    filled("hits", table)
}
