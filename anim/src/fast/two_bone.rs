//! Two-bone IK of one limb: shoulder, elbow, hand; or hip, knee, ankle.
//!
//! With `a` and `b` the lengths of the parts and `d` the distance from root to target, the law of cosines gives the
//! angle θ between the parts (0 is straight):
//!
//! ```text
//! d'    = d clamped to |a - b| ..= a + b, softened near a + b
//! cos θ = (d'² - a² - b²) / (2 a b)
//! ```
//!
//! The middle turns by the difference Δ to its current angle, about the axis n of its current bend; then the root turns
//! the end onto the line to the target the short way; then, with a pole, about that line. All is computed from
//! positions in to-root space with square roots only, and quaternions have any length until they are applied:
//!
//! ```text
//! 2ab sin θ = √(((a + b)² - d'²) (d'² - (a - b)²))
//! middle    = (n sin Δ, 1 + cos Δ)                   or (n (1 - cos Δ), sin Δ), the same but for its length
//! reach     = upper + lower cos Δ + n×lower sin Δ
//! q         = (reach×target, |reach| |target| + reach·target)
//! root      = q - n' q n                             with a pole: n' = pole×target / |pole×target|, n and n' as (vector, 0)
//! ```
//!
//! The last line: `q n q⁻¹` is the direction of the limb's plane after q, and `1 - n' (q n q⁻¹)` turns that to n'.
//! Where both are nearly opposite the sum is nearly zero; then `target (q + n' q n)` is used, which turns to -n' and
//! half a turn further. Each rotation is expressed in its bone's own space, where it is applied from the right, so no
//! rotation has to be computed from a matrix.

use super::matrix::{Matrix34, transform_point};
use super::pose::Pose;
use super::pose::PoseBlock;
use super::simd::{Kernel, LANES, Simd};
use super::to_root::RootPoses;
use glam::{Quat, Vec3, Vec3A, Vec4};

/// A limb of two parts, and how to move it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FastTwoBone {
    /// Shoulder or hip; it is turned.
    pub root: u32,
    /// Elbow or knee, below `root`; it is turned.
    pub middle: u32,
    /// Hand or ankle, below `middle`; it is moved to the target.
    pub end: u32,
    /// Direction in which the middle bends, to-root space; zero: as in the pose.
    pub pole: Vec3,
    /// Share of the limb's length over which it slows down before it is straight, 0..=1; 0 is a hard stop.
    pub softness: f32,
    /// 0 (and NaN) leaves the pose unchanged bit for bit, 1 is the full solution; between, the rotations are shortened.
    pub weight: f32,
}

impl FastTwoBone {
    /// Creates a limb that bends as posed, stops hard and is solved at full weight.
    pub fn new(root: u32, middle: u32, end: u32) -> Self {
        Self { root, middle, end, pole: Vec3::ZERO, softness: 0.0, weight: 1.0 }
    }
}

/// Turns `limb` in `pose` so that its end reaches `target` (to-root space), or comes as close as it can. Returns
/// whether anything was turned.
///
/// `to_root` is that of `pose` ([`super::to_root()`]) and has to be computed again afterwards. Exact where the scales
/// of the limb and above it are the same along all axes, mirrored or not. Nothing is changed where a bone is missing, a
/// part has no length, or a number is not finite. Allocates nothing.
pub fn two_bone(limb: &FastTwoBone, target: Vec3, to_root: &RootPoses, pose: &mut Pose) -> bool {
    to_root.level.run(Solve { limb, target, to_root, pose })
}

/// A kernel only because the compiler makes shorter code of the same operations there: results are the same bit for bit
/// at all levels.
struct Solve<'a> {
    limb: &'a FastTwoBone,
    target: Vec3,
    to_root: &'a RootPoses,
    pose: &'a mut Pose,
}

impl Kernel for Solve<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self) -> bool {
        let Self { limb, target, to_root, pose } = self;
        let blocks = pose.blocks_mut();
        let Some(root) = to_root.bone(limb.root) else { return false };
        let Some(middle) = to_root.bone(limb.middle) else { return false };
        let Some(end) = to_root.bone(limb.end) else { return false };
        let mut turns = solve(limb, target.into(), [root, middle, end]);
        // NaN fails the comparison, and so does not count as full weight.
        let is_whole = limb.weight >= 1.0;
        if !is_whole {
            turns = turns.map(|turn| shortened(turn, limb.weight));
        }
        let rotation = |bone: u32| Some(rotation_of(blocks.get(bone as usize / LANES)?, bone));
        let (Some(upper), Some(lower)) = (rotation(limb.root), rotation(limb.middle)) else { return false };
        let (upper, lower) = (upper * turns[0], lower * turns[1]);
        let (square, other) = (upper.length_squared(), lower.length_squared());
        let is_finite = square + other < f32::INFINITY;
        if !is_finite || least(square, other) < f32::MIN_POSITIVE {
            return false;
        }
        if limb.weight > 0.0 {
            set_rotation(blocks, limb.root, upper * (1.0 / square.sqrt()));
            set_rotation(blocks, limb.middle, lower * (1.0 / other.sqrt()));
        }
        true
    }
}

#[inline(always)]
fn rotation_of(block: &PoseBlock, bone: u32) -> Quat {
    let ([x, y, z, w], lane) = (&block.rotation, bone as usize % LANES);
    Quat::from_xyzw(x[lane], y[lane], z[lane], w[lane])
}

#[inline(always)]
fn set_rotation(blocks: &mut [PoseBlock], bone: u32, rotation: Quat) {
    if let Some(block) = blocks.get_mut(bone as usize / LANES) {
        let ([x, y, z, w], lane) = (&mut block.rotation, bone as usize % LANES);
        (x[lane], y[lane], z[lane], w[lane]) = (rotation.x, rotation.y, rotation.z, rotation.w);
    }
}

/// Returns the rotations of root and middle, each in its own space and of any length; not finite, or zero, where there
/// is none.
#[inline(always)]
fn solve(limb: &FastTwoBone, target: Vec3A, [root, middle, end]: [&Matrix34; 3]) -> [Quat; 2] {
    let (origin, elbow) = (origin_of(root), origin_of(middle));
    let (upper, lower, wanted) = (elbow - origin, origin_of(end) - elbow, target - origin);
    let (a2, b2, d2) = (upper.length_squared(), lower.length_squared(), wanted.length_squared());
    let (a, b) = (a2.sqrt(), b2.sqrt());
    let (sum, difference) = (a + b, a - b);
    let distance = least(most(softened(d2.sqrt(), sum, limb.softness), difference.abs()), sum);
    // 2ab (1 + cos θ) and 2ab (1 - cos θ).
    let more = (distance - difference) * (distance + difference);
    let less = (sum - distance) * (sum + distance);
    let (cosine, sine) = (0.5 * (more - less), (more * less).sqrt());
    let cross = upper.cross(lower);
    let (flat, both) = (cross.length_squared(), a2 * b2);
    let (now, bent) = (upper.dot(lower), flat.sqrt());
    let axis =
        if flat > 1e-8 * both { cross * (1.0 / bent) } else { any_axis(lower * now, wanted, limb.pole) };
    let part = 0.5 / both;
    let (by_sine, by_cosine) = ((sine * now - cosine * bent) * part, (cosine * now + sine * bent) * part);
    let bend = if by_cosine >= 0.0 { (by_sine, 1.0 + by_cosine) } else { (1.0 - by_cosine, by_sine) };
    let reach = upper + lower * by_cosine + axis.cross(lower) * by_sine;
    let (along, reach2) = (reach.dot(wanted), reach.length_squared());
    let lengths = (reach2 * d2).sqrt();
    let mut turn = quat(reach.cross(wanted), lengths + along);
    if along < -0.9 * lengths {
        turn = nearly_opposite(reach, wanted, axis);
    }
    if limb.pole != Vec3::ZERO {
        let pole = Vec3A::from(limb.pole);
        let facing = pole.cross(wanted);
        let square = facing.length_squared();
        // On the line to the target neither a pole nor a middle has a side.
        if square > 1e-12 * pole.length_squared() * d2 && more * less > 4e-12 * a2 * reach2 {
            turn = twisted(turn, axis, facing * (1.0 / square.sqrt()), wanted, d2);
        }
    }
    [local(root, turn), local(middle, quat(axis * bend.0, bend.1))]
}

/// Returns `(vector, w)`.
#[inline(always)]
fn quat(vector: Vec3A, w: f32) -> Quat {
    Quat::from_vec4(vector.extend(w))
}

/// Returns the position of a bone's origin.
#[inline(always)]
fn origin_of(matrix: &Matrix34) -> Vec3A {
    Vec3A::new(matrix[3], matrix[7], matrix[11])
}

/// Converts a rotation in to-root space to a bone's space, with another length. Scales are the same along all axes.
///
/// A rotation's axis is transformed like any vector, except for mirrored bones: there the rotation is reversed.
#[inline(always)]
fn local(matrix: &Matrix34, turn: Quat) -> Quat {
    let (x, y, z) =
        (Vec4::from_slice(matrix), Vec4::from_slice(&matrix[4..]), Vec4::from_slice(&matrix[8..]));
    let (first, second, third) = (Vec3A::from_vec4(x), Vec3A::from_vec4(y), Vec3A::from_vec4(z));
    // The determinant is the cubed scale, with the sign of mirroring.
    let scale = first.cross(second).dot(third) / first.length_squared();
    quat(Vec3A::from_vec4(x * turn.x + y * turn.y + z * turn.z), turn.w * scale)
}

/// Returns the larger; `other` where either is NaN. One instruction.
#[inline(always)]
fn most(one: f32, other: f32) -> f32 {
    if one > other { one } else { other }
}

/// Returns the smaller; `other` where either is NaN. One instruction.
#[inline(always)]
fn least(one: f32, other: f32) -> f32 {
    if one < other { one } else { other }
}

/// Approaches `length` without reaching it, over a share of it: `hard + soft (1 - e^(-(d - hard) / soft))`.
#[inline(always)]
fn softened(distance: f32, length: f32, softness: f32) -> f32 {
    if softness > 0.0 {
        let soft = softness.min(1.0) * length;
        let hard = length - soft;
        if soft > 0.0 && distance > hard {
            return hard + soft * (1.0 - libm::expf(-(distance - hard) / soft));
        }
    }
    distance
}

/// Returns a unit axis about which a limb can bend whose two parts are on one line with direction `along`. The bend is
/// towards the pole, else towards `wanted`, else to any side.
#[cold]
fn any_axis(along: Vec3A, wanted: Vec3A, pole: Vec3) -> Vec3A {
    let along = along.normalize_or_zero();
    let across = |vector: Vec3A| {
        let axis = vector.cross(along);
        // For a vector on the line, the cross product is nothing but rounding errors, and its direction is random.
        let is_sure = axis.length_squared() > 1e-8 * vector.length_squared();
        axis.try_normalize().filter(|_| is_sure)
    };
    across(pole.into()).or_else(|| across(wanted)).unwrap_or_else(|| along.any_orthonormal_vector())
}

/// Returns the short rotation from the direction of `from` to that of `to`, which are nearly opposite; about `axis`
/// where they are exactly opposite.
#[cold]
fn nearly_opposite(from: Vec3A, to: Vec3A, axis: Vec3A) -> Quat {
    let turn = arc(from, to, axis);
    // The axis of nearly half a turn is not exact; the remaining angle is small.
    arc(turn.mul_vec3a(from), to, axis) * turn
}

fn arc(from: Vec3A, to: Vec3A, axis: Vec3A) -> Quat {
    let lengths = (from.length_squared() * to.length_squared()).sqrt();
    let sum = lengths + from.dot(to);
    if sum > 1e-6 * lengths { quat(from.cross(to), sum).normalize() } else { quat(axis, 0.0) }
}

/// Returns `turn`, followed by the rotation about `line`, whose length has the square `square`, that turns `axis` to
/// `facing`; both are unit vectors.
#[inline(always)]
fn twisted(turn: Quat, axis: Vec3A, facing: Vec3A, line: Vec3A, square: f32) -> Quat {
    let other = quat(facing, 0.0) * (turn * quat(axis, 0.0));
    if turn.dot(other) <= 0.0 {
        turn - other
    } else {
        quat(line * (1.0 / square.sqrt()), 0.0) * (turn + other)
    }
}

/// Returns the rotation by `weight` times the angle of `turn`, a quaternion of any length, the short way.
#[cold]
fn shortened(turn: Quat, weight: f32) -> Quat {
    let weight = if weight > 0.0 { weight } else { 0.0 };
    crate::sample::mix::slerp(Quat::IDENTITY, turn.normalize(), weight)
}

/// Returns the distance of the end of `limb` from `target`, from the to-root matrices.
pub fn distance_left(limb: &FastTwoBone, target: Vec3, to_root: &RootPoses) -> f32 {
    (transform_point(to_root.get(limb.end as usize), Vec3::ZERO) - target).length()
}
