//! Writes what was measured, with the machine, versions and flags that it depends on.

use crate::goals::{self, CheckedGoal};
use crate::measure::CaseTimes;
use crate::report::PAGE;
use crate::rivals::{self, Rivals};
use dragonfly_anim::fast::simd::SimdLevel;
use dragonfly_kit::figures::{Figure, GOAL, Results, description};
use std::fs;
use std::path::Path;

/// Writes times and sizes. A recorded run goes to `benches/anim/results` and into the tables of `anim/README.md`, any
/// other to the target folder.
pub(crate) fn write(
    is_recorded: bool,
    all: &[CaseTimes],
    goals: &[CheckedGoal],
    sizes: Vec<Figure>,
    rivals: Option<&Rivals>,
) -> Result<(), String> {
    let run = run(rivals);
    let mut rows: Vec<Figure> = all.iter().flat_map(|one| times(one, all)).collect();
    rows.extend(goals.iter().flat_map(CheckedGoal::rows));
    for (name, rows) in [("times", rows), ("sizes", sizes)] {
        if rows.is_empty() {
            continue;
        }
        let path =
            if is_recorded { PAGE.file(name) } else { rivals::target()?.join(format!("anim-{name}.csv")) };
        let text = Results { run: run.clone(), rows }.text();
        fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("# {name}: {}", path.display());
    }
    if is_recorded { PAGE.update() } else { Ok(()) }
}

/// Writes the instructions that the script `instructions` counted, and the tables of `anim/README.md`.
///
/// `folder` contains `counts`, with lines "case total units unit", and `rivals`, with "name<tab>total<tab>units".
pub(crate) fn write_instructions(folder: &Path, rivals: Option<&Rivals>) -> Result<(), String> {
    let read = |name: &str| {
        fs::read_to_string(folder.join(name)).map_err(|error| format!("{}/{name}: {error}", folder.display()))
    };
    let per_unit = |total: &str, units: &str| -> Option<f64> {
        Some((total.parse::<f64>().ok()? / units.parse::<f64>().ok()? * 10.0).round() / 10.0)
    };
    let mut rows = Vec::new();
    let goals = goals::instructions();
    for line in read("counts")?.lines() {
        let [case, total, units, unit] = line.split(' ').collect::<Vec<_>>()[..] else {
            return Err(format!("counts: {line}"));
        };
        let value = per_unit(total, units).ok_or_else(|| format!("counts: {line}"))?;
        let (variant, task) = split(case);
        let unit = format!("instructions/{unit}");
        rows.push(Figure::new(task, variant, "instructions", &unit, value));
        if let Some((_, max)) = goals.iter().find(|(goal, _)| goal == case) {
            rows.push(Figure::new(task, variant, &format!("{GOAL}instructions"), &unit, *max));
        }
    }
    for line in read("rivals")?.lines() {
        let [name, total, units] = line.split('\t').collect::<Vec<_>>()[..] else {
            return Err(format!("rivals: {line}"));
        };
        let value = per_unit(total, units).ok_or_else(|| format!("rivals: {line}"))?;
        for (variant, task, unit) in rivals::tasks_of(name) {
            rows.push(Figure::new(task, variant, "instructions", &format!("instructions/{unit}"), value));
        }
    }
    let mut run = run(rivals);
    for (name, value) in &mut run {
        match name.as_str() {
            "command" => *value = format!("{}=FOLDER benches/anim/instructions --record", rivals::FOLDER),
            "level" => goals::counted_level().clone_into(value),
            _ => {}
        }
    }
    let path = PAGE.file("instructions");
    fs::write(&path, Results { run, rows }.text()).map_err(|error| format!("{}: {error}", path.display()))?;
    PAGE.update()
}

/// Splits the name of a case into variant and task.
fn split(case: &str) -> (&str, &str) {
    let variant = case.find('/').unwrap_or(0);
    let form = "/compressed";
    let variant = if case[variant..].starts_with(form) { variant + form.len() } else { variant };
    (&case[..variant], case[variant..].trim_start_matches('/'))
}

/// Returns the rows of one case.
fn times(one: &CaseTimes, all: &[CaseTimes]) -> Vec<Figure> {
    let unit = format!("ns/{}", one.unit);
    let row = |metric, unit: &str, value| {
        let figure = Figure::new(&one.task, &one.variant, metric, unit, value);
        Figure { others: one.others, ..figure }
    };
    let mut rows =
        vec![row("median", &unit, one.median()), row("p99", &unit, one.p99()), row("min", &unit, one.min())];
    if let Some(ours) = ours_of(one, all) {
        rows.push(row("ratio to ours", "ratio", one.ratio(ours)));
    }
    rows
}

/// Returns the case of this library that a rival or the open path is compared with: the same task, at the best SIMD level,
/// with takes of the same form.
fn ours_of<'a>(one: &CaseTimes, all: &'a [CaseTimes]) -> Option<&'a CaseTimes> {
    let level = SimdLevel::best().name();
    let compressed = format!("{level}/compressed");
    let forms: &[&str] = match one.variant.as_str() {
        "ozz" | "ACL" => &[&compressed, level],
        "ozz/every_key" | "open" => &[level, "tree", "boxes"],
        _ => &[],
    };
    let find = |variant: &&str| all.iter().find(|other| other.variant == **variant && other.task == one.task);
    forms.iter().find_map(find)
}

/// Returns names and values of what the results depend on.
fn run(rivals: Option<&Rivals>) -> Vec<(String, String)> {
    let command = format!("{}=FOLDER cargo bench -p dragonfly-anim -- --record", rivals::FOLDER);
    let mut run = description(&command, &PAGE);
    run.push(("level".to_owned(), SimdLevel::best().name().to_owned()));
    run.extend(rivals.map(Rivals::versions).unwrap_or_default());
    run
}
