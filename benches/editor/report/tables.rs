//! The tables, one for each subject.

use dragonfly_kit::figures::{GOAL, RecordedResults, Results, digits, filled, grouped, header, line};

/// Models of the frame's table, as in the results and in words.
const MODELS: [(&str, &str); 4] = [
    ("200 bones", "200 bones"),
    ("2000 bones", "2,000 bones"),
    ("20000 bones", "20,000 bones"),
    ("1000 meshes", "1,000 meshes"),
];

/// Actions of the user while a frame is measured.
const ACTIONS: [&str; 6] =
    ["orbiting", "playing", "hovering", "scrolling the skeleton", "dragging a bone", "dragging all bones"];

/// Returns all tables with their names, in no order.
pub(super) fn all(recorded: &RecordedResults) -> Result<Vec<(&'static str, String)>, String> {
    let [drags, timeline, frame, edits, save, convert] =
        ["drag", "timeline", "frame", "edits", "save", "convert"].map(|name| recorded.of(name));
    Ok(vec![
        ("run", run(recorded)),
        ("drag", drag(drags)?),
        ("timeline", panels(timeline)?),
        ("key-drag", key_drag(timeline)?),
        ("frame", frames(frame)?),
        ("frame-memory", memory(frame)?),
        ("rig-edits", rig(edits)?),
        ("large-edits", large(edits)?),
        ("save", saves(save)?),
        ("save-layer", layer_saves(save)?),
        ("convert", conversions(convert)?),
    ])
}

/// Returns what the results depend on, as a list.
fn run(recorded: &RecordedResults) -> String {
    let mut text = String::new();
    for (name, results) in recorded.files() {
        text += &format!(
            "- `results/{name}.csv`: `{}`, commit {}; priority {}; other programs used {} cores on average.\n",
            results.about("command"),
            results.about("commit"),
            results.about("priority"),
            digits(results.others()),
        );
    }
    let mut machines: Vec<String> = Vec::new();
    for (_, results) in recorded.files() {
        let about = |name| results.about(name);
        let machine = format!("- {}, {}; {}.\n", about("machine"), about("system"), about("rust"));
        if !machines.contains(&machine) {
            machines.push(machine);
        }
    }
    text + &machines.concat()
}

/// Formats milliseconds with their unit: `3.21 µs`, `79.0 ms`, `3.10 s`.
fn time(milliseconds: f64) -> String {
    match milliseconds {
        short if short < 0.1 => format!("{} µs", digits(short * 1e3)),
        long if long >= 1e3 => format!("{} s", digits(long / 1e3)),
        _ => format!("{} ms", digits(milliseconds)),
    }
}

/// Returns metrics of a case as cells; `None` if the case was not recorded.
fn times<const N: usize>(
    results: &Results,
    task: &str,
    variant: &str,
    metrics: [&str; N],
) -> Option<Vec<String>> {
    metrics.iter().map(|metric| results.value(task, variant, metric).map(time)).collect()
}

/// Returns the median and the 99th percentile of a case in one cell.
fn pair(results: &Results, task: &str, variant: &str) -> Option<String> {
    times(results, task, variant, ["median", "p99"]).map(|cells| cells.join(" · "))
}

/// Returns a cell that shows that nothing was measured.
fn none() -> String {
    "–".to_owned()
}

fn drag(results: &Results) -> Result<String, String> {
    let mut table = header(&["model", "median", "99 %", "worst", "99 %, at most", "moves"]);
    for (task, words) in [
        ("fox", "Fox, 25 bones"),
        ("thousand_bones", "a tree of 1,000 bones"),
        ("whole_take_30", "10 minutes of 100 bones, 30 keys per second, in the whole take"),
        ("whole_take_120", "10 minutes of 100 bones, 120 keys per second, in the whole take"),
        ("layer_30", "10 minutes of 100 bones, 30 keys per second, in a layer with three keys"),
        ("layer_120", "10 minutes of 100 bones, 120 keys per second, in a layer with three keys"),
        ("push_30", "the slider “Push, pull” over 18,001 keys of a bone"),
        ("smooth_30", "the slider “Smooth” over 18,001 keys of a bone"),
    ] {
        let limit = format!("{GOAL}p99");
        let Some(cells) = times(results, task, "move", ["median", "p99", "worst", &limit]) else { continue };
        let moves = results.value(task, "move", "samples").map_or_else(none, grouped);
        table += &line(&[vec![words.to_owned()], cells, vec![moves]].concat());
    }
    filled("drag", table)
}

fn panels(results: &Results) -> Result<String, String> {
    let selections = ["nothing selected", "one bone", "eight bones"];
    let mut table = header(&[&["what"], &selections[..]].concat());
    for task in ["whole take", "zooming", "panning", "playing"] {
        let cells: Option<Vec<String>> =
            selections.iter().map(|selection| pair(results, task, selection)).collect();
        if let Some(cells) = cells {
            table += &line(&[vec![task.to_owned()], cells].concat());
        }
    }
    filled("timeline", table)
}

fn key_drag(results: &Results) -> Result<String, String> {
    let mut table =
        header(&["zoom", "keys", "a frame: median", "99 %", "worst", "a view received: median", "worst"]);
    for zoom in ["the take", "a sixtieth of the take"] {
        let frame = times(results, "dragging", zoom, ["median", "p99", "worst"]);
        let view = times(results, "receiving a view", zoom, ["median", "worst"]);
        let (Some(frame), Some(view)) = (frame, view) else { continue };
        let keys = results.value("dragging", zoom, "keys").map_or_else(none, grouped);
        table += &line(&[vec![zoom.to_owned(), keys], frame, view].concat());
    }
    filled("key-drag", table)
}

/// Returns a table with a row for each part of each model, and a column for each action.
fn by_action(
    name: &str,
    parts: &[&str],
    cell: impl Fn(&str, &str) -> Option<String>,
) -> Result<String, String> {
    let mut table = header(&[&["thread, model"], &ACTIONS[..]].concat());
    for part in parts {
        for (model, words) in MODELS {
            let cells: Vec<Option<String>> =
                ACTIONS.iter().map(|action| cell(&format!("{model}/{action}"), part)).collect();
            if cells.iter().all(Option::is_none) {
                continue;
            }
            let cells = cells.into_iter().map(|cell| cell.unwrap_or_else(none)).collect();
            table += &line(&[vec![format!("{part}, {words}")], cells].concat());
        }
    }
    filled(name, table)
}

fn frames(results: &Results) -> Result<String, String> {
    by_action("frame", &["main", "document", "graphics", "driver"], |task, part| {
        results.value(task, part, "median").map(time)
    })
}

fn memory(results: &Results) -> Result<String, String> {
    by_action("frame-memory", &["main", "graphics"], |task, part| {
        let bytes = results.value(task, part, "allocated")?;
        Some(format!("{} KB", digits(bytes / 1e3)))
    })
}

fn rig(results: &Results) -> Result<String, String> {
    let columns = ["move", "ripple", "duplicate", "scale"];
    let mut table = header(&["keys", "moved", "time inserted before", "duplicated", "scaled"]);
    for (task, words) in [
        ("rig/20100 keys of 67 bones", "20,100 of 67 bones"),
        ("rig/60300 keys of 67 bones", "60,300 of 67 bones"),
        ("rig/100200 keys of 167 bones", "100,200 of 167 bones"),
    ] {
        let cells: Option<Vec<String>> =
            columns.iter().map(|edit| results.value(task, edit, "median").map(time)).collect();
        if let Some(cells) = cells {
            table += &line(&[vec![words.to_owned()], cells].concat());
        }
    }
    filled("rig-edits", table)
}

fn large(results: &Results) -> Result<String, String> {
    let mut table = header(&["what", "keys", "median", "worst"]);
    for (task, words) in [
        ("drag_100_000_keys", "100,000 keys dragged"),
        ("move_100_000_keys_among_others", "100,000 keys moved between other keys"),
        ("drag_a_pose", "one pose of a drag"),
        ("start_the_history", "making the history of the take"),
        ("open", "opening a model"),
    ] {
        for variant in results.variants(task) {
            let Some(cells) = times(results, task, variant, ["median", "worst"]) else { continue };
            table += &line(&[vec![words.to_owned(), variant.to_owned()], cells].concat());
        }
    }
    filled("large-edits", table)
}

fn saves(results: &Results) -> Result<String, String> {
    let size = results.value("file", "", "size").ok_or("the size of the file was not recorded")?;
    let save = format!("the save of {} MB", digits(size / 1e6));
    let mut table = header(&["edits", &save, "median", "99 %", "worst", "edits answered"]);
    for variant in ["without a save", "first save", "second save"] {
        let Some(cells) = times(results, "edit", variant, ["median", "p99", "worst"]) else { continue };
        let took = results.value("save", variant, "time").map_or_else(none, time);
        let count = results.value("edit", variant, "samples").map_or_else(none, grouped);
        let words = variant
            .replace("first save", "during the first save")
            .replace("second save", "during the second save");
        table += &line(&[vec![words, took], cells, vec![count]].concat());
    }
    filled("save", table)
}

fn layer_saves(results: &Results) -> Result<String, String> {
    let mut table = header(&["three keys of a bone", "median", "worst"]);
    for variant in results.variants("three keys") {
        let Some(cells) = times(results, "three keys", variant, ["median", "worst"]) else { continue };
        table += &line(&[vec![variant.to_owned()], cells].concat());
    }
    filled("save-layer", table)
}

fn conversions(results: &Results) -> Result<String, String> {
    let mut table = header(&["files", "time", "of the cores in use", "at least"]);
    let percent = |idle: f64| format!("{:.0} %", (1.0 - idle) * 100.0);
    for variant in results.variants("clips") {
        let value = |metric: &str| results.value("clips", variant, metric);
        let Some(took) = value("time").map(time) else { continue };
        let goal = value(&format!("{GOAL}idle")).map_or_else(none, percent);
        let used = value("idle").map_or_else(none, percent);
        table += &line(&[variant.to_owned(), took, used, goal]);
    }
    filled("convert", table)
}
