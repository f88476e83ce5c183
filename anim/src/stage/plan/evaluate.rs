//! The scene at a time: places and poses of all things, heads, held things, then the rest.

use super::StagePlan;
use super::cameras::camera;
use super::feet::{RoleSpace, WalkState, keep_feet};
use super::holds::{HoldKind, MOST_FADES, RigidPlace, fallen};
use super::needed::NeededThings;
use super::places::MotionKind;
use super::poses::pose_role;
use super::rigid::{deciding_hold, position_of, rigid, rigid_of};
use super::shapes::shape_role;
use super::thing::PlannedThing;
use crate::data::Transform;
use crate::fast::matrix::mat4;
use crate::fast::to_root;
use crate::ik::{LookAt, look_at};
use crate::stage::ease::smooth;
use crate::stage::scene::{StageScene, StageScratch, ThingState};
use crate::stage::time::StageTime;
use glam::{DVec3, Vec3};

/// Writes the scene of `plan` at `time`.
pub(super) fn evaluate(plan: &StagePlan, time: StageTime, scene: &mut StageScene) {
    if !fits(plan, scene) {
        *scene = plan.new_scene();
    }
    place_things(plan, time, scene, &plan.order, 0..plan.things.len());
    scene.camera = camera(plan, time, &scene.things);
    for (thing, state) in plan.things.iter().zip(&mut scene.things) {
        properties(thing, time, state);
    }
    plan.shown_titles(time, &mut scene.titles);
    plan.playing_sounds(time, &mut scene.sounds);
}

/// Computes the place of one thing at `time`, and of what that needs. The other things of `scene` stay as they are.
pub(super) fn evaluate_one(
    plan: &StagePlan,
    needed: &mut NeededThings,
    thing: usize,
    time: StageTime,
    scene: &mut StageScene,
) -> RigidPlace {
    needed.find(&plan.things, thing, time);
    place_things(plan, time, scene, &needed.by_rank, needed.by_index.iter().copied());
    rigid(&scene.things[thing].transform)
}

/// Computes places and poses of the given things: `by_rank` has those that hold others first, `by_index` has the same in the order of the
/// cast.
fn place_things(
    plan: &StagePlan,
    time: StageTime,
    scene: &mut StageScene,
    by_rank: &[usize],
    by_index: impl Iterator<Item = usize>,
) {
    scene.time = time;
    for &thing in by_rank {
        let place = place_of(plan, thing, time, &scene.things, plan.things[thing].holds.len(), MOST_FADES);
        scene.things[thing].transform = transform(&place, plan.things[thing].scale);
        pose(plan, thing, time, scene);
    }
    for thing in by_index {
        look(plan, thing, time, scene);
    }
    // Held things follow the hands as they are now.
    for &thing in by_rank.iter().filter(|&&thing| !plan.things[thing].holds.is_empty()) {
        let place = place_of(plan, thing, time, &scene.things, plan.things[thing].holds.len(), MOST_FADES);
        scene.things[thing].transform = transform(&place, plan.things[thing].scale);
    }
}

/// Returns whether a scene has room for the things of a plan.
fn fits(plan: &StagePlan, scene: &StageScene) -> bool {
    let same = |(thing, state): (&PlannedThing, &ThingState)| {
        let bones = thing.model.as_ref().map(|model| model.rig().bones());
        let shapes = thing.model.as_ref().map_or(0, |model| model.shapes().len());
        bones == state.pose.as_ref().map(|pose| pose.pose.bones())
            && (thing.kind == "light") == state.light.is_some()
            && (thing.kind == "effect") == state.effect.is_some()
            && bones.unwrap_or(0) <= scene.scratch.transforms.len()
            && shapes == state.pose.as_ref().map_or(0, |pose| pose.shapes.len())
            && shapes <= scene.scratch.shapes.len()
    };
    plan.things.len() == scene.things.len() && plan.things.iter().zip(&scene.things).all(same)
}

fn transform(place: &RigidPlace, scale: f64) -> Transform {
    let made = Transform {
        translation: place.position.as_vec3(),
        rotation: place.rotation.as_quat().normalize(),
        scale: Vec3::splat(scale as f32),
    };
    if made.is_finite() { made } else { Transform::IDENTITY }
}

/// Returns the place of a thing by its motions and the first `count` of its attachments: what began last decides.
fn place_of(
    plan: &StagePlan,
    thing: usize,
    time: StageTime,
    things: &[ThingState],
    count: usize,
    fades: usize,
) -> RigidPlace {
    let planned = &plan.things[thing];
    let Some(at) = deciding_hold(planned, time, count) else {
        let placement = planned.places.at(time);
        return RigidPlace { position: placement.position, rotation: placement.rotation() * planned.tilt };
    };
    let hold = &planned.holds[at];
    match &hold.kind {
        HoldKind::Attach { to, grip, fade_in } => {
            let held = rigid_of(*to, things).then(grip);
            let after = time - hold.begin;
            if after >= *fade_in || fades == 0 {
                return held;
            }
            let before = place_of(plan, thing, time, things, at, fades - 1);
            before.mixed(&held, smooth(after.ticks() as f64 / fade_in.ticks() as f64))
        }
        HoldKind::Detach { from, floor } => {
            let from = from.unwrap_or(RigidPlace { position: DVec3::ZERO, rotation: glam::DQuat::IDENTITY });
            floor.map_or(from, |floor| fallen(&from, floor, time - hold.begin))
        }
    }
}

/// Computes the pose of a thing with a model, with its feet on the ground.
fn pose(plan: &StagePlan, thing: usize, time: StageTime, scene: &mut StageScene) {
    let planned = &plan.things[thing];
    let StageScene { things, scratch, .. } = scene;
    let ThingState { transform, pose: Some(state), .. } = &mut things[thing] else { return };
    let Some(model) = &planned.model else { return };
    pose_role(plan.level, model, &planned.poses, &planned.places, time, scratch, state.pose.blocks_mut());
    to_root(plan.level, model.rig(), state.pose.blocks(), &mut state.to_root);
    if !state.shapes.is_empty() {
        let (lanes, places) = (&planned.poses, &planned.places);
        shape_role(model, lanes, places, time, &mut scratch.shapes, &mut state.shapes);
    }
    let Some((cue, share)) = walking(planned, time) else { return };
    let place = rigid(transform);
    let space = RoleSpace { position: place.position, rotation: place.rotation, scale: planned.scale };
    keep_feet(plan.level, model, &planned.places, WalkState { cue, share, time }, space, state);
}

/// Returns the motion on a path whose feet are kept at `time`, and its share of the pose.
fn walking(planned: &PlannedThing, time: StageTime) -> Option<(usize, f32)> {
    let begun = planned.places.cues.partition_point(|cue| cue.begin <= time);
    let at = planned.places.cues[..begun].iter().rposition(|cue| cue.moves())?;
    let cue = &planned.places.cues[at];
    let keeps = match &cue.kind {
        MotionKind::Follow(follower) => follower.keeps_feet && follower.stride.is_some(),
        MotionKind::Put { .. } | MotionKind::Turn { .. } | MotionKind::Travel { .. } => false,
    };
    let is_held = planned
        .holds
        .iter()
        .any(|hold| hold.begin <= time && (hold.begin, hold.action) > (cue.begin, cue.action));
    if !keeps || is_held {
        return None;
    }
    let share = planned.poses.first().map_or(0.0, |lane| lane.share_of(cue.action, time));
    (share > 0.0).then_some((at, share))
}

/// Turns the head of a role to what it looks at.
fn look(plan: &StagePlan, thing: usize, time: StageTime, scene: &mut StageScene) {
    let planned = &plan.things[thing];
    let Some(model) = &planned.model else { return };
    let begun = planned.looks.partition_point(|look| look.span.begin <= time);
    for cue in &planned.looks[..begun] {
        let weight = cue.span.weight(time) as f32 * cue.weight;
        if weight <= 0.0 || cue.gazes.is_empty() {
            continue;
        }
        let target = position_of(cue.at, &scene.things);
        let StageScene { things, scratch, .. } = &mut *scene;
        let ThingState { transform, pose: Some(state), .. } = &mut things[thing] else { return };
        let place = rigid(transform);
        let space = RoleSpace { position: place.position, rotation: place.rotation, scale: planned.scale };
        let target = space.to_own(target).as_vec3();
        let bones = state.pose.bones();
        let StageScratch { transforms, matrices, .. } = &mut *scratch;
        let (transforms, matrices) = (&mut transforms[..bones], &mut matrices[..bones]);
        state.pose.write_to(transforms);
        // Only the matrix of the parent of the first bone is read.
        let first = cue.gazes[0].bone;
        if let Some(parent) = model.rig().parent(first as usize) {
            matrices[parent] = mat4(state.to_root.get(parent));
        }
        let gaze =
            LookAt { up: Some(Vec3::Y), field: FIELD, softness: 0.2, weight, ..LookAt::new(&cue.gazes) };
        if look_at(model.skeleton(), matrices, &gaze, target, transforms).is_ok() {
            for gaze in &cue.gazes {
                state.pose.set(gaze.bone as usize, transforms[gaze.bone as usize]);
            }
            to_root(plan.level, model.rig(), state.pose.blocks(), &mut state.to_root);
        }
    }
}

/// Angles from straight ahead, radians: up to the first a role looks, from the second on it does not.
const FIELD: [f32; 2] = [1.92, 2.62];

/// Writes what a light or an effect is at `time`.
fn properties(thing: &PlannedThing, time: StageTime, state: &mut ThingState) {
    let value = |name: &str| thing.property(name).map_or([0.0; 3], |lane| lane.at(time));
    if let Some(light) = &mut state.light {
        light.color = Vec3::from_array(value("color").map(|part| part as f32));
        light.strength = value("strength")[0] as f32;
    }
    if let Some(effect) = &mut state.effect {
        let begun = thing.runs.partition_point(|run| run.span.begin <= time);
        let run = thing.runs[..begun].iter().rfind(|run| run.span.weight(time) > 0.0);
        effect.weight = run.map_or(0.0, |run| run.span.weight(time) as f32);
        effect.seconds = run.map_or(0.0, |run| (time - run.span.begin).seconds());
        effect.seed = run.map_or(0, |run| run.seed);
        effect.rate = value("rate")[0] as f32;
    }
}
