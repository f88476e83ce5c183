//! How lines and paths look in the viewport.

use super::line_editing::line_name;
use dragonfly_anim::stage::line::DrawnLines;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{StagePath, StagePlan};
use dragonfly_picture::LineLook;
use dragonfly_picture::gizmo::LineInk;
use glam::Vec3;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::sync::Arc;

/// Colors of paths, and of the selected path.
const PATH: [u8; 3] = [46, 180, 150];
const SELECTED: [u8; 3] = [240, 150, 40];

/// Width of paths, and what a selected line is wider, points.
const WIDTH: f32 = 2.5;
const WIDER: f32 = 2.0;

/// Distance from one arrow to the next, and from one point to the next, meters.
const ARROWS: f64 = 0.5;
const STEP: f64 = 0.05;

/// Largest number of points, arrows or ticks of a path, and of points of all paths.
const MOST: usize = 2_000;
const MOST_POINTS: usize = 1_000_000;

/// Time in which the direction at a tick is measured, seconds.
const MOMENT: f64 = 0.05;

/// Returns the lines of a project as they are drawn, without the hidden ones. The selected one is wider.
pub(super) fn line_looks(
    lines: &DrawnLines,
    is_hidden: impl Fn(&str) -> bool,
    selected: Option<&str>,
) -> Vec<LineLook> {
    let named = lines.list().iter().enumerate().map(|(index, line)| (line_name(index, line), line));
    let seen = named.filter(|(name, _)| !is_hidden(name));
    let wider = |name: &str| if selected == Some(name) { WIDER } else { 0.0 };
    seen.map(|(name, line)| LineLook::of_line(line, wider(&name))).collect()
}

/// Returns the paths of a scene as they are drawn, without the hidden ones: arrows each half a meter, and a tick at each second of those that follow it.
pub(super) fn path_looks(
    script: &StageScript,
    plan: &StagePlan,
    selected: &[Box<str>],
    hidden: &BTreeSet<Box<str>>,
) -> Vec<LineLook> {
    let selected: HashSet<&str> = selected.iter().map(|id| &**id).collect();
    let seen = || plan.things().iter().filter(|thing| !hidden.contains(&thing.id));
    let paths = || seen().filter_map(|thing| Some((thing, thing.path.as_ref()?)));
    let most = (MOST_POINTS / paths().count().max(1)).clamp(2, MOST);
    let followers = followers(script, plan);
    paths()
        .map(|(thing, path)| {
            let is_selected = selected.contains(&*thing.id);
            LineLook {
                points: along(path, STEP, most).iter().map(|[at, _]| *at).collect(),
                ink: LineInk::new(if is_selected { SELECTED } else { PATH }, WIDTH),
                opacity: if is_selected { 1.0 } else { 0.8 },
                shown: [None; 2],
                of: None,
                arrows: along(path, ARROWS, most).into_iter().skip(1).collect(),
                ticks: followers.get(&*thing.id).map_or_else(Arc::default, |own| ticks(plan, own, most)),
            }
        })
        .collect()
}

/// Returns places and directions on a path at about this distance from each other, its ends among them.
fn along(path: &StagePath, step: f64, most: usize) -> Vec<[Vec3; 2]> {
    let count = ((path.length() / step).round().max(1.0) as usize).min(most);
    let at = |place: usize| path.at(path.length() * place as f64 / count as f64);
    (0..=count).map(at).map(|spot| [spot.position.as_vec3(), spot.direction.as_vec3()]).collect()
}

/// A thing that follows a path, and the times from which and to which it does.
struct Follower {
    thing: usize,
    times: [StageTime; 2],
}

/// Returns those that follow each path, by the id of the path.
fn followers<'a>(script: &'a StageScript, plan: &StagePlan) -> HashMap<&'a str, Vec<Follower>> {
    let mut found: HashMap<&str, Vec<Follower>> = HashMap::new();
    for (action, times) in plan.schedule().times().iter().enumerate() {
        let element = script.element(action);
        if element.row.name != "move" {
            continue;
        }
        let Some(path) = element.value("path") else { continue };
        if let Some(thing) = element.value("who").and_then(|who| plan.thing_called(who)) {
            found.entry(path).or_default().push(Follower { thing, times: [times.begin, times.end] });
        }
    }
    found
}

/// Returns where those that follow a path are at each whole second since they began, and where they go.
fn ticks(plan: &StagePlan, followers: &[Follower], most: usize) -> Arc<[[Vec3; 2]]> {
    let of_one = |follower: &Follower| {
        let ([begin, end], thing) = (follower.times, follower.thing);
        let seconds = ((end - begin).seconds().floor().max(0.0) as usize).min(most);
        (1..=seconds).filter_map(move |second| {
            let time = begin + StageTime::from_seconds(second as f64);
            let place = |time| plan.placement(thing, time).map(|place| place.position);
            let (from, at) = (place(time - StageTime::from_seconds(MOMENT))?, place(time)?);
            Some([at.as_vec3(), (at - from).normalize_or_zero().as_vec3()])
        })
    };
    followers.iter().flat_map(of_one).take(most).collect()
}
