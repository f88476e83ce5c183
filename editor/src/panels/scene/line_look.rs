//! How lines and paths look in the viewport.

use super::line_editing::{MarkedThings, line_name};
use dragonfly_anim::stage::line::DrawnLines;
use dragonfly_anim::stage::script::StageScript;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{PathWalk, StagePath, StagePlan};
use dragonfly_picture::LineLook;
use dragonfly_picture::gizmo::LineInk;
use glam::Vec3;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Colors of paths, and of the selected path.
const PATH: [u8; 3] = [46, 180, 150];
const SELECTED: [u8; 3] = [240, 150, 40];
/// Color of the parts that bend too much for the stride of those that follow.
const TIGHT: [u8; 3] = [230, 40, 40];

/// Least radius of a bend, as a part of the distance of a cycle of the take that follows it.
const LEAST_RADIUS: f64 = 0.3;

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

/// Returns the lines of a project as they are drawn, without the hidden ones. The selected ones are wider.
pub(super) fn line_looks(
    lines: &DrawnLines,
    is_hidden: impl Fn(&str) -> bool,
    is_selected: impl Fn(&str) -> bool,
) -> Vec<LineLook> {
    let named = lines.list().iter().enumerate().map(|(index, line)| (line_name(index, line), line));
    let seen = named.filter(|(name, _)| !is_hidden(name));
    let wider = |name: &str| if is_selected(name) { WIDER } else { 0.0 };
    seen.map(|(name, line)| LineLook::of_line(line, wider(&name))).collect()
}

/// A path as it is drawn.
#[derive(Clone, Debug)]
pub(super) struct PathDrawing {
    id: Box<str>,
    path: Arc<StagePath>,
    /// Begin and end of each action that follows it.
    times: Vec<[StageTime; 2]>,
    is_selected: bool,
    looks: Vec<LineLook>,
}

impl PathDrawing {
    /// Returns the path as it is drawn, and its parts in red.
    pub(super) fn looks(&self) -> &[LineLook] {
        &self.looks
    }

    fn is_of(&self, path: &Arc<StagePath>, followers: &[Follower], is_selected: bool) -> bool {
        self.is_selected == is_selected
            && self.path == *path
            && self.times.iter().eq(followers.iter().map(|follower| &follower.times))
    }
}

/// Returns the paths of a scene as they are drawn, without the hidden ones: arrows each half a meter, a tick at each second of those that follow
/// it, a dot where a foot of theirs lands, and in red the parts that bend too much for their stride. A path of `before` stays as it was drawn there if
/// its points are the same and those that follow it do it at the same times: nearly always it looks the same.
pub(super) fn path_drawings(
    script: &StageScript,
    plan: &StagePlan,
    things: MarkedThings<'_>,
    before: Vec<PathDrawing>,
) -> Vec<PathDrawing> {
    let selected: HashSet<&str> = things.selected.iter().map(|id| &**id).collect();
    let mut before: HashMap<Box<str>, PathDrawing> =
        before.into_iter().map(|drawing| (drawing.id.clone(), drawing)).collect();
    let seen = || plan.things().iter().filter(|thing| !things.hidden.contains(&thing.id));
    let paths = || seen().filter_map(|thing| Some((&*thing.id, thing.path.as_ref()?)));
    let most = (MOST_POINTS / paths().count().max(1)).clamp(2, MOST);
    let all_followers = Follower::all(script, plan);
    let drawing = |(id, path): (&str, &Arc<StagePath>)| {
        let is_selected = selected.contains(id);
        let followers = all_followers.get(id).map_or(&[][..], Vec::as_slice);
        let old = before.remove(id).filter(|old| old.is_of(path, followers, is_selected));
        old.unwrap_or_else(|| PathDrawing {
            id: id.into(),
            path: Arc::clone(path),
            times: followers.iter().map(|follower| follower.times).collect(),
            is_selected,
            looks: looks_of(plan, path, followers, is_selected, most),
        })
    };
    paths().map(drawing).collect()
}

fn looks_of(
    plan: &StagePlan,
    path: &StagePath,
    followers: &[Follower],
    is_selected: bool,
    most: usize,
) -> Vec<LineLook> {
    let whole = LineLook {
        points: along(path, STEP, most).iter().map(|[at, _]| *at).collect(),
        ink: LineInk::new(if is_selected { SELECTED } else { PATH }, WIDTH),
        opacity: if is_selected { 1.0 } else { 0.8 },
        shown: [None; 2],
        of: None,
        arrows: along(path, ARROWS, most).into_iter().skip(1).collect(),
        ticks: followers.iter().flat_map(|follower| follower.ticks(plan, most)).take(most).collect(),
        dots: followers.iter().flat_map(|follower| follower.feet(plan)).take(most).collect(),
    };
    let strides = followers.iter().filter_map(|own| plan.stride_of(own.walk?));
    let least = LEAST_RADIUS * strides.fold(0.0, f64::max);
    let red = |points: Vec<Vec3>| LineLook {
        points: points.into(),
        ink: LineInk::new(TIGHT, WIDTH + 1.5),
        opacity: 1.0,
        arrows: Arc::default(),
        ticks: Arc::default(),
        dots: Arc::default(),
        ..whole.clone()
    };
    let tight: Vec<LineLook> = tight_parts(path, least, most).into_iter().map(red).collect();
    std::iter::once(whole).chain(tight).collect()
}

/// Returns the parts of a path whose radius is below `least` meters, measured over half of that.
fn tight_parts(path: &StagePath, least: f64, most: usize) -> Vec<Vec<Vec3>> {
    if least <= 0.0 {
        return Vec::new();
    }
    let mut parts: Vec<Vec<Vec3>> = Vec::new();
    let count = ((path.length() / STEP).round().max(1.0) as usize).min(most);
    let mut was_tight = false;
    for place in 0..=count {
        let distance = path.length() * place as f64 / count as f64;
        let is_tight = path.radius(distance, 0.5 * least) < least;
        if is_tight && !was_tight {
            // From the place before, so that a bend between two places is seen, too.
            let before = path.length() * place.saturating_sub(1) as f64 / count as f64;
            parts.push(vec![path.at(before).position.as_vec3()]);
        }
        if let Some(part) = parts.last_mut().filter(|_| is_tight || was_tight) {
            part.push(path.at(distance).position.as_vec3());
        }
        was_tight = is_tight;
    }
    parts
}

/// Returns places and directions on a path at about this distance from each other, its ends among them.
fn along(path: &StagePath, step: f64, most: usize) -> Vec<[Vec3; 2]> {
    let count = ((path.length() / step).round().max(1.0) as usize).min(most);
    let at = |place: usize| path.at(path.length() * place as f64 / count as f64);
    (0..=count).map(at).map(|spot| [spot.position.as_vec3(), spot.direction.as_vec3()]).collect()
}

/// An action that follows a path.
struct Follower {
    thing: usize,
    /// Its place in the plan, if it decides over where the thing is.
    walk: Option<PathWalk>,
    /// Its begin and its end.
    times: [StageTime; 2],
}

impl Follower {
    /// Returns the actions that follow each path, by the id of the path.
    fn all<'a>(script: &'a StageScript, plan: &StagePlan) -> HashMap<&'a str, Vec<Self>> {
        let walks: HashMap<usize, PathWalk> = plan.path_walks().map(|walk| (walk.action, walk)).collect();
        let mut found: HashMap<&str, Vec<Self>> = HashMap::new();
        for (action, times) in plan.schedule().times().iter().enumerate() {
            let element = script.element(action);
            if element.row.name != "move" {
                continue;
            }
            let Some(path) = element.value("path") else { continue };
            if let Some(thing) = element.value("who").and_then(|who| plan.thing_called(who)) {
                let (walk, times) = (walks.get(&action).copied(), [times.begin, times.end]);
                found.entry(path).or_default().push(Self { thing, walk, times });
            }
        }
        found
    }

    /// Returns where the thing is at each whole second since the start, at most at `most`, and in which direction it goes.
    fn ticks(&self, plan: &StagePlan, most: usize) -> impl Iterator<Item = [Vec3; 2]> {
        let ([begin, end], thing) = (self.times, self.thing);
        let seconds = ((end - begin).seconds().floor().max(0.0) as usize).min(most);
        let place = move |time| plan.placement(thing, time).map(|place| place.position);
        (1..=seconds).filter_map(move |second| {
            let time = begin + StageTime::from_seconds(second as f64);
            let (from, at) = (place(time - StageTime::from_seconds(MOMENT))?, place(time)?);
            Some([at.as_vec3(), (at - from).normalize_or_zero().as_vec3()])
        })
    }

    /// Returns where its feet land.
    fn feet(&self, plan: &StagePlan) -> impl Iterator<Item = Vec3> {
        let prints = self.walk.map_or_else(Vec::new, |walk| plan.footprints_of(walk));
        prints.into_iter().map(|print| print.position.as_vec3())
    }
}
