//! Motions of things from the actions of a script, and the lengths that follow from them.
//!
//! The length of a `move` to a place follows from the place of the role when it begins, which follows from the times of the motions before.
//! So times and places are computed in turn until they agree. The first guess is where the motion before in the text ends, which is usually
//! right already.

use super::bind::{StageBinder, number};
use super::clock::PlayClock;
use super::follow::{PathFollower, PathHeading, PathStride, WayGround};
use super::placement::facing_of;
use super::places::{MotionKind, PlaceCue, PlaceLane};
use super::spot::StageSpot;
use crate::stage::assets::{UNKNOWN_SPEED, UNKNOWN_TAKE};
use crate::stage::ease::StageEase;
use crate::stage::model::StageModel;
use crate::stage::path::StagePath;
use crate::stage::schedule::{ActionTimes, Schedule, resolve};
use crate::stage::script::{ErrorList, ScriptError, StageRepeat};
use crate::stage::time::{Decimal, StageTime};
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::Arc;

/// An action with what its names mean.
#[derive(Clone, Debug)]
pub(super) struct BoundAction {
    pub(super) who: Option<usize>,
    pub(super) take: Option<(usize, Arc<StageModel>)>,
    /// The target of a way, a look or an attachment.
    pub(super) spot: Option<StageSpot>,
}

/// Number of times that times and places are computed in turn.
const MOST_ROUNDS: usize = 32;

/// Everything that moves, while times and places are computed.
pub(super) struct MotionPlanner<'a, 'b> {
    pub(super) binder: &'b StageBinder<'a>,
    pub(super) bound: &'b [BoundAction],
}

impl MotionPlanner<'_, '_> {
    /// Returns the times of all actions and the places of all things.
    pub(super) fn plan(
        &self,
        errors: &mut ErrorList,
    ) -> Result<(Schedule, Vec<PlaceLane>), Vec<ScriptError>> {
        let mut lengths = self.guessed(errors);
        if !errors.is_empty() {
            return Ok(Default::default());
        }
        let mut first = None;
        for _ in 0..MOST_ROUNDS {
            let schedule = resolve(self.binder.script, &lengths)?;
            let (lanes, found) = self.places(&schedule);
            let mut changed =
                found.into_iter().filter(|&(action, length)| lengths[action] != length).peekable();
            first = changed.peek().map(|&(action, _)| action);
            if first.is_none() {
                return Ok((schedule, lanes));
            }
            let changed: Vec<(usize, StageTime)> = changed.collect();
            for (action, length) in changed {
                lengths[action] = length;
            }
        }
        if let Some(action) = first {
            let name = self.binder.script.element(action).name.clone();
            errors.add(
                name,
                "where this way starts depends on how long it takes",
                "give it a `dur`, or a `path`",
            );
        }
        Ok(Default::default())
    }

    /// Returns the lengths of all actions, with guesses for ways to a place.
    fn guessed(&self, errors: &mut ErrorList) -> Vec<StageTime> {
        let mut last: Vec<DVec3> =
            self.binder.things.iter().map(|thing| thing.places.base.position).collect();
        let mut lengths = Vec::with_capacity(self.bound.len());
        for (action, bound) in self.bound.iter().enumerate() {
            let element = self.binder.script.element(action);
            let length = match element.row.name {
                "play" => self.play_length(action),
                "move" => {
                    let start = bound.who.and_then(|who| last.get(who)).copied().unwrap_or(DVec3::ZERO);
                    let path =
                        self.path(action, start, |thing| self.binder.things[thing].places.base.position);
                    if let (Some(who), Some(path)) = (bound.who, &path) {
                        last[who] = path.at(f64::INFINITY).position;
                    }
                    let once = path.as_ref().and_then(|path| self.once(action, path));
                    let is_timed = element.attribute("dur").is_some() || element.attribute("end").is_some();
                    if path.is_some() && once.is_none() && !is_timed {
                        let message = match element.value("take") {
                            Some(take) => format!(
                                "the take \"{take}\" has no stride: its feet do not walk, and it does not travel"
                            ),
                            None => "nothing says how long this way takes".to_owned(),
                        };
                        errors.add(
                            element.name.clone(),
                            message,
                            "give it a `speed`, a `dur`, or a take that walks",
                        );
                    }
                    once.unwrap_or_default()
                }
                "place" => {
                    let spot = bound
                        .spot
                        .map(|spot| self.still(spot, |thing| self.binder.things[thing].places.base.position));
                    if let (Some(who), Some(position)) = (bound.who, spot) {
                        last[who] = position;
                    }
                    StageTime::ZERO
                }
                _ => StageTime::ZERO,
            };
            lengths.push(length);
        }
        lengths
    }

    /// Returns the position of a spot; bones count as their things.
    fn still(&self, spot: StageSpot, position: impl Fn(usize) -> DVec3) -> DVec3 {
        match spot {
            StageSpot::Point(point) => point,
            StageSpot::Thing(thing) | StageSpot::Bone(thing, _) => position(thing),
        }
    }

    /// Returns the path of a `move` that starts at `start`.
    fn path(&self, action: usize, start: DVec3, position: impl Fn(usize) -> DVec3) -> Option<Arc<StagePath>> {
        let element = self.binder.script.element(action);
        if let Some(path) = element.value("path") {
            let thing = self.binder.script.thing_called(path)?;
            return self.binder.things.get(thing)?.path.clone();
        }
        let target = self.still(self.bound[action].spot?, position);
        let way = target - start;
        let length = way.length();
        let gap = number(element, "gap").unwrap_or(0.0).min(length);
        let end = if length > 0.0 { target - way * (gap / length) } else { target };
        Some(Arc::new(StagePath::new(&[start, end], false)))
    }

    /// Returns whether the model of the thing that acts is missing.
    fn lacks_model(&self, action: usize) -> bool {
        self.bound[action]
            .who
            .and_then(|who| self.binder.things.get(who))
            .is_some_and(|thing| thing.is_missing)
    }

    /// Returns the duration of one repetition of a `play`.
    fn play_length(&self, action: usize) -> StageTime {
        if let Some(clock) = self.play_clock(action) {
            return clock.once;
        }
        if !self.lacks_model(action) {
            return StageTime::ZERO;
        }
        let script = self.binder.script;
        let time = |name: &str| script.time(script.element(action), name);
        let from = time("from").unwrap_or_default();
        let to = time("to").unwrap_or(from + StageTime::from_seconds(UNKNOWN_TAKE)).max(from);
        (to - from).over(script.speed(action))
    }

    fn stride(&self, action: usize) -> Option<PathStride> {
        let bound = &self.bound[action];
        let (take, model) = bound.take.as_ref()?;
        PathStride::new(model, *take, self.binder.things.get(bound.who?)?.scale)
    }

    /// Returns the duration of a way by its speed or stride; `None` where it has neither.
    fn once(&self, action: usize, path: &StagePath) -> Option<StageTime> {
        let element = self.binder.script.element(action);
        let seconds = match number(element, "speed") {
            Some(speed) => path.length() / speed,
            None if self.lacks_model(action) && element.value("take").is_some() => {
                path.length() / UNKNOWN_SPEED
            }
            None => self.stride(action)?.phase_at(path.length()),
        };
        Some(StageTime::from_seconds(seconds))
    }

    /// Returns the clock of a `play`.
    pub(super) fn play_clock(&self, action: usize) -> Option<PlayClock> {
        let (take, model) = self.bound[action].take.as_ref()?;
        let script = self.binder.script;
        let length = model.takes().get(*take)?.length();
        let time = |name: &str| script.time(script.element(action), name).map(|time| time.min(length));
        let from = time("from").unwrap_or_default();
        let to = time("to").unwrap_or(length).max(from);
        let (speed, repeat) = (script.speed(action), script.actions()[action].repeat);
        let once = (to - from).over(speed);
        let start = time("start").map_or(StageTime::ZERO, |start| {
            let start = start.max(from).min(to);
            if speed.is_negative() { to - start } else { start - from }
        });
        let skipped = script.skipped(action, once);
        Some(PlayClock { part: [from, to], speed, repeat, once, skipped, start })
    }

    /// Returns the places of all things, and the lengths that ways to a place have by them.
    fn places(&self, schedule: &Schedule) -> (Vec<PlaceLane>, Vec<(usize, StageTime)>) {
        let script = self.binder.script;
        let mut lanes: Vec<PlaceLane> = self.binder.things.iter().map(|thing| thing.places.clone()).collect();
        let moves =
            |action: &usize| matches!(script.element(*action).row.name, "place" | "move" | "turn" | "play");
        let mut order: Vec<usize> = (0..self.bound.len()).filter(moves).collect();
        order.sort_by_key(|&action| (schedule.times()[action].begin, action));
        let mut lengths = Vec::new();
        for action in order {
            let Some(who) = self.bound[action].who else { continue };
            let times = schedule.times()[action];
            let Some(kind) = self.motion(action, &times, &lanes, &mut lengths) else { continue };
            let span = self.binder.span(action, [times.begin, times.stop], false);
            let cue = PlaceCue {
                action,
                begin: times.begin,
                stop: times.stop,
                fade_in: span.fade_in,
                is_released: span.is_released,
                kind,
                start: lanes[who].base,
            };
            lanes[who].push(cue);
        }
        (lanes, lengths)
    }

    fn motion(
        &self,
        action: usize,
        times: &ActionTimes,
        lanes: &[PlaceLane],
        lengths: &mut Vec<(usize, StageTime)>,
    ) -> Option<MotionKind> {
        let element = self.binder.script.element(action);
        let bound = &self.bound[action];
        let who = bound.who?;
        let start = lanes[who].at(times.begin);
        let position = |thing: usize| lanes[thing].at(times.begin).position;
        let direction = |name: &str| {
            let spot = || self.binder.spot_of(element, name);
            let degrees = number(element, name).map(|degrees| degrees * PI / 180.0);
            degrees.or_else(|| facing_of(self.still(spot()?, position) - start.position))
        };
        match element.row.name {
            "place" => {
                // A mark has a direction; a thing lends its position only.
                let mark = bound
                    .spot
                    .and_then(StageSpot::thing)
                    .filter(|&thing| self.binder.things[thing].kind == "mark");
                let facing = direction("facing").or_else(|| mark.map(|mark| lanes[mark].base.facing));
                Some(MotionKind::Put { position: bound.spot.map(|spot| self.still(spot, position)), facing })
            }
            "turn" => Some(MotionKind::Turn {
                to: direction("to").unwrap_or(start.facing),
                dur: times.end - times.begin,
                ease: StageEase::called(element.value("ease")),
            }),
            "play" => {
                let (take, model) = bound.take.clone()?;
                let is_whole = element.value("layer").is_none() && element.value("bones").is_none();
                let travels = model.takes().get(take).is_some_and(|take| take.travels());
                let clock = self.play_clock(action)?;
                let scale = self.binder.things[who].scale;
                (is_whole && travels).then_some(MotionKind::Travel { model, take, clock, scale })
            }
            "move" => {
                let path = self.path(action, start.position, position)?;
                if element.value("to").is_some() {
                    lengths.push((action, self.once(action, &path).unwrap_or_default()));
                }
                Some(MotionKind::Follow(Box::new(self.follower(action, path, times, start.facing))))
            }
            _ => None,
        }
    }

    fn follower(
        &self,
        action: usize,
        path: Arc<StagePath>,
        times: &ActionTimes,
        facing: f64,
    ) -> PathFollower {
        let element = self.binder.script.element(action);
        let own = &self.binder.script.actions()[action];
        let (laps, is_endless) = match own.repeat {
            StageRepeat::Times(times) => (times, false),
            StageRepeat::Fill => (Decimal::ONE, true),
        };
        let is_stretched = element.attribute("speed").is_none() && (own.dur.is_some() || own.end.is_some());
        let once = self.once(action, &path).unwrap_or_default();
        let total = if is_stretched && !is_endless { times.end - times.begin } else { once.times(laps) };
        let distance = path.length() * laps.to_f64();
        let stride = self.stride(action);
        PathFollower {
            ground: match element.value("ground") {
                Some("plane") => WayGround::Plane(self.binder.ground.plane),
                Some("mesh") => WayGround::Mesh(Arc::clone(&self.binder.ground)),
                Some(_) | None => WayGround::Off,
            },
            total,
            distance,
            is_endless,
            ease: StageEase::called(element.value("ease")),
            heading: match element.value("turn") {
                Some("keep") => PathHeading::Fixed(facing),
                Some("along") | None => PathHeading::Along,
                Some(_) => PathHeading::Fixed(number(element, "turn").unwrap_or(0.0) * PI / 180.0),
            },
            phase_end: stride.as_ref().map_or(0.0, |stride| stride.phase_at(distance)),
            stride,
            keeps_feet: element.value("feet") != Some("free"),
            path,
        }
    }
}
