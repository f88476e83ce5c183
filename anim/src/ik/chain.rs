//! IK of any number of consecutive bones: a tail, a spine, a tentacle, an arm with a clavicle.
//!
//! FABRIK rather than CCD (cyclic coordinate descent): it bends all bones evenly where CCD curls the end up first, it
//! needs fewer sweeps, and it does not depend on the order of the joints. FABRIK converges slowly for targets close to
//! full reach, so those are finished in closed form. It works on points, so the rotations are computed afterwards, from
//! the first bone to the last: each turns the short way from its direction to that of the next joint. A bone thereby
//! keeps its twist, and the joint limit is applied to every new rotation; the next sweep compensates for the part that
//! it removes.
//!
//! # With joint limits
//!
//! Where sweeps stop short, all joints are moved together within the freedom that their limits leave (damped least
//! squares), from the pose that the sweeps have reached and, where that does not help, from up to eleven others. Of
//! 1000 targets that a pose within the limits reaches, this number is met within a hundredth of the chain's length (in
//! brackets: by sweeps and CCD, which were used before):
//!
//! | chain | found |
//! |---|---|
//! | 2 to 6 bones, cones of 40° | 1000 (996) |
//! | 2 to 7 bones, hinges, balls and Euler ranges mixed, targets from turns up to 1 rad | 998 (942) |
//! | the same, targets from turns of any size, most of them where several joints are at their limits | 995 (843) |
//! | an arm: shoulder, elbow, wrist | 1000 (814) |
//! | a finger or a tail: 2 to 6 hinges that bend one way | 1000 (992) |
//!
//! The work is bounded: a limit is applied at most `iterations` + 2,028 times for each bone, and comes near that only
//! for targets that cannot be reached. For a gain of less than a thousandth of the length no other pose is searched or
//! used; but where a target can only be met from another pose than the sweeps lead to, the figure jumps to it, and from
//! frame to frame with a moving target it may jump again.

use super::fabrik::Points;
use super::limited::{Freedom, limited};
use super::path::{parent_to_root, pose_of};
use super::turn::{arc_between, share};
use super::{IkError, Reach};
use crate::data::{BoneIndex, Skeleton, Transform};
use crate::sample::mix::slerp;
use glam::{DMat3, DMat4, DQuat, DVec3, Mat4, Quat, Vec3};

/// A joint limit: gets a bone and the rotation relative to its parent that the solver proposes, and returns the
/// rotation to use. A result that is not finite leaves the proposed rotation as it is.
pub type Limit<'a> = &'a mut dyn FnMut(BoneIndex, Quat) -> Quat;

/// A chain of bones and how to move it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chain {
    /// First bone that turns.
    pub root: BoneIndex,
    /// Last bone, below `root`; its origin is moved to the target. It is not turned itself. All bones between are
    /// turned.
    pub end: BoneIndex,
    /// Distance to the target at which the solve ends, as a share of the chain's length.
    pub tolerance: f32,
    /// Largest number of sweeps, 1..=1000. Without limits the target is met anyway; more sweeps bend more evenly.
    pub iterations: u32,
    /// 0 leaves the poses unchanged bit for bit, 1 is the full solution; between, each rotation is slerped.
    pub weight: f32,
}

impl Chain {
    /// Creates a chain from `root` to `end`, solved within a hundred-thousandth of its length, in at most 32 sweeps, at
    /// full weight.
    pub fn new(root: BoneIndex, end: BoneIndex) -> Self {
        Self { root, end, tolerance: 1e-5, iterations: 32, weight: 1.0 }
    }
}

/// Working memory of [`chain()`], kept between calls so that they allocate nothing.
#[derive(Clone, Debug, Default)]
pub struct ChainScratch {
    pub(super) links: Vec<ChainLink>,
    pub(super) joints: Vec<DVec3>,
    pub(super) lengths: Vec<f64>,
    /// Freedoms of the turning links, where there are limits.
    pub(super) freedoms: Vec<Freedom>,
}

/// One bone of the chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChainLink {
    pub(super) bone: BoneIndex,
    pub(super) posed: Transform,
    pub(super) rotation: DQuat,
    /// The rotation with the smallest distance to the target so far.
    pub(super) best: DQuat,
    /// The rotation before a step that may have to be undone.
    pub(super) previous: DQuat,
}

/// Turns the bones of `settings` so that the end reaches `target` (to-root space), or comes as close as it can.
///
/// Out of reach, the chain is straight and points at the target; too near (one bone longer than all others together),
/// it is folded and points at it. A straight chain bends to a side that is always the same. Bones without length do not
/// turn. Where bones of the chain are scaled differently per axis, their lengths depend on their directions and the
/// sweeps start again, at most `iterations` times in all.
///
/// With a `limit` the search may end early (see the module). The result is the best that was found, and no farther from
/// the target than the pose was: a pose beyond its limits stays as it is where nothing within them is nearer.
///
/// `to_root` is read at the root's parent only. Returns the distance left at full weight, and the number of sweeps.
#[doc(alias = "FABRIK")]
pub fn chain(
    skeleton: &Skeleton,
    to_root: &[Mat4],
    settings: &Chain,
    target: Vec3,
    mut limit: Option<Limit<'_>>,
    scratch: &mut ChainScratch,
    poses: &mut [Transform],
) -> Result<Reach, IkError> {
    let parent = parent_to_root(skeleton, to_root, settings.root)?.as_dmat4();
    scratch.load(skeleton, poses, settings)?;
    let linear = DMat3::from_mat4(parent);
    if linear.determinant() == 0.0 || !linear.inverse().is_finite() {
        return Err(IkError::Flat { bone: settings.root });
    }
    let goal = linear.inverse() * (target.as_dvec3() - parent.w_axis.truncate());
    if !goal.is_finite() || scratch.links.iter().any(|link| !link.posed.is_finite()) {
        return Err(IkError::NotFinite { bone: settings.root });
    }
    let iterations = scratch.solve(settings, goal, &mut limit);
    let distance = distance(&scratch.joints, &parent, goal);
    if !(distance.is_finite() && scratch.links.iter().all(|link| link.best.is_finite())) {
        return Err(IkError::NotFinite { bone: settings.root });
    }
    let weight = share(settings.weight);
    let turning = scratch.links.len() - 1;
    for link in scratch.links[..turning].iter().filter(|_| weight > 0.0) {
        let solved = link.best.as_quat().normalize();
        let own = link.posed.rotation;
        poses[link.bone as usize].rotation = if weight < 1.0 { slerp(own, solved, weight) } else { solved };
    }
    Ok(Reach { distance, iterations })
}

/// Returns the distance from the last joint to the goal, in to-root space.
fn distance(joints: &[DVec3], parent: &DMat4, goal: DVec3) -> f32 {
    let last = joints.last().copied().unwrap_or(goal);
    parent.transform_vector3(goal - last).length() as f32
}

impl ChainScratch {
    /// Allocates memory for chains of `bones` bones, so that not even the first call allocates.
    pub fn with_capacity(bones: usize) -> Self {
        Self {
            links: Vec::with_capacity(bones),
            joints: Vec::with_capacity(bones),
            lengths: Vec::with_capacity(bones),
            freedoms: Vec::with_capacity(bones),
        }
    }

    /// Reads the bones of the chain from the poses.
    fn load(&mut self, skeleton: &Skeleton, poses: &[Transform], settings: &Chain) -> Result<(), IkError> {
        self.links.clear();
        let mut bone = settings.end;
        loop {
            let posed = pose_of(skeleton, poses, bone)?;
            let rotation = posed.rotation.as_dquat().normalize();
            self.links.push(ChainLink { bone, posed, rotation, best: rotation, previous: rotation });
            if bone == settings.root && self.links.len() > 1 {
                break;
            }
            let below = IkError::NotBelow { above: settings.root, below: settings.end };
            bone = skeleton.parent(bone).ok_or(below)?;
        }
        self.links.reverse();
        self.joints.clear();
        self.joints.resize(self.links.len(), DVec3::ZERO);
        self.lengths.clear();
        self.lengths.resize(self.links.len() - 1, 0.0);
        self.freedoms.clear();
        self.freedoms.resize(self.lengths.len(), Freedom::default());
        Ok(())
    }

    /// Sweeps until the goal is met or nothing helps; leaves the best rotations and their joints in the links.
    fn solve(&mut self, settings: &Chain, goal: DVec3, limit: &mut Option<Limit<'_>>) -> u32 {
        self.update_joints();
        let mut nearest = self.gap(goal);
        let total: f64 = self.lengths.iter().sum();
        let tolerance = f64::from(settings.tolerance.max(1e-7)) * total;
        let (mut made, most) = (0, settings.iterations.clamp(1, 1_000));
        while nearest > tolerance && made < most {
            let sweeps = if limit.is_some() { 1 } else { most - made };
            let mut points = Points { joints: &mut self.joints, lengths: &self.lengths };
            made += points.reach(goal, sweeps, tolerance).max(1);
            if limit.is_none() && made >= most {
                points.finish(goal);
            }
            self.turn(limit);
            let before = nearest;
            if self.gap(goal) < nearest {
                nearest = self.gap(goal);
                self.links.iter_mut().for_each(|link| link.best = link.rotation);
            }
            if limit.is_none() && nearest > 0.999 * before {
                break;
            }
        }
        self.links.iter_mut().for_each(|link| link.rotation = link.best);
        self.update_joints();
        if let Some(limit) = limit {
            self.search(goal, tolerance, limit);
        }
        made
    }

    pub(super) fn gap(&self, goal: DVec3) -> f64 {
        self.joints.last().map_or(0.0, |last| last.distance(goal))
    }

    /// Computes joints and lengths from the rotations.
    pub(super) fn update_joints(&mut self) {
        let mut linear = DMat3::IDENTITY;
        for index in 0..self.links.len() {
            let link = self.links[index];
            let offset = linear * link.posed.translation.as_dvec3();
            if index == 0 {
                self.joints[0] = offset;
            } else {
                self.joints[index] = self.joints[index - 1] + offset;
                self.lengths[index - 1] = offset.length();
            }
            linear *= link.linear();
        }
    }

    /// Computes rotations from the joints, first to last; then joints and lengths from the rotations.
    fn turn(&mut self, limit: &mut Option<Limit<'_>>) {
        let mut linear = DMat3::IDENTITY;
        let mut position = self.joints[0];
        for index in 0..self.lengths.len() {
            let arm = self.links[index + 1].posed.translation.as_dvec3();
            let link = &mut self.links[index];
            let inverse = linear.inverse();
            let wanted = inverse * (self.joints[index + 1] - position);
            let scaled = link.posed.scale.as_dvec3() * arm;
            if inverse.is_finite() && wanted.is_finite() {
                let turn = arc_between(link.rotation * scaled, wanted);
                link.rotation = (turn * link.rotation).normalize();
            }
            if let Some(limit) = limit {
                link.rotation = limited(limit, link.bone, link.rotation);
            }
            linear *= link.linear();
            position += linear * arm;
        }
        self.update_joints();
    }
}

impl ChainLink {
    pub(super) fn linear(&self) -> DMat3 {
        DMat3::from_quat(self.rotation) * DMat3::from_diagonal(self.posed.scale.as_dvec3())
    }
}
