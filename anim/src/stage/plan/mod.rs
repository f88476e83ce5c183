//! A plan: a script, its times, and its models, ready to give the scene at any time.

mod bind;
mod build;
mod cameras;
mod clock;
mod cues;
mod evaluate;
mod fade;
mod feet;
mod follow;
mod footprints;
mod ground;
mod held;
mod holds;
mod looks;
mod motions;
mod needed;
mod placement;
mod places;
mod poses;
mod properties;
mod rigid;
mod shapes;
mod spot;
mod thing;

pub use cues::{SoundCue, TitleCue};
pub use footprints::{Footprint, PathWalk};
pub use held::ThingHold;
pub use holds::RigidPlace;
pub use placement::Placement;
pub use thing::PlannedThing;

use super::assets::StageAssets;
use super::ground::SceneGround;
use super::scene::{
    EffectState, LightState, PlayingSound, ShownTitle, StageCamera, StageScene, StageScratch, ThingPose,
    ThingState,
};
use super::schedule::Schedule;
use super::script::{ScriptError, StageScript};
use super::time::{StageRate, StageTime};
use crate::data::Transform;
use crate::fast::simd::SimdLevel;
use build::{PlanBuilder, holding_order};
pub(in crate::stage) use clock::PlayMoment;
use cues::ShotCue;
use fade::ActiveSpan;
use glam::{DVec3, Vec3};
use holds::HoldKind;
use needed::NeededThings;
use poses::TakeClock;
use std::collections::HashMap;
use std::sync::Arc;

/// Number of things that may hold one, each through the next.
const MOST_HOLDERS: usize = 64;

/// Number of places that may be computed to find where things are detached.
const MOST_COMPUTED: usize = 200_000;

/// Number of attachments and looks that may be considered for that.
const MOST_CONSIDERED: usize = 50_000_000;

/// A script with its times and models. Never changes, so threads can share it; each needs a [`StageScene`] of its own.
#[derive(Clone, Debug)]
pub struct StagePlan {
    level: SimdLevel,
    rate: StageRate,
    schedule: Schedule,
    things: Vec<PlannedThing>,
    /// The positions of the things by their ids.
    positions: HashMap<Box<str>, usize>,
    ground: Arc<SceneGround>,
    /// The things, those that hold others first.
    order: Vec<usize>,
    shots: Vec<ShotCue>,
    titles: Vec<TitleCue>,
    sounds: Vec<SoundCue>,
}

impl StagePlan {
    /// Plans `script` with the models of `assets`, for the best instructions of this machine.
    ///
    /// # Errors
    ///
    /// What the script names and the models do not have, ways without a duration, times that depend on themselves, things that hold each
    /// other: all with their places.
    pub fn new(script: &StageScript, assets: &StageAssets) -> Result<Self, Vec<ScriptError>> {
        Self::made(script, assets, SimdLevel::best(), None)
    }

    /// As [`Self::new`], for a script of which `before` is an older plan: the ground of models that both have is not prepared again.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn after(
        before: Option<&Self>,
        script: &StageScript,
        assets: &StageAssets,
    ) -> Result<Self, Vec<ScriptError>> {
        Self::made(script, assets, SimdLevel::best(), before)
    }

    /// As [`Self::new`], for given instructions: with the portable ones, scenes have the same bits on every machine.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn at_level(
        script: &StageScript,
        assets: &StageAssets,
        level: SimdLevel,
    ) -> Result<Self, Vec<ScriptError>> {
        Self::made(script, assets, level, None)
    }

    fn made(
        script: &StageScript,
        assets: &StageAssets,
        level: SimdLevel,
        before: Option<&Self>,
    ) -> Result<Self, Vec<ScriptError>> {
        let before = before.map_or(&[][..], |before| &before.things);
        let builder = PlanBuilder::build(script, assets, before)?;
        let ground = builder.binder.ground;
        let things = builder.binder.things;
        let mut plan = Self {
            level,
            rate: script.rate(),
            schedule: builder.schedule,
            positions: things.iter().enumerate().map(|(at, thing)| (thing.id.clone(), at)).collect(),
            things,
            ground,
            order: Vec::new(),
            shots: builder.shots,
            titles: builder.titles,
            sounds: builder.sounds,
        };
        match holding_order(&plan.things) {
            Ok((order, depths)) => {
                plan.order = order;
                if let Some(thing) = depths.iter().position(|&depth| depth > MOST_HOLDERS) {
                    let id = &plan.things[thing].id;
                    let message =
                        format!("more than {MOST_HOLDERS} things hold \"{id}\", one through another");
                    return Err(plan.held_wrongly(script, &[thing], message));
                }
            }
            Err(things) => {
                let names: Vec<&str> = things.iter().take(20).map(|&thing| &*plan.things[thing].id).collect();
                let more = if things.len() > names.len() { ", …" } else { "" };
                let message = format!("these things hold each other: {}{more}", names.join(", "));
                return Err(plan.held_wrongly(script, &things, message));
            }
        }
        if let Err(action) = plan.detach_places() {
            let message = "too many things hold or see what is detached here and before";
            return Err(wrong_action(
                script,
                action,
                message,
                "detach fewer things, or let fewer of them look",
            ));
        }
        Ok(plan)
    }

    /// Returns an error at the first attachment of `things`.
    fn held_wrongly(&self, script: &StageScript, things: &[usize], message: String) -> Vec<ScriptError> {
        let action =
            things.iter().find_map(|&thing| self.things[thing].holds.first()).map_or(0, |hold| hold.action);
        wrong_action(script, action, message, "attach one of them to something else")
    }

    /// Computes the place where each thing is detached, in the order of time. The error is the action for which that takes too much.
    fn detach_places(&mut self) -> Result<(), usize> {
        let mut all: Vec<(StageTime, usize, usize, usize)> = Vec::new();
        for (thing, planned) in self.things.iter().enumerate() {
            for (at, hold) in planned.holds.iter().enumerate() {
                match hold.kind {
                    HoldKind::Detach { .. } => all.push((hold.begin, hold.action, thing, at)),
                    HoldKind::Attach { .. } => {}
                }
            }
        }
        all.sort_unstable();
        if all.is_empty() {
            return Ok(());
        }
        let (mut scene, mut needed) = (self.new_scene(), NeededThings::new(&self.order));
        for (begin, action, thing, at) in all {
            let place = evaluate::evaluate_one(self, &mut needed, thing, begin, &mut scene);
            if needed.work.things > MOST_COMPUTED || needed.work.cues > MOST_CONSIDERED {
                return Err(action);
            }
            if let HoldKind::Detach { from, floor } = &mut self.things[thing].holds[at].kind {
                *from = Some(place);
                if let Some(floor) = floor {
                    *floor =
                        self.ground.below(place.position).map_or(self.ground.plane, |surface| surface.height);
                }
            }
        }
        Ok(())
    }

    /// Returns the times of the actions.
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    /// Returns the length of the script.
    pub fn length(&self) -> StageTime {
        self.schedule.length()
    }

    /// Returns the frame rate of the script.
    pub fn rate(&self) -> StageRate {
        self.rate
    }

    /// Returns the things of the cast, in the order of the script.
    pub fn things(&self) -> &[PlannedThing] {
        &self.things
    }

    /// Returns the position of the thing called `id`.
    pub fn thing_called(&self, id: &str) -> Option<usize> {
        self.positions.get(id).copied()
    }

    /// Returns the titles.
    pub fn titles(&self) -> &[TitleCue] {
        &self.titles
    }

    /// Returns the sounds.
    pub fn sounds(&self) -> &[SoundCue] {
        &self.sounds
    }

    /// Writes the sounds that play at `time`, in the order of [`Self::sounds`]. Allocates only where more play than `out` has room for.
    pub fn playing_sounds(&self, time: StageTime, out: &mut Vec<PlayingSound>) {
        out.clear();
        out.extend(self.sounds.iter().enumerate().filter_map(|(sound, cue)| {
            let seconds = cue.time(time)?.seconds();
            Some(PlayingSound { sound, seconds, gain: (cue.gain * cue.span.weight(time)) as f32 })
        }));
    }

    /// Returns the height of the plane that is ground where there are no ground props, meters.
    pub fn ground_plane(&self) -> f64 {
        self.ground.plane
    }

    /// Returns the height of the ground props of the cast under or over a point, nearest to its height; `None` where there is none.
    pub fn ground_at(&self, point: DVec3) -> Option<f64> {
        self.ground.nearest(point).map(|surface| surface.height)
    }

    /// Writes the titles that are shown at `time`, in the order of [`Self::titles`]. Allocates only where more are shown than `out` has room for.
    pub fn shown_titles(&self, time: StageTime, out: &mut Vec<ShownTitle>) {
        out.clear();
        let titles = self.titles.iter().enumerate().map(|(title, cue)| (title, cue.span.weight(time) as f32));
        out.extend(titles.filter(|one| one.1 > 0.0).map(|(title, weight)| ShownTitle { title, weight }));
    }

    /// Returns the place of a thing at `time` by its motions alone, as if nothing held it; `None` past the end.
    pub fn placement(&self, thing: usize, time: StageTime) -> Option<Placement> {
        self.things.get(thing).map(|thing| thing.places.at(time))
    }

    /// Returns the action whose way or take moves a thing at `time`; `None` where nothing moves it, and past the end.
    pub fn motion_in_progress(&self, thing: usize, time: StageTime) -> Option<usize> {
        self.things.get(thing)?.places.in_progress(time)
    }

    /// Returns the action that plays a take with the whole body of a thing at `time`, or that played one before, the one that began last and was not released
    /// since, and the time since the start of the take. `None` before the first one.
    pub fn take_at(&self, thing: usize, time: StageTime) -> Option<(usize, StageTime)> {
        let thing = self.things.get(thing)?;
        let lane = thing.poses.first()?;
        let begun = &lane.cues[..lane.cues.partition_point(|cue| cue.span.begin <= time)];
        let decides = |span: &ActiveSpan| !(span.is_released && span.stop <= time);
        let cue = begun.iter().rfind(|cue| decides(&cue.span)).or(begun.last())?;
        Some((cue.span.action, poses::take_time(cue, &thing.places, time)))
    }

    /// Returns where in its take an action of a thing is at `time`; `None` for an action that plays none by its own clock, and while the model is missing.
    pub(in crate::stage) fn play_moment(
        &self,
        thing: usize,
        action: usize,
        time: StageTime,
    ) -> Option<PlayMoment> {
        let lanes = &self.things.get(thing)?.poses;
        let cue = lanes.iter().flat_map(|lane| &lane.cues).find(|cue| cue.span.action == action)?;
        match &cue.clock {
            TakeClock::Own(clock) => Some(clock.moment(time - cue.span.begin)),
            TakeClock::Path => None,
        }
    }

    /// Returns the length of the way on which an action leads a thing, meters; `None` for an action that leads it nowhere.
    pub fn way_length(&self, thing: usize, action: usize) -> Option<f64> {
        self.things.get(thing)?.places.way_length(action)
    }

    /// Returns what holds a thing in `scene`, which [`Self::scene_at`] wrote; `None` where its own motions decide where it is, and past the end.
    pub fn hold_of(&self, thing: usize, scene: &StageScene) -> Option<ThingHold> {
        let same_cast = scene.things.len() == self.things.len();
        same_cast.then(|| held::hold_of(&self.things, thing, scene)).flatten()
    }

    /// Returns position and rotation of a thing such as `anna`, or of a bone of it such as `anna.RightHand`, in `scene`, which [`Self::scene_at`]
    /// wrote. `None` where there is no such thing or bone.
    pub fn place_of_name(&self, name: &str, scene: &StageScene) -> Option<RigidPlace> {
        let same_cast = scene.things.len() == self.things.len();
        same_cast.then(|| held::place_of_name(&self.things, name, scene)).flatten()
    }

    /// Returns what a camera of the cast sees in `scene`, which [`Self::scene_at`] wrote, whatever is shot; `None` for things that are no
    /// camera and past the end.
    pub fn camera_of(&self, thing: usize, scene: &StageScene) -> Option<StageCamera> {
        let same_cast = scene.things.len() == self.things.len();
        same_cast.then(|| cameras::camera_of(self, thing, scene.time, &scene.things)).flatten()
    }

    /// Returns the first and the last time of the shots around `time` that follow each other without a cut: within them the camera that is
    /// seen does not jump.
    pub fn uncut_span(&self, time: StageTime) -> (StageTime, StageTime) {
        cameras::uncut_span(self, time)
    }

    /// Allocates a scene for this plan.
    pub fn new_scene(&self) -> StageScene {
        let light = LightState { color: Vec3::ONE, strength: 1.0 };
        let effect = EffectState { weight: 0.0, seconds: 0.0, seed: 0, rate: 0.0 };
        let state = |thing: &PlannedThing| ThingState {
            transform: Transform::IDENTITY,
            pose: thing.model.as_ref().map(|model| ThingPose::new(model)),
            light: (thing.kind == "light").then_some(light),
            effect: (thing.kind == "effect").then_some(effect),
        };
        let models = || self.things.iter().filter_map(|thing| thing.model.as_ref());
        let bones = models().map(|model| model.rig().bones()).max().unwrap_or(0);
        let shapes = models().map(|model| model.shapes().len()).max().unwrap_or(0);
        StageScene {
            time: StageTime::ZERO,
            things: self.things.iter().map(state).collect(),
            camera: None,
            titles: Vec::with_capacity(self.titles.len()),
            sounds: Vec::with_capacity(self.sounds.len()),
            scratch: StageScratch::new(bones, shapes),
        }
    }

    /// Writes the scene of frame `frame` of the script's frame rate; see [`Self::scene_at`].
    pub fn frame(&self, frame: i64, scene: &mut StageScene) {
        self.scene_at(self.rate.frame(frame), scene);
    }

    /// Writes the scene at `time`.
    ///
    /// A function of plan and time: the same bits in any order of calls, on any thread. Allocates nothing, unless `scene` was made for
    /// another plan.
    pub fn scene_at(&self, time: StageTime, scene: &mut StageScene) {
        evaluate::evaluate(self, time, scene);
    }
}

/// Returns an error at the name of an action.
fn wrong_action(
    script: &StageScript,
    action: usize,
    message: impl Into<String>,
    help: &str,
) -> Vec<ScriptError> {
    let at = script.element(action).name.clone();
    script.with_errors(|errors| errors.add(at, message, help)).err().unwrap_or_default()
}
