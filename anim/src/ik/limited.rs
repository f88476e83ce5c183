//! IK of a chain whose joints have limits: from the pose that the sweeps have reached to one that meets the goal.
//!
//! A sweep works on points. It does not consider that a joint is at its limit, nor how free joints could compensate for
//! that, so it stops short of targets that can be reached. Here all joints move together, by damped least squares
//! within the freedom that the limits leave:
//!
//! ```text
//! d_k  = the part of a small turn about axis k that the limit allows, divided by the size of the turn
//! a_k  = linear part of to-root above the joint * (d_k × (end - joint))            how d_k moves the end
//! x_k  = a_k · (A Aᵀ + μ I)⁻¹ (goal - end)                                         A has the columns a_k
//! q   ← limit(turn by Σ x_k d_k, then q)                                           Σ over the axes of the joint
//! ```
//!
//! Every joint has two axes, across the line to the end. The limit is an opaque function, so it is probed with a small
//! turn, once to the side to which the step would go if there were no limits. A joint that can turn to one side only
//! contributes when the step goes there (`x_k > 0`), and the step is computed again without those that would go the
//! other way. A step that does not bring the end nearer is halved, and the damping μ grows.
//!
//! (C. W. Wampler: "Manipulator inverse kinematic solutions based on vector formulations and damped least-squares
//! methods", IEEE Transactions on Systems, Man and Cybernetics 16, 1986.)
//!
//! Limits cause local minima from which no small step leads out. So a search that does not meet the goal starts again
//! from other poses, always the same ones, until one does.

use super::chain::{ChainScratch, Limit};
use crate::data::BoneIndex;
use crate::joint::rotation_vector;
use crate::sample::Value;
use crate::trig::rotation_of_vector;
use glam::{DMat3, DQuat, DVec3};

/// Number of poses from which the search starts, including the one of the sweeps.
pub(super) const STARTS: u32 = 12;

/// Largest number of steps from one pose.
pub(super) const STEPS: u32 = 24;

/// Smallest improvement, as a share of the chain's length, for which another pose is searched or used, so that a figure
/// does not jump from one to another without need.
const WORTH: f64 = 1e-3;

/// Angle by which a joint is turned to probe its limit, in radians. Well above the slack of a limit.
const PROBE: f64 = 5e-3;

/// Largest turn of a joint in one step, in radians; beyond it the linear approximation is too inaccurate.
const STRIDE: f64 = 0.6;

/// Number of times a step is halved before it is given up.
const HALVINGS: u32 = 4;

/// Freedom of one joint, in the space of its parent.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Freedom {
    /// `d_k`: turns that the limit allows, as axis times angle.
    turns: [DVec3; 2],
    /// `a_k`: how each moves the end.
    moves: [DVec3; 2],
    /// `x_k`: share of each in the step.
    shares: [f64; 2],
}

impl ChainScratch {
    /// Searches rotations within the limits with which the end meets `goal`; leaves the best, and their joints, in the
    /// links.
    pub(super) fn search(&mut self, goal: DVec3, tolerance: f64, limit: Limit<'_>) {
        let mut nearest = self.gap(goal);
        let total: f64 = self.lengths.iter().sum();
        for start in 0..STARTS {
            let worth = if start == 0 { 0.0 } else { WORTH * total };
            if nearest <= tolerance.max(worth) {
                break;
            }
            if start > 0 {
                self.restart(start);
            }
            self.apply_limits(limit);
            self.descend(goal, tolerance, total, limit);
            if self.gap(goal) < nearest - worth {
                nearest = self.gap(goal);
                self.links.iter_mut().for_each(|link| link.best = link.rotation);
            }
        }
        self.links.iter_mut().for_each(|link| link.rotation = link.best);
        self.update_joints();
    }

    /// Sets another start pose: every joint turned at random from its posed rotation, further from start to start.
    fn restart(&mut self, start: u32) {
        let most = [0.8, 1.6, 2.4, 3.1][start as usize % 4];
        for (index, link) in self.links.iter_mut().enumerate() {
            let turn = scattered(start, index as u32) * most;
            link.rotation = (rotation_of_vector(turn) * link.posed.rotation.as_dquat()).normalize();
        }
    }

    /// Applies the limit to every joint.
    fn apply_limits(&mut self, limit: Limit<'_>) {
        let turning = self.lengths.len();
        for link in &mut self.links[..turning] {
            link.rotation = limited(limit, link.bone, link.rotation);
        }
        self.update_joints();
    }

    /// Makes steps until the goal is met or no step helps.
    fn descend(&mut self, goal: DVec3, tolerance: f64, total: f64, limit: Limit<'_>) {
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let before = self.gap(goal);
            if before <= tolerance || !before.is_finite() {
                break;
            }
            self.probe_limits(goal, damping * total * total, limit);
            if !self.step(goal, before, limit) {
                if damping > 0.5 {
                    break;
                }
                damping *= 30.0;
                continue;
            }
            damping = (damping * 0.2).max(1e-6);
            if self.gap(goal) > 0.995 * before && damping < 1e-4 {
                break;
            }
        }
    }

    /// Computes the freedom of every joint and its share in the step.
    fn probe_limits(&mut self, goal: DVec3, damping: f64, limit: Limit<'_>) {
        let turning = self.lengths.len();
        let end = self.joints[turning];
        let mut linear = DMat3::IDENTITY;
        for index in 0..turning {
            let inverse = linear.inverse();
            let arm = inverse * (end - self.joints[index]);
            let free = &mut self.freedoms[index];
            *free = Freedom::default();
            if let Some(along) = arm.try_normalize().filter(|_| inverse.is_finite()) {
                free.turns = <[DVec3; 2]>::from(along.any_orthonormal_pair());
                free.moves = free.turns.map(|turn| linear * turn.cross(arm));
            }
            linear *= self.links[index].linear();
        }
        let missing = goal - end;
        let pull = self.pull(missing, damping, |_| true);
        let mut linear = DMat3::IDENTITY;
        for index in 0..turning {
            let arm = linear.inverse() * (end - self.joints[index]);
            let link = self.links[index];
            let free = &mut self.freedoms[index];
            for (turn, moved) in free.turns.iter_mut().zip(&mut free.moves) {
                let direction = if moved.dot(pull) < 0.0 { -*turn } else { *turn };
                let wanted = (rotation_of_vector(direction * PROBE) * link.rotation).normalize();
                let got = limited(limit, link.bone, wanted) * link.rotation.conjugate();
                *turn = rotation_vector(got) / PROBE;
                *moved = linear * turn.cross(arm);
                if !moved.is_finite() || turn.length() < 0.02 {
                    (*turn, *moved) = (DVec3::ZERO, DVec3::ZERO);
                }
            }
            linear *= link.linear();
        }
        let mut pull = self.pull(missing, damping, |_| true);
        for _ in 0..3 {
            let last = pull;
            pull = self.pull(missing, damping, |moved| moved.dot(last) > 0.0);
        }
        for free in &mut self.freedoms[..turning] {
            free.shares = free.moves.map(|moved| moved.dot(pull).max(0.0));
        }
    }

    /// Returns `(A Aᵀ + μ I)⁻¹ missing` over the columns for which `counts` returns true.
    fn pull(&self, missing: DVec3, damping: f64, counts: impl Fn(DVec3) -> bool) -> DVec3 {
        let mut sum = DMat3::from_diagonal(DVec3::splat(damping));
        let moves = self.freedoms.iter().flat_map(|free| free.moves);
        for moved in moves.filter(|&moved| counts(moved)) {
            sum += DMat3::from_cols(moved * moved.x, moved * moved.y, moved * moved.z);
        }
        let pull = sum.inverse() * missing;
        if pull.is_finite() { pull } else { DVec3::ZERO }
    }

    /// Makes the step, or half of it, or half of that, whichever is the first that helps. Returns whether one helped.
    fn step(&mut self, goal: DVec3, before: f64, limit: Limit<'_>) -> bool {
        let turning = self.lengths.len();
        let widest = self.freedoms[..turning].iter().map(|free| free.turn().length()).fold(0.0, f64::max);
        if widest <= 0.0 || !widest.is_finite() {
            return false;
        }
        let mut size = (STRIDE / widest).min(1.0);
        self.links.iter_mut().for_each(|link| link.previous = link.rotation);
        for _ in 0..=HALVINGS {
            for (link, free) in self.links[..turning].iter_mut().zip(&self.freedoms) {
                let wanted = (rotation_of_vector(free.turn() * size) * link.previous).normalize();
                link.rotation = limited(limit, link.bone, wanted);
            }
            self.update_joints();
            if self.gap(goal) < before {
                return true;
            }
            size *= 0.5;
        }
        self.links.iter_mut().for_each(|link| link.rotation = link.previous);
        self.update_joints();
        false
    }
}

impl Freedom {
    /// Returns the joint's own step.
    fn turn(&self) -> DVec3 {
        self.turns[0] * self.shares[0] + self.turns[1] * self.shares[1]
    }
}

/// Returns a rotation with the limit applied.
pub(super) fn limited(limit: Limit<'_>, bone: BoneIndex, wanted: DQuat) -> DQuat {
    let wanted = wanted.as_quat().normalize();
    limit(bone, wanted).healed(wanted).as_dquat().normalize()
}

/// Returns a pseudo-random point of the cube from -1 to 1, which depends on start and bone only.
fn scattered(start: u32, bone: u32) -> DVec3 {
    let mut state = (u64::from(start) << 32 | u64::from(bone)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mut next = || {
        // SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014).
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    DVec3::new(next(), next(), next())
}
