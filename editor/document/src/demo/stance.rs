//! Poses of the legs: folded in flight, or reaching for a position on the ground.

use super::num::blend;
use super::skeleton::{LEG_JOINTS, leg, on_side};
use glam::{Mat3, Quat, Vec3};

/// Rotation of the trunk about the thorax joint, and position of that joint.
#[derive(Clone, Copy)]
pub(super) struct Trunk {
    pub(super) turn: Quat,
    pub(super) place: Vec3,
    /// Position of the joint in the rest pose.
    pub(super) rest: Vec3,
}

impl Trunk {
    /// Returns the position of a point that is fixed to the thorax.
    fn carry(&self, p: Vec3) -> Vec3 {
        self.place + self.turn * (p - self.rest)
    }
}

/// The directions of femur, tibia and tarsus of a folded left leg, in the thorax's own axes.
const FOLDED: [[Vec3; 3]; 3] = [
    [Vec3::new(0.50, 0.12, 0.86), Vec3::new(-0.38, -0.10, -0.92), Vec3::new(-0.10, 0.05, -0.98)],
    [Vec3::new(0.36, 0.16, -0.92), Vec3::new(-0.22, -0.18, 0.96), Vec3::new(-0.20, 0.10, 0.95)],
    [Vec3::new(0.25, 0.20, -0.95), Vec3::new(-0.30, 0.11, -0.95), Vec3::new(-0.04, 0.04, -0.99)],
];

/// A rotation that carries the rest directions of two joined pieces onto new ones, so that the
/// hinge between them keeps its axis.
fn hinge(rest: (Vec3, Vec3), now: (Vec3, Vec3), first: bool) -> Quat {
    let basis = |(a, b): (Vec3, Vec3)| {
        let axis = a.cross(b).normalize();
        let along = if first { a } else { b };
        Mat3::from_cols(along, axis, along.cross(axis))
    };
    Quat::from_mat3(&(basis(now) * basis(rest).transpose()))
}

fn rest_directions(side: usize, pair: usize) -> [Vec3; 4] {
    let joints = LEG_JOINTS[pair].map(|p| on_side(side, p));
    [0, 1, 2, 3].map(|i| (joints[i + 1] - joints[i]).normalize())
}

/// Local rotations of coxa, femur, tibia and tarsus from the pieces' directions; `turn` is the
/// thorax's own.
fn local(side: usize, pair: usize, turn: Quat, now: [Vec3; 3]) -> [Quat; 4] {
    let rest = rest_directions(side, pair);
    let femur = hinge((rest[1], rest[2]), (now[0], now[1]), true);
    let tibia = hinge((rest[1], rest[2]), (now[0], now[1]), false);
    let carried = tibia * rest[3];
    let tarsus = Quat::from_rotation_arc(carried, now[2]) * tibia;
    [Quat::IDENTITY, turn.conjugate() * femur, femur.conjugate() * tibia, tibia.conjugate() * tarsus]
}

/// The folded leg.
fn folded(side: usize, pair: usize) -> [Quat; 4] {
    let now = FOLDED[pair].map(|d| on_side(side, d.normalize()));
    local(side, pair, Quat::IDENTITY, now)
}

/// Returns the leg with its foot at its rest position plus `shift`, for any pose of the trunk.
fn standing(side: usize, pair: usize, trunk: Trunk, shift: Vec3) -> [Quat; 4] {
    let joints = LEG_JOINTS[pair].map(|p| on_side(side, p));
    let upper = (joints[2] - joints[1]).length();
    let lower = (joints[3] - joints[2]).length();
    let hip = trunk.carry(joints[1]);
    let ankle = joints[3] + shift;
    let reach = (ankle - hip).length();
    let far = (upper + lower) * 0.995;
    let span = reach.min(far);
    let toward = (ankle - hip) / reach;
    // The knee stays on the side where it is at rest: up and outwards.
    let knee_rest = trunk.turn * (joints[2] - joints[1].lerp(joints[3], 0.5));
    let pole = (knee_rest - toward * knee_rest.dot(toward)).normalize();
    let a = (upper * upper - lower * lower + span * span) / (2.0 * span);
    let rise = (upper * upper - a * a).max(0.0).sqrt();
    let knee = hip + toward * a + pole * rise;
    let end = hip + toward * span;
    let rest = rest_directions(side, pair);
    local(side, pair, trunk.turn, [(knee - hip).normalize(), (end - knee).normalize(), rest[3]])
}

/// Sets one leg in a pose: `down` 0 is folded; 1 has its foot on the ground, at its rest position plus `shift`.
pub(super) fn set(turns: &mut [Quat], side: usize, pair: usize, trunk: Trunk, shift: Vec3, down: f32) {
    let fold = folded(side, pair);
    let stand = standing(side, pair, trunk, shift);
    for part in 0..4 {
        turns[leg(side, pair, part)] = blend(fold[part], stand[part], down);
    }
}
