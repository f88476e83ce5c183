//! Feet that stay where they are while they are on the ground, on a path.
//!
//! A take on a path fits along the path, but not across it: where the path bends, the figure turns about a foot on the ground. So a foot in
//! contact is held by two-bone IK at one point of the scene, its *anchor*: where it is in the middle of the contact. Before and after a
//! contact the correction fades, as in [`crate::contact::lock_contacts`]. The anchor follows from the path alone, so any time can be asked
//! for first.
//!
//! On a mesh each foot follows the ground under itself, on its way as well: its height over the role becomes its height over the ground there. In a
//! contact it leans with the ground, and is as far from it as its take says, measured along the normal.

use super::follow::{PathFollower, PathStride, WayGround};
use super::places::{MotionKind, PlaceLane};
use super::thing::PlannedThing;
use crate::data::Transform;
use crate::fast::simd::SimdLevel;
use crate::fast::{FastTwoBone, RootPoses, matrix, to_root, two_bone};
use crate::stage::ease::smooth;
use crate::stage::ground::{GroundSurface, SceneGround};
use crate::stage::model::{FootContact, StageModel};
use crate::stage::scene::ThingPose;
use crate::stage::time::StageTime;
use glam::{DQuat, DVec3, Mat4, Quat, Vec3};

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

/// The same on a mesh, where one foot may be much lower than the other.
const LOWERED_ON_MESH: f32 = 0.4;

/// Largest height over or under a role of ground for its feet, as a part of the length of a leg.
const REACHED: f64 = 0.5;

/// Returns the height over or under a role of this size that its feet reach, meters.
fn foot_reach(model: &StageModel, scale: f64) -> f64 {
    REACHED * f64::from(model.leg()) * scale
}

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
    let reach = foot_reach(model, space.scale);
    let standing = StandingFeet { places, cue: walk.cue, follower, stride, scale: space.scale, reach };
    let phase = follower.phase(walk.time.min(place.stop) - place.begin);
    let mut targets: [Option<StandingTarget>; MOST_FEET] = [None; MOST_FEET];
    for (index, (foot, target)) in model.feet().iter().zip(&mut targets).enumerate() {
        let now = space.to_scene(joint(&state.to_root, foot.bone).as_dvec3());
        let now = standing.over_ground(space.position, now);
        *target = standing
            .target(index, phase, now)
            .map(|target| StandingTarget { position: space.to_own(target.position), ..target });
    }
    if targets.iter().all(Option::is_none) {
        return;
    }
    let legs = || model.feet().iter().zip(targets).filter_map(|(foot, target)| Some((foot, target?)));
    let on_mesh = standing.mesh().is_some();
    let most = if on_mesh { LOWERED_ON_MESH } else { LOWERED };
    let lower =
        legs().map(|(foot, target)| missing(&foot.limb, &target, most, &state.to_root)).fold(0.0, f32::max);
    if lower > 0.0
        && let Some(hips) = model.hips()
    {
        lower_hips(model, hips, lower * walk.share, state);
        to_root(level, model.rig(), state.pose.blocks(), &mut state.to_root);
    }
    let mut turned = [Quat::IDENTITY; MOST_FEET];
    for ((foot, _), turned) in legs().zip(&mut turned).filter(|_| on_mesh) {
        *turned = rotation(&state.to_root, foot.bone);
    }
    for (foot, target) in legs() {
        let limb = FastTwoBone { weight: walk.share, ..foot.limb };
        two_bone(&limb, target.position.as_vec3(), &state.to_root, &mut state.pose);
    }
    to_root(level, model.rig(), state.pose.blocks(), &mut state.to_root);
    if !on_mesh {
        return;
    }
    // There legs bend much more than the take has it, and feet must not turn with them.
    for ((foot, target), turned) in legs().zip(turned) {
        let lean = space.rotation.inverse() * (target.lean * f64::from(walk.share));
        let up = (DVec3::Y + lean).as_vec3().normalize_or(Vec3::Y);
        turn_foot(model, foot.bone, Quat::from_rotation_arc(Vec3::Y, up) * turned, state);
    }
    to_root(level, model.rig(), state.pose.blocks(), &mut state.to_root);
}

/// Returns the rotation of a bone, to-root space.
fn rotation(matrices: &RootPoses, bone: u32) -> Quat {
    Transform::from_matrix(matrix::mat4(matrices.get(bone as usize))).rotation
}

/// Turns a foot about its joint to a rotation in to-root space.
fn turn_foot(model: &StageModel, foot: u32, turned: Quat, state: &mut ThingPose) {
    let parent = model.rig().parent(foot as usize);
    let above = parent.map_or(Quat::IDENTITY, |parent| rotation(&state.to_root, parent as u32));
    if let Some(pose) = state.pose.get(foot as usize) {
        let rotation = (above.inverse() * turned).normalize();
        if rotation.is_finite() {
            state.pose.set(foot as usize, Transform { rotation, ..pose });
        }
    }
}

/// Returns the origin of a bone, to-root space.
fn joint(matrices: &RootPoses, bone: u32) -> Vec3 {
    matrix::transform_point(matrices.get(bone as usize), Vec3::ZERO)
}

/// Part of its length that a leg may have between its ends: near its full length, a small movement of the foot is a large one of the knee.
const STRAIGHT: f32 = 0.995;

/// Returns the distance by which the hips have to be lowered so that a leg reaches its target, at most the part `most` of its length; 0 where it does.
fn missing(limb: &FastTwoBone, target: &StandingTarget, most: f32, matrices: &RootPoses) -> f32 {
    let [root, middle, end] = [limb.root, limb.middle, limb.end].map(|bone| joint(matrices, bone));
    let length = STRAIGHT * (root.distance(middle) + middle.distance(end));
    let way = root - target.position.as_vec3();
    let height = (length * length - way.x * way.x - way.z * way.z).max(0.0).sqrt();
    let lower = way.y - height;
    if lower > 0.0 { lower.min(most * length) * target.weight } else { 0.0 }
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
/// start, at the height of the ground. `None` where the motion is another one, or ends before.
pub(super) fn landing(
    thing: &PlannedThing,
    cue: usize,
    contact: &FootContact,
    turn: u32,
) -> Option<(StageTime, DVec3)> {
    let (places, scale) = (&thing.places, thing.scale);
    let place = places.cues.get(cue)?;
    let MotionKind::Follow(follower) = &place.kind else { return None };
    let stride = follower.stride.as_ref()?;
    let reach = foot_reach(thing.model.as_ref()?, scale);
    let standing = StandingFeet { places, cue, follower, stride, scale, reach };
    let start = f64::from(turn) * stride.seconds();
    let [from, to] = [contact.from, contact.to].map(|time| start + time.seconds());
    if from > follower.phase(place.stop - place.begin) {
        return None;
    }
    let begin = place.begin + follower.after_phase(from.max(0.0));
    let position = standing.at(contact, 0.5 * (from + to), start).0;
    let role = places.by(cue, begin).position;
    let height = standing.ground_under(role, position).map_or(role.y, |surface| surface.height);
    Some((begin, position.with_y(height)))
}

/// The position that a foot has to have, and its weight: less than 1 before and after a contact.
#[derive(Clone, Copy, Debug)]
struct StandingTarget {
    position: DVec3,
    weight: f32,
    /// From the vertical to the direction that is up for the foot.
    lean: DVec3,
}

/// Largest sine of the angle by which a foot leans: 40 degrees.
const MOST_LEAN: f64 = 0.642_787_6;

/// Returns the vector from the vertical to a unit normal, for a foot on the ground.
fn lean(normal: DVec3) -> DVec3 {
    let across = DVec3::new(normal.x, 0.0, normal.z);
    let length = across.length();
    let across = if length > MOST_LEAN { across * (MOST_LEAN / length) } else { across };
    across + DVec3::Y * ((1.0 - across.length_squared()).sqrt() - 1.0)
}

struct StandingFeet<'a> {
    places: &'a PlaceLane,
    cue: usize,
    follower: &'a PathFollower,
    stride: &'a PathStride,
    scale: f64,
    /// Meters.
    reach: f64,
}

impl StandingFeet<'_> {
    /// Returns where a foot that is at `now` has to be; `None` where it is free.
    fn target(&self, foot: usize, phase: f64, now: DVec3) -> Option<StandingTarget> {
        let cycle = self.stride.seconds();
        let loops = (phase / cycle).floor();
        let mut corrected = StandingTarget { position: now, weight: 0.0, lean: DVec3::ZERO };
        for contact in self.stride.take().contacts().iter().filter(|contact| contact.foot == foot) {
            for turn in [loops - 1.0, loops, loops + 1.0] {
                let (from, to) = (contact.from.seconds() + turn * cycle, contact.to.seconds() + turn * cycle);
                if phase < from - EASE || phase > to + EASE {
                    continue;
                }
                let (anchor, lean) = self.anchor(contact, 0.5 * (from + to), turn * cycle);
                if (from..=to).contains(&phase) {
                    return Some(StandingTarget { position: anchor, weight: 1.0, lean });
                }
                let (border, far) = if phase < from { (from, from - phase) } else { (to, phase - to) };
                let weight = smooth(1.0 - far / EASE);
                corrected.position += (anchor - self.at(contact, border, turn * cycle).0) * weight;
                corrected.lean += lean * weight;
                corrected.weight = corrected.weight.max(weight as f32);
            }
        }
        // On a mesh a foot on its way follows the ground, too.
        (corrected.weight > 0.0 || self.mesh().is_some()).then_some(corrected)
    }

    /// Returns the ground that the way follows; `None` where it follows no mesh.
    fn mesh(&self) -> Option<&SceneGround> {
        match &self.follower.ground {
            WayGround::Mesh(ground) => Some(ground),
            WayGround::Off | WayGround::Plane(_) => None,
        }
    }

    /// Returns the ground under a foot of a role that is at `role`; `None` where the way follows no mesh, or none is there that the foot reaches: a
    /// foot beyond an edge does not go to the floor far below. On a slope of 45 degrees it reaches any distance.
    fn ground_under(&self, role: DVec3, foot: DVec3) -> Option<GroundSurface> {
        let across = (foot - role).with_y(0.0).length();
        let is_near = |ground: &GroundSurface| (ground.height - role.y).abs() <= self.reach + across;
        self.mesh()?.nearest(foot.with_y(role.y)).filter(is_near)
    }

    /// Returns the position of a foot with the height over the ground that it has over the role, which is at `role`. Where there is no ground for it, that is
    /// its height already.
    fn over_ground(&self, role: DVec3, foot: DVec3) -> DVec3 {
        let ground = self.ground_under(role, foot).map_or(role.y, |surface| surface.height);
        foot.with_y(foot.y + (ground - role.y))
    }

    /// Returns where a foot is during a contact, and how it leans there.
    fn anchor(&self, contact: &FootContact, middle: f64, start: f64) -> (DVec3, DVec3) {
        let (position, role) = self.at(contact, middle, start);
        let Some(ground) = self.ground_under(role, position) else { return (position, DVec3::ZERO) };
        let lean = lean(ground.normal);
        // On a plane the distance along the normal is shorter than the height.
        let height = (position.y - ground.height) / (1.0 + lean.y);
        (position.with_y(ground.height + height), lean)
    }

    /// Returns the position in the scene that a foot in contact has by the take alone at the time `phase` of it, over the ground, and that of the role
    /// then.
    fn at(&self, contact: &FootContact, phase: f64, start: f64) -> (DVec3, DVec3) {
        let last = if self.follower.is_endless { f64::INFINITY } else { self.follower.phase_end };
        let phase = phase.max(0.0).min(last);
        let (from, to) = (contact.from.seconds(), contact.to.seconds());
        let x = if to > from { ((phase - start - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
        let [a, b, c] = contact.at.map(|position| position.as_dvec3());
        let local = if x < 0.5 { a.lerp(b, 2.0 * x) } else { b.lerp(c, 2.0 * x - 1.0) };
        let cue = &self.places.cues[self.cue];
        let placement =
            self.places.by(self.cue, (cue.begin + self.follower.after_phase(phase)).min(cue.stop));
        let (role, foot) =
            (placement.position, placement.position + placement.rotation() * (local * self.scale));
        (self.over_ground(role, foot), role)
    }
}
