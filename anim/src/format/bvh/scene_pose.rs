//! A pose of a take as a BVH file has it: relative to a rest pose without rotations.

use crate::animation::to_root;
use crate::data::{Skeleton, Take, Transform};
use crate::sample::sample_take;
use glam::{DQuat, DVec3, Mat4};

/// Samples poses of a take in scene space.
pub(super) struct SceneSampler<'a> {
    take: Option<&'a Take>,
    skeleton: &'a Skeleton,
    rest_turns: Vec<DQuat>,
    locals: Vec<Transform>,
    matrices: Vec<Mat4>,
}

/// Rotations of all bones from the rest pose, and their positions in meters, in scene space.
#[derive(Default)]
pub(super) struct ScenePose {
    pub(super) turned: Vec<DQuat>,
    pub(super) positions: Vec<DVec3>,
}

impl<'a> SceneSampler<'a> {
    /// Creates a sampler, and returns it with the positions in the rest pose.
    pub(super) fn of(take: Option<&'a Take>, skeleton: &'a Skeleton) -> (Self, Vec<DVec3>) {
        let count = skeleton.len();
        let (locals, matrices) = (vec![Transform::IDENTITY; count], vec![Mat4::IDENTITY; count]);
        let mut sampler = Self { take, skeleton, rest_turns: Vec::new(), locals, matrices };
        sample_take(None, skeleton, 0.0, &mut sampler.locals);
        sampler.rest_turns = sampler.rotations();
        to_root(skeleton, &sampler.locals, &mut sampler.matrices);
        let rest = sampler.positions();
        (sampler, rest)
    }

    /// Returns the pose at a time, in seconds.
    pub(super) fn pose(&mut self, time: f64) -> ScenePose {
        sample_take(self.take, self.skeleton, time as f32, &mut self.locals);
        let turns = self.rotations();
        let turned = turns.iter().zip(&self.rest_turns);
        let turned = turned.map(|(turn, rest)| (*turn * rest.conjugate()).normalize()).collect();
        to_root(self.skeleton, &self.locals, &mut self.matrices);
        ScenePose { turned, positions: self.positions() }
    }

    fn positions(&self) -> Vec<DVec3> {
        self.matrices.iter().map(|matrix| matrix.w_axis.truncate().as_dvec3()).collect()
    }

    /// Returns the rotations of the bones in scene space.
    fn rotations(&self) -> Vec<DQuat> {
        let mut rotations: Vec<DQuat> = Vec::with_capacity(self.locals.len());
        for (local, bone) in self.locals.iter().zip(&self.skeleton.bones) {
            let own = local.rotation.as_dquat().normalize();
            rotations.push(bone.parent.map_or(own, |parent| rotations[parent as usize] * own));
        }
        rotations
    }
}

impl ScenePose {
    /// Returns the rotation and the position of a bone relative to its parent.
    pub(super) fn local(&self, bone: usize, parent: Option<usize>) -> (DQuat, DVec3) {
        let (turn, position) = (self.turned[bone], self.positions[bone]);
        match parent {
            None => (turn, position),
            Some(parent) => {
                let back = self.turned[parent].conjugate();
                ((back * turn).normalize(), back * (position - self.positions[parent]))
            }
        }
    }

    /// Returns the positions of bones whose rotations and positions in their parents are `mix` of the way from this pose to
    /// another one.
    pub(super) fn mixed(&self, to: &Self, mix: f64, parents: &[Option<usize>]) -> Vec<DVec3> {
        let (mut turned, mut positions) =
            (Vec::with_capacity(parents.len()), Vec::with_capacity(parents.len()));
        for (bone, &parent) in parents.iter().enumerate() {
            let ((from_turn, from), (to_turn, to)) = (self.local(bone, parent), to.local(bone, parent));
            let (turn, position) = (shortest(from_turn, to_turn, mix), from.lerp(to, mix));
            let (above, origin) =
                parent.map_or((DQuat::IDENTITY, DVec3::ZERO), |parent| (turned[parent], positions[parent]));
            turned.push((above * turn).normalize());
            positions.push(origin + above * position);
        }
        positions
    }

    /// Returns the length of the diagonal of the box around all bones.
    pub(super) fn extent(&self) -> f64 {
        let [low, high] = [DVec3::min, DVec3::max].map(|of| self.positions.iter().copied().reduce(of));
        low.zip(high).map_or(0.0, |(low, high)| (high - low).length())
    }
}

/// Returns the rotation `mix` of the shortest way from one to another.
fn shortest(from: DQuat, to: DQuat, mix: f64) -> DQuat {
    let between = from.conjugate() * to;
    let between = if between.w < 0.0 { -between } else { between };
    let sine = between.xyz().length();
    if sine < 1e-12 {
        return from;
    }
    let half = libm::atan2(sine, between.w) * mix;
    let axis = between.xyz() * (libm::sin(half) / sine);
    (from * DQuat::from_xyzw(axis.x, axis.y, axis.z, libm::cos(half))).normalize()
}
