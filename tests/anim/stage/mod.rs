//! Scripts, their schedules, and scenes at a time.

mod actors;
mod clips;
mod copied_clips;
mod errors;
mod feet;
mod followed_paths;
mod gestures;
mod gestures_in_projects;
mod ground;
mod ground_feet;
mod holding;
mod include_clips;
mod include_gestures;
mod includes;
mod kept_times;
mod lanes;
mod lines;
mod live;
mod many;
mod missing;
mod new_actions;
mod oracle;
mod paths;
mod placing;
mod projects;
mod pure;
mod random_gestures;
mod random_scripts;
mod scenes;
mod schema;
mod shapes;
mod spans;
mod splices;
mod splitting;
mod times;
mod travels;
mod typed;
mod writing;

use dragonfly_anim::stage::schedule::{Schedule, resolve};
use dragonfly_anim::stage::script::{ScriptError, StageScript};
use dragonfly_anim::stage::time::StageTime;

/// The scene of the reference: two rivals at a door.
const DUEL: &str = include_str!("../../data/stage/duel.xml");

/// Returns length and stride speed of a take.
fn take(name: &str) -> (f64, f64) {
    match name {
        "Walk" => (1.0, 1.4),
        "Run" => (0.7, 3.2),
        "PickUp" => (1.4, 0.0),
        "Slash" => (0.9, 0.0),
        "Idle" => (2.0, 0.0),
        "Fall" => (1.5, 0.0),
        other => panic!("no take {other}"),
    }
}

/// Returns the lengths that actions have by themselves, with the takes of [`take`], straight paths, and 4 m for `to`.
fn lengths(script: &StageScript) -> Vec<StageTime> {
    let of = |action: usize| {
        let element = script.element(action);
        let number = |name: &str| element.value(name).and_then(|text| text.parse::<f64>().ok());
        match element.row.name {
            "play" => {
                let (length, _) = take(element.value("take").unwrap());
                let (from, to) = (number("from").unwrap_or(0.0), number("to").unwrap_or(length));
                (to - from) / number("speed").unwrap_or(1.0).abs()
            }
            "move" => {
                // A duration replaces a speed.
                let speed =
                    number("speed").unwrap_or_else(|| element.value("take").map_or(1.0, |name| take(name).1));
                let path = element
                    .value("path")
                    .and_then(|path| script.things().find(|thing| thing.value("id") == Some(path)));
                path.map_or(4.0, |path| path.value("points").map_or(6.0, way)) / speed
            }
            _ => 0.0,
        }
    };
    (0..script.actions().len()).map(|action| StageTime::from_seconds(of(action))).collect()
}

/// Returns the length of the lines through points.
fn way(points: &str) -> f64 {
    let numbers: Vec<f64> = points.split_whitespace().map(|number| number.parse().unwrap()).collect();
    let points: Vec<&[f64]> = numbers.chunks(3).collect();
    points
        .windows(2)
        .map(|pair| pair[0].iter().zip(pair[1]).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt())
        .sum()
}

fn read(text: &str) -> StageScript {
    StageScript::read(text).unwrap_or_else(|errors| panic!("{}", listed(&errors)))
}

fn scheduled(text: &str) -> (StageScript, Schedule) {
    let script = read(text);
    let schedule = resolve(&script, &lengths(&script)).unwrap_or_else(|errors| panic!("{}", listed(&errors)));
    (script, schedule)
}

fn listed(errors: &[ScriptError]) -> String {
    errors.iter().map(|error| error.in_file("scene.xml")).collect::<Vec<_>>().join("\n")
}

/// Returns begin and end in seconds of the action called `id`.
fn span(text: &str, id: &str) -> (f64, f64) {
    let (script, schedule) = scheduled(text);
    let times = schedule.times()[script.action_called(id).unwrap()];
    (times.begin.seconds(), times.end.seconds())
}

/// Wraps actions in a script with a small cast.
fn scene(actions: &str) -> String {
    format!(
        "<script version=\"1\">\n<cast><role id=\"anna\" model=\"a.glb\"/><role id=\"ben\" model=\"b.glb\"/>\
         <camera id=\"wide\"/><camera id=\"close\"/><light id=\"sun\" kind=\"sun\"/><effect id=\"rain\" kind=\"particles\"/>\
         <path id=\"aisle\" points=\"0 0 0  3 0 4\"/><mark id=\"door\"/><prop id=\"sword\" model=\"s.glb\"/></cast>\n{actions}\n</script>"
    )
}
