//! From a script and its models to a plan.

use super::bind::{StageBinder, number};
use super::clock::PlayClock;
use super::cues::{RunCue, ShotCue, SoundCue, TitleCue, run_seed};
use super::ground::{check_ground, find_ground};
use super::holds::{HoldCue, HoldKind, RigidPlace};
use super::looks::LookCue;
use super::motions::{BoundAction, MotionPlanner};
use super::poses::{PoseCue, PoseLane, TakeClock};
use super::properties::{PropertyCue, property_value};
use super::thing::PlannedThing;
use crate::stage::assets::StageAssets;
use crate::stage::ease::StageEase;
use crate::stage::schedule::{ActionTimes, Schedule};
use crate::stage::script::{ErrorList, ScriptError, StageRepeat, StageScript};
use crate::stage::table::{numbers, property, vector};
use crate::stage::time::{Decimal, StageTime};
use crate::trig::rotation_about;
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::PI;

/// Everything of a plan, while it is built.
pub(super) struct PlanBuilder<'a> {
    pub(super) binder: StageBinder<'a>,
    pub(super) schedule: Schedule,
    pub(super) shots: Vec<ShotCue>,
    pub(super) titles: Vec<TitleCue>,
    pub(super) sounds: Vec<SoundCue>,
    /// For each role the lanes of its poses, by layer and bones.
    lanes: HashMap<(usize, String), usize>,
}

impl<'a> PlanBuilder<'a> {
    /// Binds names, computes times and places, and sorts every action into its channel.
    pub(super) fn build(
        script: &'a StageScript,
        assets: &StageAssets,
        before: &[PlannedThing],
    ) -> Result<Self, Vec<ScriptError>> {
        let nested = script.with_errors(|errors| Self::bound(script, assets, before, errors))?;
        let (binder, bound) = nested;
        let planned =
            script.with_errors(|errors| MotionPlanner { binder: &binder, bound: &bound }.plan(errors))?;
        let (schedule, places) = planned?;
        let mut builder = Self {
            binder,
            schedule,
            shots: Vec::new(),
            titles: Vec::new(),
            sounds: Vec::new(),
            lanes: HashMap::new(),
        };
        for (thing, places) in builder.binder.things.iter_mut().zip(places) {
            thing.places = places;
        }
        let mut order: Vec<usize> = (0..bound.len()).collect();
        order.sort_by_key(|&action| (builder.schedule.times()[action].begin, action));
        let clocks: Vec<Option<PlayClock>> = {
            let planner = MotionPlanner { binder: &builder.binder, bound: &bound };
            (0..bound.len()).map(|action| planner.play_clock(action)).collect()
        };
        script.with_errors(|errors| {
            for action in order {
                builder.add(action, &bound[action], clocks[action], assets, errors);
            }
        })?;
        Ok(builder)
    }

    fn bound(
        script: &'a StageScript,
        assets: &StageAssets,
        before: &[PlannedThing],
        errors: &mut ErrorList,
    ) -> (StageBinder<'a>, Vec<BoundAction>) {
        let mut binder = StageBinder::new(script, assets, errors);
        find_ground(&mut binder, before, errors);
        let bind = |action: usize| {
            let element = script.element(action);
            let spot = match element.row.name {
                "place" | "look" => binder.spot(element, "at", errors),
                "move" | "attach" => binder.spot(element, "to", errors),
                // Degrees are no spot.
                "turn" if number(element, "to").is_none() => binder.spot(element, "to", errors),
                _ => None,
            };
            BoundAction { who: binder.who(action), take: binder.take(action, errors), spot }
        };
        let bound: Vec<BoundAction> = (0..script.actions().len()).map(bind).collect();
        check_ground(&binder, &bound, errors);
        (binder, bound)
    }

    /// Sorts an action into the channel that it belongs to.
    fn add(
        &mut self,
        action: usize,
        bound: &BoundAction,
        clock: Option<PlayClock>,
        assets: &StageAssets,
        errors: &mut ErrorList,
    ) {
        let times = self.schedule.times()[action];
        match self.binder.script.element(action).row.name {
            "play" => self.add_take(action, bound, times, clock, errors),
            "move" => self.add_walk(action, bound, times),
            "look" => self.add_look(action, bound, times, errors),
            "attach" | "detach" => self.add_hold(action, bound, times),
            "set" | "change" => self.add_property(action, bound, times),
            "run" => self.add_run(action, bound, times),
            "shot" => self.add_shot(action, bound, times),
            "title" => self.add_title(action, times),
            "sound" => self.add_sound(action, times, assets),
            _ => {}
        }
    }

    fn add_take(
        &mut self,
        action: usize,
        bound: &BoundAction,
        times: ActionTimes,
        clock: Option<PlayClock>,
        errors: &mut ErrorList,
    ) {
        let element = self.binder.script.element(action);
        let (Some(who), Some((take, _)), Some(clock)) = (bound.who, bound.take.clone(), clock) else {
            return;
        };
        let (layer, bones) = (element.value("layer"), element.value("bones"));
        let is_whole = layer.is_none() && bones.is_none();
        let mut lane = 0;
        if !is_whole {
            let mask = self.binder.mask(action, errors);
            let key = (who, format!("{}\n{}", layer.unwrap_or_default(), bones.unwrap_or_default()));
            let lanes = &mut self.binder.things[who].poses;
            lane = *self.lanes.entry(key).or_insert_with(|| {
                lanes.push(PoseLane { mask, cues: Vec::new() });
                lanes.len() - 1
            });
        }
        let span = self.binder.span(action, [times.begin, times.stop], !is_whole);
        let weight = number(element, "weight").unwrap_or(1.0) as f32;
        let cue = PoseCue { span, weight, take, clock: TakeClock::Own(clock) };
        self.binder.things[who].poses[lane].cues.push(cue);
    }

    fn add_walk(&mut self, action: usize, bound: &BoundAction, times: ActionTimes) {
        let (Some(who), Some((take, model))) = (bound.who, bound.take.clone()) else { return };
        let has_stride = model.takes().get(take).is_some_and(|take| take.stride().is_some());
        let length = model.takes().get(take).map_or(StageTime::ZERO, |take| take.length());
        // A take without a stride, such as one that hovers, plays at its own speed.
        let own = PlayClock {
            part: [StageTime::ZERO, length],
            speed: Decimal::ONE,
            repeat: StageRepeat::Fill,
            once: length,
            skipped: StageTime::ZERO,
            start: StageTime::ZERO,
        };
        let clock = if has_stride { TakeClock::Path } else { TakeClock::Own(own) };
        let span = self.binder.span(action, [times.begin, times.stop], false);
        self.binder.things[who].poses[0].cues.push(PoseCue { span, weight: 1.0, take, clock });
    }

    fn add_look(&mut self, action: usize, bound: &BoundAction, times: ActionTimes, errors: &mut ErrorList) {
        let (Some(who), Some(at)) = (bound.who, bound.spot) else { return };
        let Some(gazes) = self.binder.gazes(action, errors) else { return };
        let span = self.binder.span(action, [times.begin, times.stop], true);
        let weight = number(self.binder.script.element(action), "weight").unwrap_or(1.0) as f32;
        self.binder.things[who].looks.push(LookCue { span, weight, at, gazes });
    }

    fn add_hold(&mut self, action: usize, bound: &BoundAction, times: ActionTimes) {
        let element = self.binder.script.element(action);
        let Some(who) = bound.who else { return };
        let kind = match (element.row.name, bound.spot) {
            ("attach", Some(to)) => {
                let span = self.binder.span(action, [times.begin, times.stop], false);
                let degrees = element.value("turn").and_then(vector).unwrap_or(DVec3::ZERO) * (PI / 180.0);
                let about = |axis: DVec3, angle: f64| rotation_about(axis, angle);
                let rotation =
                    about(DVec3::Z, degrees.z) * about(DVec3::Y, degrees.y) * about(DVec3::X, degrees.x);
                let position = element.value("offset").and_then(vector).unwrap_or(DVec3::ZERO);
                HoldKind::Attach { to, grip: RigidPlace { position, rotation }, fade_in: span.fade_in }
            }
            ("attach", None) => return,
            _ => HoldKind::Detach {
                from: None,
                // The ground below is known together with the place.
                floor: (element.value("drop") == Some("ground")).then_some(0.0),
            },
        };
        self.binder.things[who].holds.push(HoldCue { action, begin: times.begin, kind });
    }

    fn add_property(&mut self, action: usize, bound: &BoundAction, times: ActionTimes) {
        let element = self.binder.script.element(action);
        let (Some(who), Some(name), Some(to)) = (bound.who, element.value("property"), element.value("to"))
        else {
            return;
        };
        let thing = &mut self.binder.things[who];
        let Some(row) = property(thing.kind, name) else { return };
        let is_set = element.row.name == "set";
        let cue = PropertyCue {
            begin: times.begin,
            stop: times.stop,
            dur: if is_set { StageTime::ZERO } else { times.end - times.begin },
            ease: StageEase::called(element.value("ease")),
            is_released: element.value("fill") == Some("release"),
            to: property_value(row.kind, to),
            start: [0.0; 3],
        };
        if let Some(lane) = thing.properties.iter_mut().find(|lane| lane.name == name) {
            lane.push(cue);
        }
    }

    fn add_run(&mut self, action: usize, bound: &BoundAction, times: ActionTimes) {
        let Some(who) = bound.who else { return };
        let span = self.binder.span(action, [times.begin, times.stop], true);
        let thing = &mut self.binder.things[who];
        let seed = run_seed(self.binder.script.seed(), &thing.id, thing.runs.len() as u32);
        thing.runs.push(RunCue { span, seed });
    }

    fn add_shot(&mut self, action: usize, bound: &BoundAction, times: ActionTimes) {
        let Some(camera) = bound.who else { return };
        let script = self.binder.script;
        let blend = script.time(script.element(action), "blend").unwrap_or_default();
        self.shots.push(ShotCue { camera, begin: times.begin, blend });
    }

    fn add_title(&mut self, action: usize, times: ActionTimes) {
        let element = self.binder.script.element(action);
        let at = element.value("at").and_then(numbers).unwrap_or_default();
        let part = |index: usize| at.get(index).map_or(0.5, |&part| part as f32);
        self.titles.push(TitleCue {
            text: element.value("text").unwrap_or_default().into(),
            at: [part(0), part(1)],
            span: self.binder.span(action, [times.begin, times.stop], true),
        });
    }

    fn add_sound(&mut self, action: usize, times: ActionTimes, assets: &StageAssets) {
        let element = self.binder.script.element(action);
        let own = &self.binder.script.actions()[action];
        let source = element.value("src").unwrap_or_default();
        let length = assets.sound(source);
        let is_timed = own.dur.is_some() || own.end.is_some() || own.repeat == StageRepeat::Fill;
        let natural = match (own.repeat, length) {
            (StageRepeat::Times(times), Some(length)) => length.times(times),
            (StageRepeat::Times(_) | StageRepeat::Fill, _) => self.schedule.length() - times.begin,
        };
        let stop = if is_timed { times.stop } else { times.begin + natural };
        self.sounds.push(SoundCue {
            source: source.into(),
            gain: number(element, "gain").unwrap_or(1.0),
            span: self.binder.span(action, [times.begin, stop], true),
            length,
            repeat: own.repeat,
        });
    }
}

/// Returns the things in an order in which those that hold others come first, with the number of things that hold each one, one through
/// another; the things of a loop as an error.
pub(super) fn holding_order(things: &[PlannedThing]) -> Result<(Vec<usize>, Vec<usize>), Vec<usize>> {
    let mut held: Vec<Vec<usize>> = vec![Vec::new(); things.len()];
    let mut waits_for = vec![0_usize; things.len()];
    for (thing, planned) in things.iter().enumerate() {
        for holder in planned.holds.iter().filter_map(HoldCue::holder) {
            held[holder].push(thing);
            waits_for[thing] += 1;
        }
    }
    let mut order: Vec<usize> = (0..things.len()).filter(|&thing| waits_for[thing] == 0).collect();
    let mut depths = vec![0; things.len()];
    let mut done = 0;
    while let Some(&holder) = order.get(done) {
        done += 1;
        for &thing in &held[holder] {
            depths[thing] = depths[thing].max(depths[holder] + 1);
            waits_for[thing] -= 1;
            if waits_for[thing] == 0 {
                order.push(thing);
            }
        }
    }
    if order.len() == things.len() {
        Ok((order, depths))
    } else {
        Err((0..things.len()).filter(|&thing| waits_for[thing] > 0).collect())
    }
}
