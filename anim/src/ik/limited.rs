//! A chain whose joints have limits: from a pose that is as near as sweeps have brought it to one that meets the goal.
//!
//! A sweep works on points. It does not see that a joint stands at its limit, nor how those that are free could make up
//! for it, so it stops short of targets that can be reached. Here all joints move together, damped least squares on what
//! the limits leave free:
//!
//! ```text
//! d_k  = what is left of a small turn about axis k once the limit has had its say, divided by the size of the turn
//! a_k  = linear part of to-root above the joint * (d_k × (end - joint))            how d_k moves the end
//! x_k  = a_k · (A Aᵀ + μ I)⁻¹ (goal - end)                                         A has the columns a_k
//! q   ← limit(turn by Σ x_k d_k, then q)                                           Σ over the axes of the joint
//! ```
//!
//! Every joint has two axes, across the line to the end. The limit is a function of which nothing is known, so it is asked
//! what it leaves of a small turn, once to the side to which the step would go if there were no limits. A joint that may
//! go to one side only takes part when the step goes there (`x_k > 0`), and the step is found again without those that
//! would go the other way. A step that does not bring the end nearer is halved, and the damping μ grows.
//!
//! (C. W. Wampler: "Manipulator inverse kinematic solutions based on vector formulations and damped least-squares
//! methods", IEEE Transactions on Systems, Man and Cybernetics 16, 1986.)
//!
//! Limits make hollows from which no small step leads out. So a search that does not meet the goal begins anew from other
//! poses, always the same ones, until one does.

use super::chain::{ChainScratch, Limit};
use crate::data::BoneIndex;
use crate::joint::rotation_vector;
use crate::sample::Value;
use glam::{DMat3, DQuat, DVec3};

/// Poses from which the search begins, the one that the sweeps have left counted.
pub(super) const STARTS: u32 = 12;

/// Steps from one pose.
pub(super) const STEPS: u32 = 24;

/// Share of the chain's length: for less than this no other pose is looked for or taken, so that a figure does not jump
/// from one to another for nothing.
const WORTH: f64 = 1e-3;

/// Radians: how far a joint is turned to see what its limit leaves of it. Well above the slack of a limit.
const PROBE: f64 = 5e-3;

/// Radians: no joint turns further in one step, because beyond that a turn is no longer what its beginning says.
const STRIDE: f64 = 0.6;

/// How often a step is halved before it is given up.
const HALVINGS: u32 = 4;

/// What one joint can do, in the space of its parent.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Freedom {
    /// `d_k`: turns that the limit allows, as axis times angle.
    turns: [DVec3; 2],
    /// `a_k`: how each moves the end.
    moves: [DVec3; 2],
    /// `x_k`.
    shares: [f64; 2],
}

impl ChainScratch {
    /// Looks for rotations within the limits with which the end meets `goal`; leaves the best in the links, and the
    /// joints that belong to them.
    pub(super) fn search(&mut self, goal: DVec3, tolerance: f64, limit: Limit<'_>) {
        let mut nearest = self.gap(goal);
        let total: f64 = self.lengths.iter().sum();
        for start in 0..STARTS {
            let worth = if start == 0 { 0.0 } else { WORTH * total };
            if nearest <= tolerance.max(worth) {
                break;
            }
            if start > 0 {
                self.begin_anew(start);
            }
            self.hold(limit);
            self.descend(goal, tolerance, total, limit);
            if self.gap(goal) < nearest - worth {
                nearest = self.gap(goal);
                self.links.iter_mut().for_each(|link| link.best = link.rotation);
            }
        }
        self.links.iter_mut().for_each(|link| link.rotation = link.best);
        self.place();
    }

    /// Another pose: every joint turned at random from where it was posed, further from start to start.
    fn begin_anew(&mut self, start: u32) {
        let most = [0.8, 1.6, 2.4, 3.1][start as usize % 4];
        for (index, link) in self.links.iter_mut().enumerate() {
            let turn = scattered(start, index as u32) * most;
            link.rotation = (DQuat::from_scaled_axis(turn) * link.posed.rotation.as_dquat()).normalize();
        }
    }

    /// Brings every joint within its limit.
    fn hold(&mut self, limit: Limit<'_>) {
        let turning = self.lengths.len();
        for link in &mut self.links[..turning] {
            link.rotation = limited(limit, link.bone, link.rotation);
        }
        self.place();
    }

    /// Steps until the goal is met or no step helps.
    fn descend(&mut self, goal: DVec3, tolerance: f64, total: f64, limit: Limit<'_>) {
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let before = self.gap(goal);
            if before <= tolerance || !before.is_finite() {
                break;
            }
            self.look(goal, damping * total * total, limit);
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

    /// Fills in what every joint can do and how much of it the step takes.
    fn look(&mut self, goal: DVec3, damping: f64, limit: Limit<'_>) {
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
                let way = if moved.dot(pull) < 0.0 { -*turn } else { *turn };
                let wish = (DQuat::from_scaled_axis(way * PROBE) * link.rotation).normalize();
                let got = limited(limit, link.bone, wish) * link.rotation.conjugate();
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

    /// `(A Aᵀ + μ I)⁻¹ missing` over the columns that `counts` lets in.
    fn pull(&self, missing: DVec3, damping: f64, counts: impl Fn(DVec3) -> bool) -> DVec3 {
        let mut sum = DMat3::from_diagonal(DVec3::splat(damping));
        let moves = self.freedoms.iter().flat_map(|free| free.moves);
        for moved in moves.filter(|&moved| counts(moved)) {
            sum += DMat3::from_cols(moved * moved.x, moved * moved.y, moved * moved.z);
        }
        let pull = sum.inverse() * missing;
        if pull.is_finite() { pull } else { DVec3::ZERO }
    }

    /// Takes the step, or half of it, or half of that, whichever is the first that helps; has one helped?
    fn step(&mut self, goal: DVec3, before: f64, limit: Limit<'_>) -> bool {
        let turning = self.lengths.len();
        let widest = self.freedoms[..turning].iter().map(|free| free.turn().length()).fold(0.0, f64::max);
        if widest <= 0.0 || !widest.is_finite() {
            return false;
        }
        let mut size = (STRIDE / widest).min(1.0);
        self.links.iter_mut().for_each(|link| link.kept = link.rotation);
        for _ in 0..=HALVINGS {
            for (link, free) in self.links[..turning].iter_mut().zip(&self.freedoms) {
                let wish = (DQuat::from_scaled_axis(free.turn() * size) * link.kept).normalize();
                link.rotation = limited(limit, link.bone, wish);
            }
            self.place();
            if self.gap(goal) < before {
                return true;
            }
            size *= 0.5;
        }
        self.links.iter_mut().for_each(|link| link.rotation = link.kept);
        self.place();
        false
    }
}

impl Freedom {
    /// The joint's own step.
    fn turn(&self) -> DVec3 {
        self.turns[0] * self.shares[0] + self.turns[1] * self.shares[1]
    }
}

/// What the limit makes of a rotation.
pub(super) fn limited(limit: Limit<'_>, bone: BoneIndex, wish: DQuat) -> DQuat {
    let wish = wish.as_quat().normalize();
    limit(bone, wish).healed(wish).as_dquat().normalize()
}

/// A point of the cube from -1 to 1, another for each start and bone, always the same.
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
