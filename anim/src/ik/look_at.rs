//! Look-at: a head, or several bones up to it, turns towards a point.
//!
//! The bones are processed in order. Each turns its forward axis towards the target by its share of the remaining
//! angle, so shares of 0.3, 0.5 and 1.0 for chest, neck and head give a curve, and the last bone closes the gap. In the
//! space of the bone's parent, with `f` the forward axis and `d` the direction from the bone to the target:
//!
//! ```text
//! turn  = the shortest rotation of f onto d, then (with an up direction) the twist about d that brings the bone's
//!         up axis nearest to it
//! θ     = angle of turn
//! θ'    = soft_distance(θ share fade, limit, softness)         never more than limit
//! new   = rotation about the axis of turn by θ' · old
//! ```
//!
//! `fade` falls smoothly from 1 to 0 while the target leaves the field of view, measured from the forward axis of the
//! last bone as posed: a head gives up rather than snap from one shoulder to the other.

use super::path::{parent_to_root, pose_of};
use super::turn::{arc, share, twist_towards};
use super::two_bone::{inverse, soft_distance};
use super::{IkError, Reach};
use crate::animation::to_parent;
use crate::data::{BoneIndex, Skeleton, Transform};
use crate::trig::rotation_about;
use glam::{Mat3, Mat4, Quat, Vec3};
use std::f32::consts::PI;

/// One bone that looks at the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gaze {
    /// The bone to turn.
    pub bone: BoneIndex,
    /// Axis to point at the target: bone space, any length.
    pub forward: Vec3,
    /// Axis to keep upright: bone space, any length. Only used with [`LookAt::up`].
    pub up: Vec3,
    /// Position of the eye in bone space; the line from here along `forward` meets the target. An eye that is farther
    /// from the bone's origin than the target is counts as the origin.
    pub eye: Vec3,
    /// Share of the remaining angle by which this bone turns, 0..=1.
    pub share: f32,
    /// Largest turn away from the pose in radians; π or more is no limit.
    pub limit: f32,
}

impl Gaze {
    /// Creates an entry for bone `bone`, which looks along `forward`, with the eye at its origin, share 1, and neither
    /// limit nor up axis.
    pub fn new(bone: BoneIndex, forward: Vec3) -> Self {
        Self { bone, forward, up: Vec3::ZERO, eye: Vec3::ZERO, share: 1.0, limit: PI }
    }
}

/// Several bones that look at a target, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LookAt<'a> {
    /// The bones, each a descendant of the one before; other bones may be between.
    pub bones: &'a [Gaze],
    /// Direction in which the bones' up axes are to point: to-root space, any length; `None`: no bone twists.
    pub up: Option<Vec3>,
    /// Radians from the last bone's posed forward axis to the target: up to the first all bones turn fully, from the
    /// second on nothing moves; smooth between. `[PI, PI]` or more: no target is out of view.
    pub field: [f32; 2],
    /// Share of each limit over which the turning slows down, 0..=1; 0 is a hard stop.
    pub softness: f32,
    /// 0 leaves the poses unchanged bit for bit, 1 turns each bone by its share.
    pub weight: f32,
}

impl<'a> LookAt<'a> {
    /// Creates settings for `bones` without twist, field of view or softness, at full weight.
    pub fn new(bones: &'a [Gaze]) -> Self {
        Self { bones, up: None, field: [PI, PI], softness: 0.0, weight: 1.0 }
    }
}

/// Turns the bones of `gaze` towards `target` (to-root space).
///
/// A target at a bone's own origin leaves that bone as it is; for one exactly opposite to forward the bone turns about
/// some axis at a right angle to forward, always the same. `to_root` is read at the parent of the first bone only. On
/// an error no bone has moved. Returns the distance from the target to the last bone's line of sight, or to its eye
/// where the target is opposite to it; 0 without bones.
#[doc(alias = "aim")]
pub fn look_at(
    skeleton: &Skeleton,
    to_root: &[Mat4],
    gaze: &LookAt<'_>,
    target: Vec3,
    poses: &mut [Transform],
) -> Result<Reach, IkError> {
    let Some(last) = gaze.bones.last() else { return Ok(Reach { distance: 0.0, iterations: 0 }) };
    // First pass over unchanged poses, to find every error before anything moves.
    let mut above = None;
    for one in gaze.bones {
        let parent = space_of(skeleton, to_root, poses, one.bone, above)?;
        aim(&parent, poses[one.bone as usize], one, gaze, target)?;
        above = Some((one.bone, parent));
    }
    let Some((_, parent)) = above else { return Ok(Reach { distance: 0.0, iterations: 0 }) };
    let away = angle_to(&parent, poses[last.bone as usize], last, target);
    let weight = share(gaze.weight) * fade(away, gaze.field);
    let mut above = None;
    for one in gaze.bones {
        let parent = space_of(skeleton, to_root, poses, one.bone, above)?;
        let pose = &mut poses[one.bone as usize];
        if weight > 0.0 {
            pose.rotation = aim(&parent, *pose, one, &LookAt { weight, ..*gaze }, target)?;
        }
        above = Some((one.bone, parent));
    }
    let parent = above.map_or(Mat4::IDENTITY, |(_, parent)| parent);
    let distance = miss(parent * poses[last.bone as usize].to_matrix(), last, target);
    Ok(Reach { distance, iterations: 1 })
}

/// Returns the to-root matrix of the parent of `bone`. `above` is an ancestor of `bone` and the to-root matrix of that
/// ancestor's parent; if it is `None`, the result is read from `to_root`.
fn space_of(
    skeleton: &Skeleton,
    to_root: &[Mat4],
    poses: &[Transform],
    bone: BoneIndex,
    above: Option<(BoneIndex, Mat4)>,
) -> Result<Mat4, IkError> {
    pose_of(skeleton, poses, bone)?;
    let Some((first, to_root_above)) = above else { return parent_to_root(skeleton, to_root, bone) };
    let mut matrix = Mat4::IDENTITY;
    let mut at = bone;
    loop {
        at = skeleton.parent(at).ok_or(IkError::NotBelow { above: first, below: bone })?;
        matrix = to_parent(&skeleton.bones[at as usize], pose_of(skeleton, poses, at)?) * matrix;
        if at == first {
            return Ok(to_root_above * matrix);
        }
    }
}

/// Returns the new rotation of one bone.
fn aim(parent: &Mat4, pose: Transform, one: &Gaze, gaze: &LookAt<'_>, target: Vec3) -> Result<Quat, IkError> {
    let linear = inverse(Mat3::from_mat4(*parent)).ok_or(IkError::Flat { bone: one.bone })?;
    let wanted = linear * (target - parent.w_axis.truncate()) - pose.translation;
    if !wanted.is_finite() || !pose.rotation.is_finite() {
        return Err(IkError::NotFinite { bone: one.bone });
    }
    let forward = pose.rotation * sight(pose.scale * one.forward, pose.scale * one.eye, wanted.length());
    let (Some(from), Some(to)) = (forward.try_normalize(), wanted.try_normalize()) else {
        return Ok(pose.rotation);
    };
    let mut turn = arc(from, to);
    if let Some(up) = gaze.up {
        let own = turn * (pose.rotation * (pose.scale * one.up));
        turn = twist_towards(to, own, linear * up).map_or(turn, |twist| (twist * turn).normalize());
    }
    let (axis, angle) = shortest(turn);
    let limit = if one.limit >= 0.0 { one.limit.min(PI) } else { 0.0 };
    let allowed = if limit >= PI { 0.0 } else { gaze.softness };
    let angle = soft_distance(angle * share(one.share) * share(gaze.weight), limit, allowed);
    let rotation = (rotation_about(axis.as_dvec3(), f64::from(angle)).as_quat() * pose.rotation).normalize();
    if rotation.is_finite() { Ok(rotation) } else { Err(IkError::NotFinite { bone: one.bone }) }
}

/// Returns the direction that has to point at a target `distance` away, so that the line from `eye` along `forward`
/// meets it.
///
/// It is the point of that line that is as far from the origin as the target: `eye + t f` with
/// `t = -eye·f + √((eye·f)² + distance² - |eye|²)` for unit f.
fn sight(forward: Vec3, eye: Vec3, distance: f32) -> Vec3 {
    let Some(unit) = forward.try_normalize() else { return Vec3::ZERO };
    let along = eye.dot(unit);
    let square = along * along + (distance - eye.length()) * (distance + eye.length());
    if eye == Vec3::ZERO || !(distance > eye.length() && square.is_finite()) {
        return unit;
    }
    eye + unit * (square.max(0.0).sqrt() - along)
}

/// Returns axis and angle of a rotation, 0..=π, exact for small angles.
fn shortest(turn: Quat) -> (Vec3, f32) {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let sine = turn.xyz().length();
    let axis = if sine > 0.0 { turn.xyz() / sine } else { Vec3::X };
    (axis, 2.0 * libm::atan2f(sine, turn.w))
}

/// Returns the angle in radians from the bone's forward axis to the target, in the space of its parent.
fn angle_to(parent: &Mat4, pose: Transform, one: &Gaze, target: Vec3) -> f32 {
    let Some(linear) = inverse(Mat3::from_mat4(*parent)) else { return PI };
    let wanted = linear * (target - parent.w_axis.truncate()) - pose.translation;
    let forward = pose.rotation * sight(pose.scale * one.forward, pose.scale * one.eye, wanted.length());
    match (forward.try_normalize(), wanted.try_normalize()) {
        (Some(from), Some(to)) => 2.0 * libm::atan2f((from - to).length(), (from + to).length()),
        _ => 0.0,
    }
}

/// Returns 1 up to the first angle, 0 from the second on, `1 - (3 x² - 2 x³)` between.
fn fade(angle: f32, [full, none]: [f32; 2]) -> f32 {
    if full >= PI || angle <= full {
        1.0
    } else if angle < none {
        let x = (angle - full) / (none - full);
        1.0 - x * x * (3.0 - 2.0 * x)
    } else {
        0.0
    }
}

/// Returns the distance by which the line of sight misses the target.
fn miss(to_root: Mat4, one: &Gaze, target: Vec3) -> f32 {
    let eye = to_root.transform_point3(one.eye);
    let wanted = target - eye;
    let along = to_root.transform_vector3(one.forward).normalize_or_zero();
    let distance = (wanted - along * wanted.dot(along).max(0.0)).length();
    if distance.is_finite() { distance } else { f32::MAX }
}
