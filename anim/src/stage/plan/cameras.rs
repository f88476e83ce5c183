//! The camera that is seen: cuts and blends, what it looks at, what is in focus.

use super::StagePlan;
use super::cues::ShotCue;
use super::rigid::{position_of, rigid};
use super::thing::FocusTarget;
use crate::stage::ease::smooth;
use crate::stage::scene::{StageCamera, ThingState};
use crate::stage::time::{LONGEST, StageTime};
use glam::{DMat3, DQuat, DVec3};

/// Number of blends that may overlap; further ones are cuts.
const MOST_BLENDS: usize = 4;

/// A camera before it is rounded.
#[derive(Clone, Copy)]
struct CameraView {
    position: DVec3,
    rotation: DQuat,
    lens: f64,
    focus: Option<f64>,
    aperture: f64,
}

/// Returns the camera that is seen at `time`: that of the latest shot, or the first of the cast before any shot.
pub(super) fn camera(plan: &StagePlan, time: StageTime, things: &[ThingState]) -> Option<StageCamera> {
    let begun = plan.shots.partition_point(|shot| shot.begin <= time);
    let (thing, view) = shot(plan, begun, time, things, MOST_BLENDS)?;
    Some(view.rounded(thing))
}

/// Returns what a camera sees, whatever is shot; `None` for things that are no camera.
pub(super) fn camera_of(
    plan: &StagePlan,
    thing: usize,
    time: StageTime,
    things: &[ThingState],
) -> Option<StageCamera> {
    let is_camera = plan.things.get(thing)?.kind == "camera" && thing < things.len();
    is_camera.then(|| view(plan, thing, time, things).rounded(thing))
}

/// Returns the time of the cut at or before `time`, and the last tick before the next one.
pub(super) fn uncut_span(plan: &StagePlan, time: StageTime) -> (StageTime, StageTime) {
    let begun = plan.shots.partition_point(|shot| shot.begin <= time);
    let (past, coming) = plan.shots.split_at(begun);
    let is_cut = |shot: &&ShotCue| shot.blend <= StageTime::ZERO;
    let first = past.iter().rev().find(is_cut).map_or(-LONGEST, |shot| shot.begin);
    let last = coming.iter().find(is_cut).map_or(LONGEST, |shot| shot.begin - StageTime::from_ticks(1));
    (first, last)
}

impl CameraView {
    fn rounded(&self, thing: usize) -> StageCamera {
        StageCamera {
            thing,
            position: self.position.as_vec3(),
            rotation: self.rotation.as_quat().normalize(),
            lens: self.lens as f32,
            focus: self.focus.map(|focus| focus as f32),
            aperture: self.aperture as f32,
        }
    }
}

/// Returns the camera after the first `begun` shots.
fn shot(
    plan: &StagePlan,
    begun: usize,
    time: StageTime,
    things: &[ThingState],
    blends: usize,
) -> Option<(usize, CameraView)> {
    let Some(at) = begun.checked_sub(1) else {
        let first = plan.things.iter().position(|thing| thing.kind == "camera")?;
        return Some((first, view(plan, first, time, things)));
    };
    let cue = &plan.shots[at];
    let own = view(plan, cue.camera, time, things);
    let after = time - cue.begin;
    if after >= cue.blend || blends == 0 {
        return Some((cue.camera, own));
    }
    let (_, before) = shot(plan, at, time, things, blends - 1)?;
    let weight = smooth(after.ticks() as f64 / cue.blend.ticks() as f64);
    let mix = |a: f64, b: f64| a + (b - a) * weight;
    let to = if before.rotation.dot(own.rotation) < 0.0 { -own.rotation } else { own.rotation };
    let mixed = CameraView {
        position: before.position.lerp(own.position, weight),
        rotation: (before.rotation * (1.0 - weight) + to * weight).normalize(),
        lens: mix(before.lens, own.lens),
        focus: match (before.focus, own.focus) {
            (Some(a), Some(b)) => Some(mix(a, b)),
            (None, focus) | (focus, None) => focus,
        },
        aperture: mix(before.aperture, own.aperture),
    };
    Some((cue.camera, mixed))
}

/// Returns what a camera sees by itself.
fn view(plan: &StagePlan, camera: usize, time: StageTime, things: &[ThingState]) -> CameraView {
    let planned = &plan.things[camera];
    let place = rigid(&things[camera].transform);
    let ahead = place.position + place.rotation * DVec3::Z;
    let mut target = planned.aim.map_or(ahead, |aim| position_of(aim, things));
    for look in &planned.looks {
        let weight = look.span.weight(time) * f64::from(look.weight);
        if weight > 0.0 {
            target = target.lerp(position_of(look.at, things), weight);
        }
    }
    let forward = (target - place.position).try_normalize().unwrap_or(place.rotation * DVec3::Z);
    let value = |name: &str| planned.property(name).map_or(0.0, |lane| lane.at(time)[0]);
    CameraView {
        position: place.position,
        rotation: looking(forward, place.rotation * DVec3::Y),
        lens: value("lens"),
        focus: match planned.focus {
            FocusTarget::Everything => None,
            FocusTarget::Distance(distance) => Some(distance),
            FocusTarget::Spot(spot) => {
                Some((position_of(spot, things) - place.position).dot(forward).max(0.0))
            }
        },
        aperture: value("aperture"),
    }
}

/// Returns the rotation of a camera that looks along `forward`, a unit vector, with `up` as upright as possible.
fn looking(forward: DVec3, up: DVec3) -> DQuat {
    let right = forward
        .cross(up)
        .try_normalize()
        .or_else(|| forward.cross(DVec3::Z).try_normalize())
        .unwrap_or(DVec3::X);
    DQuat::from_mat3(&DMat3::from_cols(right, right.cross(forward), -forward)).normalize()
}
