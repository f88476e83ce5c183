//! Feet that stay where they are while they stand, on a path.
//!
//! A take on a path fits along the path, but not across it: where the path bends, the figure turns about a foot that stands. So a foot in
//! contact is held by two-bone IK at one point of the scene, its *anchor*: where it is in the middle of the contact. Before and after a
//! contact the correction fades, as in [`crate::contact::lock_contacts`]. The anchor follows from the path alone, so any time can be asked
//! for first.

use super::follow::{PathFollower, PathStride};
use super::places::{MotionKind, PlaceLane};
use crate::fast::{Pose, RootPoses, matrix, two_bone};
use crate::stage::ease::smooth;
use crate::stage::model::{FootContact, StageModel};
use crate::stage::time::StageTime;
use glam::{DQuat, DVec3};

/// Seconds of the take over which a correction fades before and after a contact.
const EASE: f64 = 0.1;

/// Where a role is, for conversion between to-root space and the scene.
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

    pub(super) fn from_scene(self, point: DVec3) -> DVec3 {
        self.rotation.inverse() * (point - self.position) / self.scale
    }
}

/// Holds the feet of a role that follows a path. Returns whether the pose has changed.
#[allow(clippy::too_many_arguments, reason = "inputs of one step of a larger evaluation")]
pub(super) fn keep_feet(
    model: &StageModel,
    places: &PlaceLane,
    cue: usize,
    share: f32,
    time: StageTime,
    space: RoleSpace,
    to_root: &RootPoses,
    pose: &mut Pose,
) -> bool {
    let place = &places.cues[cue];
    let MotionKind::Follow(follower) = &place.kind else { return false };
    let Some(stride) = &follower.stride else { return false };
    let standing = StandingFeet { places, cue, follower, stride, scale: space.scale };
    let phase = follower.phase(time.min(place.stop) - place.begin);
    let mut is_changed = false;
    for (index, foot) in model.feet().iter().enumerate() {
        let now = matrix::transform_point(to_root.get(foot.bone as usize), glam::Vec3::ZERO).as_dvec3();
        let now = space.to_scene(now);
        let Some(target) = standing.target(index, phase, now) else { continue };
        let mut limb = foot.limb;
        limb.weight = share;
        is_changed |= two_bone(&limb, space.from_scene(target).as_vec3(), to_root, pose);
    }
    is_changed
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
    fn target(&self, foot: usize, phase: f64, now: DVec3) -> Option<DVec3> {
        let cycle = self.stride.seconds();
        let loops = (phase / cycle).floor();
        let (mut corrected, mut is_free) = (now, true);
        for contact in self.stride.take().contacts().iter().filter(|contact| contact.foot == foot) {
            for turn in [loops - 1.0, loops, loops + 1.0] {
                let (from, to) = (contact.from.seconds() + turn * cycle, contact.to.seconds() + turn * cycle);
                if phase < from - EASE || phase > to + EASE {
                    continue;
                }
                let anchor = self.at(contact, 0.5 * (from + to), turn * cycle);
                if (from..=to).contains(&phase) {
                    return Some(anchor);
                }
                let (border, far) = if phase < from { (from, from - phase) } else { (to, phase - to) };
                corrected += (anchor - self.at(contact, border, turn * cycle)) * smooth(1.0 - far / EASE);
                is_free = false;
            }
        }
        (!is_free).then_some(corrected)
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
