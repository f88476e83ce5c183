//! Rotations of one bone: `q_t = L · (G_sa⁻¹ G_s) · E`.

use super::rest::parent_of;
use super::sample_times::SampleTimes;
use crate::data::{Channel, Interpolation, Skeleton, Take};
use crate::sample::{Value, rest_pose, sample_channel};
use glam::{DQuat, Quat};

/// The bones that move a bone of the target, and the two factors that do not depend on time.
pub(super) struct BoneRotation {
    /// `a` in the source: the bone that moves the nearest bound ancestor; `None` for a topmost bone.
    pub(super) above: Option<usize>,
    /// The source's bone.
    pub(super) bone: usize,
    pub(super) left: DQuat,
    pub(super) right: DQuat,
}

impl BoneRotation {
    /// Returns the channel of the target's bone, whose rest rotation is `rest`.
    pub(super) fn channel(&self, take: &Take, source: &Skeleton, rest: DQuat) -> Channel<Quat> {
        let down = path(source, self.bone, self.above);
        let Some(down) = down else {
            // The source's two bones are on different branches: the path goes down one and up the other.
            let all = path(source, self.bone, None).unwrap_or_default();
            let other = self.above.and_then(|above| path(source, above, None)).unwrap_or_default();
            return self.sampled(take, source, &all, &other);
        };
        let moving = |&&bone: &&usize| take.tracks.get(bone).is_some_and(|track| !track.rotation.is_empty());
        let mut movers = down.iter().filter(moving);
        match (movers.next(), movers.next()) {
            (None, _) => self.constant(take, source, &down, rest),
            (Some(&mover), None) => self.mapped(take, source, &down, mover),
            _ => self.sampled(take, source, &down, &[]),
        }
    }

    /// Returns the channel when nothing moves: no keys where the target has this rest rotation, else one.
    fn constant(&self, take: &Take, source: &Skeleton, down: &[usize], rest: DQuat) -> Channel<Quat> {
        let rotation = (self.left * product(source, down) * self.right).normalize();
        let off = (rotation - rest).length().min((rotation + rest).length());
        if off < 1e-6 {
            return Channel::default();
        }
        Channel::new([take.start], [rotation.as_quat()], Interpolation::Linear)
    }

    /// Returns the channel when one channel moves: its keys, each multiplied from both sides.
    fn mapped(&self, take: &Take, source: &Skeleton, down: &[usize], mover: usize) -> Channel<Quat> {
        let at = down.iter().position(|&bone| bone == mover).unwrap_or(0);
        let left = self.left * product(source, &down[..at]);
        let right = product(source, &down[at + 1..]) * self.right;
        let channel = &take.tracks[mover].rotation;
        let cubic = channel.interpolation == Interpolation::CubicSpline;
        let change = |value: Quat| left * value.as_dquat() * right;
        let rest = rest_pose(&source.bones[mover]).rotation;
        let value = |(index, &value): (usize, &Quat)| {
            if cubic && index % 3 != 1 {
                change(value).as_quat()
            } else {
                change(value.healed(rest)).normalize().as_quat()
            }
        };
        Channel {
            times: channel.times.clone(),
            values: channel.values.iter().enumerate().map(value).collect(),
            interpolation: channel.interpolation,
        }
    }

    /// Returns the channel when several channels move: their product at the key times of all of them, and between,
    /// because the product of two rotations at constant speed has no constant speed.
    fn sampled(&self, take: &Take, source: &Skeleton, down: &[usize], up: &[usize]) -> Channel<Quat> {
        let mut sample_times = SampleTimes::default();
        let tracks = down.iter().chain(up).filter_map(|&bone| take.tracks.get(bone));
        tracks.for_each(|track| sample_times.add(&track.rotation));
        let (times, interpolation) = sample_times.all(true);
        let mut last = DQuat::IDENTITY;
        let values: Vec<Quat> = times
            .iter()
            .map(|&time| {
                let inner = turned(take, source, up, time).conjugate() * turned(take, source, down, time);
                let rotation = (self.left * inner * self.right).normalize();
                last = if rotation.dot(last) < 0.0 { -rotation } else { rotation };
                last.as_quat()
            })
            .collect();
        Channel { times: times.into(), values: values.into(), interpolation }
    }
}

/// Returns the bones from below `above` down to `bone`, top first; `None` where `above` is not an ancestor of `bone`.
pub(super) fn path(skeleton: &Skeleton, bone: usize, above: Option<usize>) -> Option<Vec<usize>> {
    let (mut path, mut at) = (Vec::new(), Some(bone));
    while at != above {
        path.push(at?);
        at = parent_of(skeleton, at?);
    }
    path.reverse();
    Some(path)
}

/// Returns the product of the rest rotations of a path.
fn product(skeleton: &Skeleton, path: &[usize]) -> DQuat {
    let rest = |&bone: &usize| rest_pose(&skeleton.bones[bone]).rotation.as_dquat().normalize();
    path.iter().map(rest).fold(DQuat::IDENTITY, |above, own| above * own)
}

/// Returns the product of the rotations of a path at one time.
fn turned(take: &Take, skeleton: &Skeleton, path: &[usize], time: f32) -> DQuat {
    let own = |&bone: &usize| {
        let rest = rest_pose(&skeleton.bones[bone]).rotation;
        let track = take.tracks.get(bone);
        track.map_or(rest, |track| sample_channel(&track.rotation, rest, time)).as_dquat().normalize()
    };
    path.iter().map(own).fold(DQuat::IDENTITY, |above, own| above * own)
}
