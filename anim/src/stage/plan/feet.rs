//! Feet that stay where they are while they are on the ground, on a path.
//!
//! A take on a path fits along the path, but not across it: where the path bends, the figure turns about a foot on the ground. So a foot in
//! contact is held by two-bone IK at one point of the scene, its *anchor*: where it is in the middle of the contact. Before and after a
//! contact the correction fades, as in [`crate::contact::lock_contacts`]. The anchor follows from the path alone, so any time can be asked
//! for first.

use super::follow::{PathFollower, PathStride};
use super::places::{MotionKind, PlaceLane};
use crate::data::Transform;
use crate::fast::simd::SimdLevel;
use crate::fast::{FastTwoBone, RootPoses, matrix, to_root, two_bone};
use crate::stage::ease::smooth;
use crate::stage::model::{FootContact, StageModel};
use crate::stage::scene::ThingPose;
use crate::stage::time::StageTime;
use glam::{DQuat, DVec3, Mat4, Vec3};

/// Seconds of the take over which a correction fades before and after a contact.
const EASE: f64 = 0.1;

/// Place and size of a role, for conversion between to-root space and the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoleSpace {
    pub(super) position: DVec3,
    pub(super) rotation: DQuat,
    pub(super) scale: f64,
}

impl RoleSpace {
    pub(super) fn to_scene(self, point: DVec3) -> DVec3 {
        self.position + self.rotation * (point * self.scale)
    }

    pub(super) fn to_own(self, point: DVec3) -> DVec3 {
        self.rotation.inverse() * (point - self.position) / self.scale
    }
}

/// Number of feet that are held; further ones are free.
const MOST_FEET: usize = 8;

/// Largest distance by which hips are lowered, as a part of the length of a leg.
const LOWERED: f32 = 0.15;

/// A walk at a time: the motion, and the share of the pose that its take has.
#[derive(Clone, Copy, Debug)]
pub(super) struct WalkState {
    pub(super) cue: usize,
    pub(super) share: f32,
    pub(super) time: StageTime,
}

/// Holds the feet of a role that follows a path, and computes its matrices. Where a leg is too short for that, the hips are lowered first.
pub(super) fn keep_feet(
    level: SimdLevel,
    model: &StageModel,
    places: &PlaceLane,
    walk: WalkState,
    space: RoleSpace,
    state: &mut ThingPose,
) {
    let place = &places.cues[walk.cue];
    let MotionKind::Follow(follower) = &place.kind else { return };
    let Some(stride) = &follower.stride else { return };
    let standing = StandingFeet { places, cue: walk.cue, follower, stride, scale: space.scale };
    let phase = follower.phase(walk.time.min(place.stop) - place.begin);
    let mut targets: [Option<StandingTarget>; MOST_FEET] = [None; MOST_FEET];
    for (index, (foot, target)) in model.feet().iter().zip(&mut targets).enumerate() {
        let now = space.to_scene(joint(&state.to_root, foot.bone).as_dvec3());
        *target = standing
            .target(index, phase, now)
            .map(|target| StandingTarget { position: space.to_own(target.position), ..target });
    }
    if targets.iter().all(Option::is_none) {
        return;
    }
    let legs = || model.feet().iter().zip(targets).filter_map(|(foot, target)| Some((foot, target?)));
    let lower = legs().map(|(foot, target)| missing(&foot.limb, &target, &state.to_root)).fold(0.0, f32::max);
    if lower > 0.0
        && let Some(hips) = model.hips()
    {
        lower_hips(model, hips, lower * walk.share, state);
        to_root(level, model.rig(), state.pose.blocks(), &mut state.to_root);
    }
    for (foot, target) in legs() {
        let limb = FastTwoBone { weight: walk.share, ..foot.limb };
        two_bone(&limb, target.position.as_vec3(), &state.to_root, &mut state.pose);
    }
    to_root(level, model.rig(), state.pose.blocks(), &mut state.to_root);
}

/// Returns the origin of a bone, to-root space.
fn joint(matrices: &RootPoses, bone: u32) -> Vec3 {
    matrix::transform_point(matrices.get(bone as usize), Vec3::ZERO)
}

/// Part of its length that a leg may have between its ends: near its full length, a small movement of the foot is a large one of the knee.
const STRAIGHT: f32 = 0.995;

/// Returns the distance by which the hips have to be lowered so that a leg reaches its target; 0 where it does, or cannot.
fn missing(limb: &FastTwoBone, target: &StandingTarget, matrices: &RootPoses) -> f32 {
    let [root, middle, end] = [limb.root, limb.middle, limb.end].map(|bone| joint(matrices, bone));
    let length = STRAIGHT * (root.distance(middle) + middle.distance(end));
    let way = root - target.position.as_vec3();
    let height = (length * length - way.x * way.x - way.z * way.z).max(0.0).sqrt();
    let lower = way.y - height;
    if lower > 0.0 { lower.min(LOWERED * length) * target.weight } else { 0.0 }
}

/// Moves the hips down, to-root space.
fn lower_hips(model: &StageModel, hips: u32, lower: f32, state: &mut ThingPose) {
    let parent = model.rig().parent(hips as usize);
    let above = parent.map_or(Mat4::IDENTITY, |parent| matrix::mat4(state.to_root.get(parent)));
    let moved = above.inverse().transform_vector3(Vec3::NEG_Y * lower);
    if let Some(pose) = state.pose.get(hips as usize).filter(|_| moved.is_finite()) {
        state.pose.set(hips as usize, Transform { translation: pose.translation + moved, ..pose });
    }
}

/// Returns when a foot lands in the motion at `cue` of a thing that follows a path, and where it is then: in the contact of its take `turn` cycles after the
/// start. `None` where the motion is another one, or ends before.
pub(super) fn landing(
    places: &PlaceLane,
    (cue, scale): (usize, f64),
    contact: &FootContact,
    turn: u32,
) -> Option<(StageTime, DVec3)> {
    let place = places.cues.get(cue)?;
    let MotionKind::Follow(follower) = &place.kind else { return None };
    let stride = follower.stride.as_ref()?;
    let standing = StandingFeet { places, cue, follower, stride, scale };
    let start = f64::from(turn) * stride.seconds();
    let [from, to] = [contact.from, contact.to].map(|time| start + time.seconds());
    if from > follower.phase(place.stop - place.begin) {
        return None;
    }
    let begin = place.begin + follower.after_phase(from.max(0.0));
    Some((begin, standing.at(contact, 0.5 * (from + to), start)))
}

/// The position that a foot has to have, and its weight: less than 1 before and after a contact.
#[derive(Clone, Copy, Debug)]
struct StandingTarget {
    position: DVec3,
    weight: f32,
}

struct StandingFeet<'a> {
    places: &'a PlaceLane,
    cue: usize,
    follower: &'a PathFollower,
    stride: &'a PathStride,
    scale: f64,
}

impl StandingFeet<'_> {
    /// Returns where a foot that is at `now` has to be; `None` where it is free.
    fn target(&self, foot: usize, phase: f64, now: DVec3) -> Option<StandingTarget> {
        let cycle = self.stride.seconds();
        let loops = (phase / cycle).floor();
        let mut corrected = StandingTarget { position: now, weight: 0.0 };
        for contact in self.stride.take().contacts().iter().filter(|contact| contact.foot == foot) {
            for turn in [loops - 1.0, loops, loops + 1.0] {
                let (from, to) = (contact.from.seconds() + turn * cycle, contact.to.seconds() + turn * cycle);
                if phase < from - EASE || phase > to + EASE {
                    continue;
                }
                let anchor = self.at(contact, 0.5 * (from + to), turn * cycle);
                if (from..=to).contains(&phase) {
                    return Some(StandingTarget { position: anchor, weight: 1.0 });
                }
                let (border, far) = if phase < from { (from, from - phase) } else { (to, phase - to) };
                let weight = smooth(1.0 - far / EASE);
                corrected.position += (anchor - self.at(contact, border, turn * cycle)) * weight;
                corrected.weight = corrected.weight.max(weight as f32);
            }
        }
        (corrected.weight > 0.0).then_some(corrected)
    }

    /// Returns the position in the scene that a foot in contact has by the take alone at the time `phase` of it.
    fn at(&self, contact: &FootContact, phase: f64, start: f64) -> DVec3 {
        let last = if self.follower.is_endless { f64::INFINITY } else { self.follower.phase_end };
        let phase = phase.max(0.0).min(last);
        let (from, to) = (contact.from.seconds(), contact.to.seconds());
        let x = if to > from { ((phase - start - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        let [a, b, c] = contact.at.map(|position| position.as_dvec3());
        let local = if x < 0.5 { a.lerp(b, 2.0 * x) } else { b.lerp(c, 2.0 * x - 1.0) };
        let cue = &self.places.cues[self.cue];
        let placement =
            self.places.by(self.cue, (cue.begin + self.follower.after_phase(phase)).min(cue.stop));
        placement.position + placement.rotation() * (local * self.scale)
    }
}
