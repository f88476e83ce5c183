//! Foot placement on the ground: stairs, slopes, stones.
//!
//! The caller knows the ground; for each leg it gives a point and a normal below the foot, or nothing. With `u` the up
//! direction, `n` the normal, `A` the ankle as posed and `G` the point of the ground plane straight below or above it:
//!
//! ```text
//! lift    = max(0, A·u - floor - ankle height)          how far the take itself lifts the foot
//! target  = G + u (ankle height / (n·u) + lift)         so that the ankle is its height away from the plane
//! turn    = the shortest rotation of u onto n, at most `tilt`, applied to the foot as posed
//! lower   = max over the legs of (A - target)·u, clamped to 0 ..= `lower`
//! ```
//!
//! The hips are lowered by `lower`, so that the leg with the deepest ground can reach it, and
//! [`two_bone`](super::two_bone()) moves every ankle to its target. The scheme is the usual one of games;
//! ozz-animation's sample on foot placement describes the same steps.

use super::path::{parent_to_root, pose_of};
use super::turn::{arc, share};
use super::two_bone::{EndOrientation, Pole, TwoBone, inverse, two_bone_below};
use super::{IkError, Reach};
use crate::animation::to_parent;
use crate::data::{BoneIndex, Skeleton, Transform};
use crate::trig::rotation_about;
use glam::{Mat3, Mat4, Quat, Vec3};

/// The ground below one foot: a plane, to-root space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Any point of the plane.
    pub point: Vec3,
    /// Normal of any length; a plane that is steeper than 89° or faces down is ignored.
    pub normal: Vec3,
}

/// A leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Thigh, below the hips.
    pub thigh: BoneIndex,
    /// Shin or knee joint, below the thigh.
    pub shin: BoneIndex,
    /// Foot or ankle joint, below the shin.
    pub foot: BoneIndex,
    /// Distance of the ankle from the ground when the sole is flat on it, to-root units.
    pub ankle_height: f32,
    /// The direction in which the knee bends.
    pub pole: Pole,
}

/// Hips, legs, and the limits of their movement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feet<'a> {
    /// The bone that is lowered, an ancestor of every leg.
    pub hips: BoneIndex,
    /// The legs, any number; no two share a bone.
    pub legs: &'a [Leg],
    /// To-root space, any length; usually +Y.
    pub up: Vec3,
    /// Height along `up` of the flat ground that the take was made for; usually 0.
    pub floor: f32,
    /// Largest distance by which the hips are lowered, to-root units; not below 0.
    pub lower: f32,
    /// Largest angle by which a foot is turned to the ground, in radians.
    pub tilt: f32,
    /// As in [`TwoBone::softness`].
    pub softness: f32,
    /// 0 leaves the poses unchanged bit for bit, 1 is the full solution.
    pub weight: f32,
}

/// Puts the feet on the ground and lowers the hips; returns the distance by which these were lowered.
///
/// `grounds` corresponds to the legs in order; where there is none (missing, `None`, too steep) the foot keeps its
/// position in the pose, though the hips may be lowered. A foot that is lifted by the take stays lifted by as much.
/// `to_root` are the matrices of the given poses; it is read at the parents of the hips and of the thighs and at the
/// feet. On an error nothing has moved, except where the poses of one leg contain numbers that are not finite: the legs
/// before it may have.
#[doc(alias("foot placement", "foot IK"))]
pub fn place_feet(
    skeleton: &Skeleton,
    to_root: &[Mat4],
    feet: &Feet<'_>,
    grounds: &[Option<Ground>],
    poses: &mut [Transform],
) -> Result<f32, IkError> {
    let up = feet.up.try_normalize().ok_or(IkError::NotFinite { bone: feet.hips })?;
    let parent = parent_to_root(skeleton, to_root, feet.hips)?;
    let into_parent = inverse(Mat3::from_mat4(parent)).ok_or(IkError::Flat { bone: feet.hips })?;
    pose_of(skeleton, poses, feet.hips)?;
    let weight = share(feet.weight);
    let mut lowered = 0.0_f32;
    for (index, leg) in feet.legs.iter().enumerate() {
        let ankle = check(skeleton, to_root, feet, leg, poses)?;
        let foot_target = foot_target(feet, leg, ground(grounds, index), ankle, up);
        lowered = lowered.max((ankle - foot_target.ankle).dot(up));
    }
    let most = if feet.lower >= 0.0 { feet.lower } else { 0.0 };
    let lowered = lowered.min(most) * weight;
    let hips = poses[feet.hips as usize].translation - into_parent * (up * lowered);
    if !hips.is_finite() {
        return Err(IkError::NotFinite { bone: feet.hips });
    }
    if weight == 0.0 {
        return Ok(0.0);
    }
    if lowered > 0.0 {
        poses[feet.hips as usize].translation = hips;
    }
    for (index, leg) in feet.legs.iter().enumerate() {
        let ankle = to_root[leg.foot as usize].w_axis.truncate();
        let foot_target = foot_target(feet, leg, ground(grounds, index), ankle, up);
        let thigh = parent_to_root(skeleton, to_root, leg.thigh)?;
        solve(skeleton, Mat4::from_translation(-up * lowered) * thigh, feet, leg, foot_target, poses)?;
    }
    Ok(lowered)
}

/// Target of an ankle, and rotation of its foot.
#[derive(Clone, Copy)]
struct FootTarget {
    ankle: Vec3,
    turn: Quat,
}

/// Returns the ground of leg `index`, its normal of unit length; `None` where there is none or it is too steep.
fn ground(grounds: &[Option<Ground>], index: usize) -> Option<Ground> {
    let ground = grounds.get(index).copied().flatten()?;
    let normal = ground.normal.try_normalize()?;
    ground.point.is_finite().then_some(Ground { normal, ..ground })
}

fn foot_target(feet: &Feet<'_>, leg: &Leg, ground: Option<Ground>, ankle: Vec3, up: Vec3) -> FootTarget {
    let posed = FootTarget { ankle, turn: Quat::IDENTITY };
    // cos 89°
    let Some(ground) = ground.filter(|ground| ground.normal.dot(up) > 0.017_45) else { return posed };
    let slope = ground.normal.dot(up);
    let above = (ankle - ground.point).dot(ground.normal) / slope;
    let lift = (ankle.dot(up) - feet.floor - leg.ankle_height).max(0.0);
    let target = ankle + up * (leg.ankle_height / slope + lift - above);
    let full = arc(up, ground.normal);
    let angle = 2.0 * libm::atan2f(full.xyz().length(), full.w);
    let tilt = if feet.tilt >= 0.0 { feet.tilt } else { 0.0 };
    let axis = full.xyz().try_normalize();
    let turn = axis
        .map_or(Quat::IDENTITY, |axis| rotation_about(axis.as_dvec3(), f64::from(angle.min(tilt))).as_quat());
    if target.is_finite() { FootTarget { ankle: target, turn } } else { posed }
}

/// Checks the bones of a leg and returns the position of its ankle.
fn check(
    skeleton: &Skeleton,
    to_root: &[Mat4],
    feet: &Feet<'_>,
    leg: &Leg,
    poses: &[Transform],
) -> Result<Vec3, IkError> {
    let [hips, thigh, shin, foot] = [feet.hips, leg.thigh, leg.shin, leg.foot];
    for (above, below) in [(hips, thigh), (thigh, shin), (shin, foot)] {
        pose_of(skeleton, poses, below)?;
        let mut bone = below;
        while bone != above {
            bone = skeleton.parent(bone).ok_or(IkError::NotBelow { above, below })?;
            let matrix = to_parent(&skeleton.bones[bone as usize], pose_of(skeleton, poses, bone)?);
            inverse(Mat3::from_mat4(matrix)).ok_or(IkError::Flat { bone: below })?;
        }
        if above == below {
            return Err(IkError::NotBelow { above, below });
        }
    }
    inverse(Mat3::from_mat4(parent_to_root(skeleton, to_root, thigh)?))
        .ok_or(IkError::Flat { bone: thigh })?;
    let ankle = to_root.get(foot as usize).ok_or(IkError::NoSuchBone { bone: foot })?.w_axis.truncate();
    if ankle.is_finite() { Ok(ankle) } else { Err(IkError::NotFinite { bone: foot }) }
}

fn solve(
    skeleton: &Skeleton,
    parent: Mat4,
    feet: &Feet<'_>,
    leg: &Leg,
    foot_target: FootTarget,
    poses: &mut [Transform],
) -> Result<Reach, IkError> {
    let limb = TwoBone {
        pole: leg.pole,
        softness: feet.softness,
        end_orientation: EndOrientation::TurnToRoot(foot_target.turn),
        weight: feet.weight,
        ..TwoBone::new(leg.thigh, leg.shin, leg.foot)
    };
    two_bone_below(skeleton, parent, &limb, foot_target.ankle, poses)
}
