//! A limb of two parts that reaches for a point: shoulder, elbow, hand; or hip, knee, ankle.
//!
//! With `a` and `b` the lengths of the parts and `d` the distance from root to target, the law of cosines gives the
//! angle θ between the parts (0 is straight):
//!
//! ```text
//! d'    = d kept within |a - b| ..= a + b, softened near a + b
//! cos θ = (d'² - a² - b²) / (2 a b)
//! ```
//!
//! The middle turns by the difference to the angle it has, about the axis it is bent about; then the root turns the end
//! onto the line to the target the short way; then, with a pole, about that line. All is computed from places in to-root
//! space with square roots only: the rotation by an angle whose cosine is c is `(axis √((1-c)/2), √((1+c)/2))`. Each turn is
//! then told in its bone's own space, where it is applied from the right, so nobody's rotation has to be read off a matrix.

use super::matrix::{Matrix34, transform_point};
use super::pose::Pose;
use super::to_root::RootPoses;
use glam::{Quat, Vec3};

/// A limb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoBone {
    /// Shoulder or hip: turns.
    pub root: u32,
    /// Elbow or knee, below `root`: turns.
    pub middle: u32,
    /// Hand or ankle, below `middle`: meets the target.
    pub end: u32,
    /// The middle bends towards this direction, to-root space; zero: as the pose bends it.
    pub pole: Vec3,
    /// Share of the limb's length over which it slows down before it is straight, 0..=1; 0 is a hard stop.
    pub softness: f32,
    /// 0 keeps the pose, 1 is the full solution; between, the turns are shortened.
    pub weight: f32,
}

impl TwoBone {
    /// A limb that bends as posed, stops hard and is solved at full weight.
    pub fn new(root: u32, middle: u32, end: u32) -> Self {
        Self { root, middle, end, pole: Vec3::ZERO, softness: 0.0, weight: 1.0 }
    }
}

/// Turns `limb` in `pose` so that its end comes to `target` (to-root space), or as near as it can; was there anything
/// to turn?
///
/// `to_root` is that of `pose` ([`super::to_root()`]) and has to be computed again afterwards. Exact where the scales of
/// the limb and above it are the same along all axes. Nothing is changed where a bone is missing, a part has no length, or
/// a number is not finite. Allocates nothing.
pub fn two_bone(limb: &TwoBone, target: Vec3, to_root: &RootPoses, pose: &mut Pose) -> bool {
    let bones = [limb.root, limb.middle, limb.end].map(|bone| to_root.matrices().get(bone as usize));
    let [Some(root), Some(middle), Some(end)] = bones else { return false };
    let Some((root_turn, middle_turn)) = solve(limb, target, [root, middle, end]) else { return false };
    let weight = if limb.weight > 0.0 { limb.weight.min(1.0) } else { 0.0 };
    for (bone, turn) in [(limb.root, root_turn), (limb.middle, middle_turn)] {
        let turn = if weight < 1.0 { shortened(turn, weight) } else { turn };
        let block = pose.blocks_mut().get_mut(bone as usize / 8);
        let Some(block) = block else { return false };
        let lane = bone as usize % 8;
        let [x, y, z, w] = block.rotation.each_mut().map(|row| &mut row[lane]);
        let turned = (Quat::from_xyzw(*x, *y, *z, *w) * turn).normalize();
        (*x, *y, *z, *w) = (turned.x, turned.y, turned.z, turned.w);
    }
    true
}

/// The turns of root and middle, each in its own space.
#[inline]
fn solve(limb: &TwoBone, target: Vec3, [root, middle, end]: [&Matrix34; 3]) -> Option<(Quat, Quat)> {
    let origin = place(root);
    let (upper, lower, wanted) = (place(middle) - origin, place(end) - place(middle), target - origin);
    let (a2, b2, d2) = (upper.length_squared(), lower.length_squared(), wanted.length_squared());
    let (a, b) = (a2.sqrt(), b2.sqrt());
    let distance = softened(d2.sqrt(), a + b, limb.softness).clamp((a - b).abs(), a + b);
    let twice = 2.0 * a * b;
    let (now, then) = (2.0 * upper.dot(lower) / twice, (distance * distance - a2 - b2) / twice);
    if !(now + then + d2).is_finite() || d2 == 0.0 {
        return None;
    }
    let (now, then) = (now.clamp(-1.0, 1.0), then.clamp(-1.0, 1.0));
    let axis = bending_axis(upper, lower, wanted, limb.pole);
    // The angle between two angles: cosine and sine of the difference.
    let (sine_now, sine_then) = ((1.0 - now * now).sqrt(), (1.0 - then * then).sqrt());
    let bend = half_turn(then * now + sine_then * sine_now, sine_then * now - then * sine_now);
    let bent = upper + turned(lower, axis * bend.0, bend.1);
    let mut turn = arc(bent, wanted, axis);
    if bent.dot(wanted) < -0.9 * (bent.length_squared() * d2).sqrt() {
        // The axis of nearly half a turn is not exact; what is left of the way is short.
        turn = arc(turn * bent, wanted, axis) * turn;
    }
    if limb.pole != Vec3::ZERO {
        turn = (twist(turn * upper, wanted, limb.pole) * turn).normalize();
    }
    // Into the spaces of the bones: a turn's axis is a vector like any other.
    let root_turn = Quat::from_vec4(local(root, turn.xyz()).extend(turn.w)).normalize();
    let middle_turn = Quat::from_vec4((local(middle, axis) * bend.0).extend(bend.1)).normalize();
    (root_turn.is_finite() && middle_turn.is_finite()).then_some((root_turn, middle_turn))
}

/// Where a bone's origin is.
#[inline]
fn place(matrix: &Matrix34) -> Vec3 {
    Vec3::new(matrix[3], matrix[7], matrix[11])
}

/// `vector` of to-root space in a bone's space, of the same length; scales are the same along all axes.
#[inline]
fn local(matrix: &Matrix34, vector: Vec3) -> Vec3 {
    let [x, y, z] = [0, 4, 8].map(|row| Vec3::new(matrix[row], matrix[row + 1], matrix[row + 2]));
    let scale = Vec3::new(x.x, y.x, z.x).length_squared().sqrt();
    (x * vector.x + y * vector.y + z * vector.z) / scale
}

/// Nears `length` without meeting it, over a share of it: `hard + soft (1 - e^(-(d - hard) / soft))`.
#[inline]
fn softened(distance: f32, length: f32, softness: f32) -> f32 {
    let soft = softness.clamp(0.0, 1.0) * length;
    let hard = length - soft;
    if soft > 0.0 && distance > hard {
        hard + soft * (1.0 - (-(distance - hard) / soft).exp())
    } else {
        distance
    }
}

/// The unit vector about which the limb bends: as it is bent, else towards the pole, else any.
#[inline]
fn bending_axis(upper: Vec3, lower: Vec3, wanted: Vec3, pole: Vec3) -> Vec3 {
    let as_posed = upper.cross(lower);
    let square = as_posed.length_squared();
    if square > 1e-8 * upper.length_squared() * lower.length_squared() {
        return as_posed / square.sqrt();
    }
    let straight = [pole.cross(upper), wanted.cross(upper)];
    straight.into_iter().find_map(Vec3::try_normalize).unwrap_or_else(|| upper.any_orthonormal_vector())
}

/// Sine (with the sign of `sine`) and cosine of half an angle, from the cosine and sine of the angle.
#[inline]
fn half_turn(cosine: f32, sine: f32) -> (f32, f32) {
    let half = ((1.0 + cosine).max(0.0) * 0.5).sqrt();
    if half > 0.5 {
        // Better than from the cosine where the angle is small.
        return (sine / (2.0 * half), half);
    }
    (((1.0 - cosine).max(0.0) * 0.5).sqrt().copysign(sine), half)
}

/// `vector` turned by the unit quaternion (`xyz`, `w`).
#[inline]
fn turned(vector: Vec3, xyz: Vec3, w: f32) -> Vec3 {
    let twice = 2.0 * xyz.cross(vector);
    vector + w * twice + xyz.cross(twice)
}

/// The short turn that takes the direction of `from` to that of `to`; about `axis` where they are opposite.
#[inline]
fn arc(from: Vec3, to: Vec3, axis: Vec3) -> Quat {
    let lengths = (from.length_squared() * to.length_squared()).sqrt();
    let (sum, cross) = (lengths + from.dot(to), from.cross(to));
    let turn = Quat::from_xyzw(cross.x, cross.y, cross.z, sum);
    if sum > 1e-6 * lengths { turn.normalize() } else { Quat::from_vec4(axis.extend(0.0)) }
}

/// The turn about the line to the target that brings the middle to the side of the pole.
#[inline]
fn twist(upper: Vec3, wanted: Vec3, pole: Vec3) -> Quat {
    let along = |vector: Vec3| vector - wanted * (vector.dot(wanted) / wanted.length_squared());
    let (from, to) = (along(upper), along(pole));
    let enough = from.length_squared() > 1e-12 * upper.length_squared()
        && to.length_squared() > 1e-12 * pole.length_squared();
    if !enough {
        return Quat::IDENTITY;
    }
    arc(from, to, wanted.normalize_or_zero())
}

/// `weight` of a turn, the short way.
#[inline]
fn shortened(turn: Quat, weight: f32) -> Quat {
    crate::sample::mix::slerp(Quat::IDENTITY, turn, weight)
}

/// How far the end of `limb` is from `target`, from the to-root matrices.
pub fn distance_left(limb: &TwoBone, target: Vec3, to_root: &RootPoses) -> f32 {
    (transform_point(to_root.get(limb.end as usize), Vec3::ZERO) - target).length()
}
