//! Two-bone IK of a limb: shoulder, elbow, hand; or hip, knee, ankle.
//!
//! With `a` and `b` the lengths of the upper and the lower part, `d` the distance from the root to the target, the law
//! of cosines gives the angle θ between the two parts (0 is straight):
//!
//! ```text
//! d' = soft_distance(d, a + b, softness), clamped to |a - b| ..= a + b
//! cos θ = (d'² - a² - b²) / (2 a b)
//! sin θ = √((1 - cos θ)(1 + cos θ))
//!   1 + cos θ = (d' - (a - b)) (d' + (a - b)) / (2 a b)
//!   1 - cos θ = ((a + b) - d') ((a + b) + d') / (2 a b)
//! ```
//!
//! The two factors are computed from differences of lengths, so that nothing is lost where the limb is nearly straight
//! or folded. The middle turns in the plane in which the limb is already bent; then the root turns the end onto the
//! line to the target the short way; then, with a pole, about that line. The law of cosines for limbs is common
//! knowledge; the division into middle, root and pole follows Tolani, Goswami and Badler, "Real-Time Inverse Kinematics
//! Techniques for Anthropomorphic Limbs" (2000).

use super::path::{Segment, parent_to_root, pose_of, segment};
use super::turn::{arc, perpendicular, rotation_of, share, twist_towards};
use super::{IkError, Reach};
use crate::data::{BoneIndex, Skeleton, Transform};
use crate::sample::mix::slerp;
use glam::{Mat3, Mat4, Quat, Vec3};

/// The direction in which the middle bends (pole vector).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[doc(alias = "pole vector")]
pub enum Pole {
    /// As in the pose; a straight limb bends in a direction that is always the same for the same pose.
    #[default]
    AsPosed,
    /// Towards this direction, to-root space; any length. A direction along the line to the target is ignored, as if it
    /// were [`Self::AsPosed`].
    Direction(Vec3),
    /// Towards this point, to-root space. A point on the line to the target is ignored, as if it were
    /// [`Self::AsPosed`].
    Point(Vec3),
}

/// Treatment of the end's own rotation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum EndOrientation {
    /// The end keeps its rotation relative to its parent, and so turns with the limb.
    #[default]
    FollowParent,
    /// The end's axes keep their directions in to-root space.
    KeepToRoot,
    /// The end's axes are those of its pose, turned by this rotation in to-root space; by a part of it where the weight
    /// is below one.
    TurnToRoot(Quat),
    /// The rotation of the end's to-root is set to this one, as [`Transform::from_matrix`] reads it: under a mirrored
    /// parent the x axis points the other way.
    SetToRoot(Quat),
}

/// A limb of two parts, and how to move it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoBone {
    /// Shoulder or hip; it is turned.
    pub root: BoneIndex,
    /// Elbow or knee, below `root`; it is turned. Bones between the two keep their poses.
    pub middle: BoneIndex,
    /// Hand or ankle, below `middle`; it is moved to the target.
    pub end: BoneIndex,
    /// The direction in which the middle bends.
    pub pole: Pole,
    /// Share of the limb's length over which it slows down before it is straight, 0..=1; 0 is a hard stop. See
    /// [`soft_distance`].
    pub softness: f32,
    /// Treatment of the end's own rotation.
    pub end_orientation: EndOrientation,
    /// 0 leaves the pose unchanged bit for bit, 1 is the full solution; between, each rotation is slerped.
    pub weight: f32,
}

impl TwoBone {
    /// Creates a limb that bends as posed, stops hard, lets its end follow, and is solved at full weight.
    pub fn new(root: BoneIndex, middle: BoneIndex, end: BoneIndex) -> Self {
        Self {
            root,
            middle,
            end,
            pole: Pole::AsPosed,
            softness: 0.0,
            end_orientation: EndOrientation::FollowParent,
            weight: 1.0,
        }
    }
}

/// Returns the distance to which a limb of length `length` is bent when its target is `distance` away.
///
/// ```text
/// soft = softness * length,  hard = length - soft
/// d' = d                                          d ≤ hard
/// d' = hard + soft (1 - e^(-(d - hard) / soft))   d > hard
/// ```
///
/// Value and slope are continuous at `hard`, and d' approaches `length` without reaching it, so the limb does not snap
/// straight. The price: beyond `hard` the end stays short of its target by d - d'. Softness 0 (or NaN) gives min(d,
/// length). The formula is known to animators as soft IK (A. Nicholas, 2009).
pub fn soft_distance(distance: f32, length: f32, softness: f32) -> f32 {
    let soft = share(softness) * length;
    let hard = length - soft;
    if soft > 0.0 && distance > hard {
        hard + soft * (1.0 - libm::expf(-(distance - hard) / soft))
    } else {
        distance.min(length)
    }
}

/// Turns `limb` so that its end reaches `target` (to-root space), or comes as close as it can.
///
/// Out of reach, the limb is straight and points at the target; too near (the parts differ in length), it is folded and
/// points at it. A target at the root folds the limb and keeps its direction. A part without length does not bend; the
/// other one still points at the target. Where the root bone itself is scaled differently per axis, the length of the
/// lower part depends on its direction: the solve is repeated, at most eight times.
///
/// `to_root` is read at the root's parent only. Returns the distance left at full weight.
#[doc(alias = "limb IK")]
pub fn two_bone(
    skeleton: &Skeleton,
    to_root: &[Mat4],
    limb: &TwoBone,
    target: Vec3,
    poses: &mut [Transform],
) -> Result<Reach, IkError> {
    let parent = parent_to_root(skeleton, to_root, limb.root)?;
    two_bone_below(skeleton, parent, limb, target, poses)
}

/// As [`two_bone`], where the to-root matrix of the root's parent is `parent`.
pub(super) fn two_bone_below(
    skeleton: &Skeleton,
    parent: Mat4,
    limb: &TwoBone,
    target: Vec3,
    poses: &mut [Transform],
) -> Result<Reach, IkError> {
    let shape = LimbShape::of(skeleton, poses, limb)?;
    let space = LimbSpace::of(parent, limb, target)?;
    let solved = solve(&shape, &space, limb);
    let left = parent.transform_vector3(solved.end - space.target);
    let weight = share(limb.weight);
    let finite = solved.root.is_finite() && solved.middle.is_finite() && left.is_finite();
    if !finite {
        return Err(IkError::NotFinite { bone: limb.root });
    }
    if weight > 0.0 {
        let root = blend(shape.root.rotation, solved.root, weight);
        let middle = blend(shape.middle.rotation, solved.middle, weight);
        let end = end_rotation(skeleton, parent, limb, poses, &shape, (root, middle))?;
        poses[limb.root as usize].rotation = root;
        poses[limb.middle as usize].rotation = middle;
        if let Some(end) = end {
            poses[limb.end as usize].rotation = end;
        }
    }
    Ok(Reach { distance: left.length(), iterations: 1 })
}

/// The limb in its pose.
struct LimbShape {
    root: Transform,
    middle: Transform,
    upper: Segment,
    lower: Segment,
    /// Inverse of the transform between root and middle.
    from_between: Option<Mat3>,
}

impl LimbShape {
    fn of(skeleton: &Skeleton, poses: &[Transform], limb: &TwoBone) -> Result<Self, IkError> {
        let root = pose_of(skeleton, poses, limb.root)?;
        let middle = pose_of(skeleton, poses, limb.middle)?;
        let upper = segment(skeleton, poses, limb.root, limb.middle)?;
        let lower = segment(skeleton, poses, limb.middle, limb.end)?;
        let flat = IkError::Flat { bone: limb.middle };
        let from_between = upper.between.map(|matrix| inverse(matrix).ok_or(flat)).transpose()?;
        if root.scale.cmpeq(Vec3::ZERO).any() {
            return Err(flat);
        }
        Ok(Self { root, middle, upper, lower, from_between })
    }

    /// Transforms from the space of the middle's parent to the space of the root's parent, without the root's rotation.
    fn unturn(&self, vector: Vec3) -> Vec3 {
        self.root.scale * self.upper.between.map_or(vector, |between| between * vector)
    }

    /// Inverse of [`Self::unturn`].
    fn turn(&self, vector: Vec3) -> Vec3 {
        let vector = vector / self.root.scale;
        self.from_between.map_or(vector, |matrix| matrix * vector)
    }
}

/// Target and pole in the space of the root's parent.
struct LimbSpace {
    target: Vec3,
    pole: Option<Pole>,
}

impl LimbSpace {
    fn of(parent: Mat4, limb: &TwoBone, target: Vec3) -> Result<Self, IkError> {
        if !target.is_finite() {
            return Err(IkError::NotFinite { bone: limb.root });
        }
        let linear = inverse(Mat3::from_mat4(parent)).ok_or(IkError::Flat { bone: limb.root })?;
        let origin = parent.w_axis.truncate();
        let pole = match limb.pole {
            Pole::Direction(direction) => Some(Pole::Direction(linear * direction)),
            Pole::Point(point) => Some(Pole::Point(linear * (point - origin))),
            Pole::AsPosed => None,
        };
        Ok(Self { target: linear * (target - origin), pole })
    }

    /// Returns the direction from `origin` towards the pole.
    fn pole_from(&self, origin: Vec3) -> Option<Vec3> {
        let pole = match self.pole? {
            Pole::Direction(direction) => direction,
            Pole::Point(point) => point - origin,
            Pole::AsPosed => return None,
        };
        pole.try_normalize()
    }
}

/// Full rotations, and the resulting position of the end in the space of the root's parent.
struct Solved {
    root: Quat,
    middle: Quat,
    end: Vec3,
}

fn solve(shape: &LimbShape, space: &LimbSpace, limb: &TwoBone) -> Solved {
    let wanted = space.target - shape.root.translation;
    let (distance, pole) = (wanted.length(), space.pole_from(shape.root.translation));
    let rotation = shape.root.rotation;
    let upper = shape.root.scale * shape.upper.origin;
    // In the space of the middle's parent, where the rotation of the middle applies to it.
    let arm = shape.middle.scale * shape.lower.origin;
    let mut middle = shape.middle.rotation;
    let mut lower = shape.unturn(middle * arm);
    if let Some(along) = upper.try_normalize().filter(|_| lower.length_squared() > 0.0) {
        let side = side_of(lower, along, pole.map(|pole| rotation.inverse() * pole));
        for _ in 0..8 {
            let length = lower.length();
            let bent = bend(upper.length(), length, distance, limb.softness, along, side);
            let (from, to) = (middle * arm, shape.turn(bent));
            let (Some(from), Some(to)) = (from.try_normalize(), to.try_normalize()) else { break };
            middle = (arc(from, to) * middle).normalize();
            lower = shape.unturn(middle * arm);
            if (lower.length() - length).abs() <= 1e-6 * (length + upper.length()) {
                break;
            }
        }
    }
    let reach = upper + lower;
    let mut root = rotation;
    if let (Some(from), Some(to)) = ((rotation * reach).try_normalize(), wanted.try_normalize()) {
        root = arc(from, to) * rotation;
        // Turns towards the pole, about the line to the target.
        if let Some(twist) = pole.and_then(|pole| twist_towards(to, root * upper, pole)) {
            root = twist * root;
        }
    }
    let root = root.normalize();
    Solved { root, middle, end: shape.root.translation + root * reach }
}

/// Returns the unit vector at a right angle to the upper part, to which the lower part bends: as in the pose, else away
/// from the pole, else any.
fn side_of(lower: Vec3, along: Vec3, pole: Option<Vec3>) -> Vec3 {
    // Below a ten-thousandth the bend is rounding rather than intended.
    let part = lower - along * lower.dot(along);
    if part.length() > 1e-4 * lower.length() {
        return part.normalize();
    }
    let away = pole.and_then(|pole| perpendicular(-pole, along));
    away.or_else(|| part.try_normalize()).unwrap_or_else(|| along.any_orthonormal_vector())
}

/// Returns the lower part, bent so that the end has the distance from the root given by the law of cosines.
fn bend(a: f32, b: f32, distance: f32, softness: f32, along: Vec3, side: Vec3) -> Vec3 {
    let (sum, difference) = (a + b, a - b);
    let distance = soft_distance(distance, sum, softness).max(difference.abs()).min(sum);
    let twice = 2.0 * a * b;
    let more = ((distance - difference) * (distance + difference) / twice).clamp(0.0, 2.0);
    let less = ((sum - distance) * (sum + distance) / twice).clamp(0.0, 2.0);
    // The smaller factor is the more accurate one.
    let cosine = if more < less { more - 1.0 } else { 1.0 - less };
    (along * cosine + side * (more * less).sqrt()) * b
}

/// Returns the new rotation of the end; `None` to leave it unchanged.
fn end_rotation(
    skeleton: &Skeleton,
    parent: Mat4,
    limb: &TwoBone,
    poses: &[Transform],
    shape: &LimbShape,
    (root, middle): (Quat, Quat),
) -> Result<Option<Quat>, IkError> {
    if limb.end_orientation == EndOrientation::FollowParent {
        return Ok(None);
    }
    let linear = |root: Quat, middle: Quat| {
        let upper = Mat3::from_quat(root) * Mat3::from_diagonal(shape.root.scale);
        let lower = Mat3::from_quat(middle) * Mat3::from_diagonal(shape.middle.scale);
        let [first, second] = [shape.upper, shape.lower].map(|part| part.between.unwrap_or(Mat3::IDENTITY));
        Mat3::from_mat4(parent) * upper * first * lower * second
    };
    let own = pose_of(skeleton, poses, limb.end)?.rotation;
    let after = linear(root, middle);
    let back = inverse(after).ok_or(IkError::Flat { bone: limb.end })?;
    let kept = |turn: Quat| {
        let before = linear(shape.root.rotation, shape.middle.rotation);
        rotation_of(back * Mat3::from_quat(turn) * before * Mat3::from_quat(own))
    };
    let weight = share(limb.weight);
    let rotation = match limb.end_orientation {
        EndOrientation::FollowParent => None,
        EndOrientation::KeepToRoot => kept(Quat::IDENTITY),
        EndOrientation::TurnToRoot(turn) => kept(blend(Quat::IDENTITY, turn.normalize(), weight)),
        EndOrientation::SetToRoot(wanted) => {
            let set = rotation_of(back * Mat3::from_quat(wanted.normalize()));
            set.map(|set| blend(own, set, weight))
        }
    };
    rotation.filter(|rotation| rotation.is_finite()).map(Some).ok_or(IkError::NotFinite { bone: limb.end })
}

/// Interpolates from `a` to `b`; `b` itself at full weight.
fn blend(a: Quat, b: Quat, weight: f32) -> Quat {
    if weight >= 1.0 { b } else { slerp(a, b, weight) }
}

/// Returns the inverse, where there is one.
pub(super) fn inverse(matrix: Mat3) -> Option<Mat3> {
    let inverse = matrix.inverse();
    (matrix.determinant() != 0.0 && inverse.is_finite()).then_some(inverse)
}
