//! Roll of limbs for twist bones, which no bone of the source moves.
//!
//! A twist bone is a child of an upper or lower arm or leg beside the limb itself (`upperarm_twist_01_l`). It lets the skin roll from
//! one joint to the next. With `s` its place on the segment, 0 at the upper joint and 1 at the lower one, and `a` the direction of
//! the segment, the rotation of a bone about `a` is `τ` in `d = swing · (a, τ)`, and the twist bone with the rest rotation `q_0` gets
//!
//! ```text
//! upper arm, thigh     d = q_rest⁻¹ q   of the segment itself    q = (a, −(1 − s) τ) q_0
//! forearm, shin        d = q q_rest⁻¹   of the hand, the foot    q = (a, s τ) q_0
//! ```
//!
//! so that the skin rests at the shoulder, and turns with the hand at the wrist.

use super::SkeletonBinding;
use super::convention::{BodyPart, BoneRole, SkeletonRoles};
use super::rest::{RestPose, parent_of};
use crate::data::{BoneIndex, Channel, Interpolation, Skeleton, Take};
use crate::sample::sample_channel;
use crate::trig::rotation_of_vector;
use glam::DVec3;

/// Words in the names of twist bones, in lower case.
const WORDS: [&str; 2] = ["twist", "roll"];

/// Share of the segment below which all twist bones are taken to begin at its upper joint.
const AT_JOINT: f64 = 0.05;

/// A segment of a limb, and the twist bones on it.
struct LimbSegment {
    /// The bone of the segment.
    bone: usize,
    /// The bone whose roll is shared: the segment itself, or the one below it.
    driver: usize,
    /// The direction of the segment, in its own space.
    axis: DVec3,
    /// Each twist bone with its share of the roll.
    twists: Vec<(usize, f64)>,
}

/// Returns whether the target has a bone that no bone of the source moves and whose name is that of a twist bone.
pub(super) fn has_free_twist_bone(target: &Skeleton, binding: &SkeletonBinding) -> bool {
    let is_twist = |&bone: &u32| {
        let name = target.bones[bone as usize].name.to_lowercase();
        WORDS.iter().any(|word| name.contains(word))
    };
    binding.unbound_target.iter().any(is_twist)
}

/// Gives unbound twist bones their share of the roll of their segment.
pub(super) fn twist(take: &mut Take, target: &Skeleton, binding: &SkeletonBinding, roles: &SkeletonRoles) {
    let rest = RestPose::of(target);
    for side in [1, 2] {
        for (part, below, is_upper) in [
            (BodyPart::UpperArm, BodyPart::LowerArm, true),
            (BodyPart::LowerArm, BodyPart::Hand, false),
            (BodyPart::UpperLeg, BodyPart::LowerLeg, true),
            (BodyPart::LowerLeg, BodyPart::Foot, false),
        ] {
            let bone = |part| roles.bones(BoneRole { part, side }).first().map(|&bone| bone as usize);
            let (Some(bone), Some(below)) = (bone(part), bone(below)) else { continue };
            if let Some(segment) = segment(target, &rest, binding, (bone, below), is_upper) {
                share(take, &rest, &segment);
            }
        }
    }
}

/// Returns a segment with its twist bones; `None` where it has none, or no length.
fn segment(
    target: &Skeleton,
    rest: &RestPose,
    binding: &SkeletonBinding,
    (bone, below): (usize, usize),
    is_upper: bool,
) -> Option<LimbSegment> {
    let along = rest.origin(below) - rest.origin(bone);
    let length = along.length();
    let axis = (rest.turned[bone].conjugate() * along).try_normalize()?;
    let carries = |twist: usize| {
        std::iter::successors(Some(below), |&bone| parent_of(target, bone)).any(|above| above == twist)
    };
    let is_twist = |&twist: &usize| {
        let name = target.bones[twist].name.to_lowercase();
        let is_bound = binding.source_of.get(twist).is_some_and(Option::is_some);
        parent_of(target, twist) == Some(bone)
            && !is_bound
            && !carries(twist)
            && WORDS.iter().any(|word| name.contains(word))
    };
    let found: Vec<usize> = (0..target.len()).filter(is_twist).collect();
    let place = |twist: usize| {
        ((rest.origin(twist) - rest.origin(bone)).dot(along) / (length * length)).clamp(0.0, 1.0)
    };
    let at_joint = found.iter().all(|&twist| place(twist) < AT_JOINT);
    let count = found.len();
    let twists = found.into_iter().enumerate().map(|(index, twist)| {
        let even = (index + 1) as f64 / (count + 1) as f64;
        let place = if at_joint && !is_upper { even } else { place(twist) };
        (twist, if is_upper { place - 1.0 } else { place })
    });
    let twists: Vec<(usize, f64)> = twists.collect();
    (!twists.is_empty()).then_some(LimbSegment {
        bone,
        driver: if is_upper { bone } else { below },
        axis,
        twists,
    })
}

/// Gives each twist bone of a segment its share of the roll, at the key times of the bone whose roll it is.
fn share(take: &mut Take, rest: &RestPose, segment: &LimbSegment) {
    let &LimbSegment { bone, driver, axis, .. } = segment;
    let Some(channel) = take.tracks.get(driver).map(|track| track.rotation.clone()) else { return };
    if channel.is_empty() {
        return;
    }
    let own = rest.own[driver];
    let mut last = 0.0;
    let rolls: Vec<f64> = channel
        .times
        .iter()
        .map(|&time| {
            let turned = sample_channel(&channel, own.as_quat(), time).as_dquat().normalize();
            let from_rest = if driver == bone { own.conjugate() * turned } else { turned * own.conjugate() };
            let roll = 2.0 * libm::atan2(from_rest.xyz().dot(axis), from_rest.w);
            // The same rotation has many angles: the one nearest to the angle before.
            let turns = ((last - roll) / std::f64::consts::TAU).round();
            last = roll + turns * std::f64::consts::TAU;
            last
        })
        .collect();
    for &(twist, part) in &segment.twists {
        let mut before = rest.own[twist];
        let value = |roll: &f64| {
            let turned = rotation_of_vector(axis * (part * roll)) * rest.own[twist];
            before = if turned.dot(before) < 0.0 { -turned } else { turned };
            before.normalize().as_quat()
        };
        let values: Vec<_> = rolls.iter().map(value).collect();
        let interpolation = match channel.interpolation {
            Interpolation::Step | Interpolation::Closest => channel.interpolation,
            Interpolation::Linear | Interpolation::CubicSpline => Interpolation::Linear,
        };
        if let Some(track) = take.tracks.get_mut(twist) {
            track.bone = twist as BoneIndex;
            track.rotation = Channel::new(channel.times.clone(), values, interpolation);
        }
    }
}
