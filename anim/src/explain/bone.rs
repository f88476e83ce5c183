//! The steps from keys to `to_root`, for every bone of a chain.

use super::{ExplainError, SampledPose, Subject};
use crate::animation::{final_pose, to_parent};
use crate::data::{BoneIndex, Channel, Interpolation, Track, Transform};
use crate::sample::{Value, find_keys, in_tangent, key_value, out_tangent, rest_pose, sample_channel};
use glam::{Mat4, Quat, Vec3};

/// One bone of the chain from the root.
#[derive(Clone, Debug, PartialEq)]
pub struct BoneStep {
    /// Position in [`Skeleton::bones`](crate::data::Skeleton::bones).
    pub bone: BoneIndex,
    /// As in the file; may be empty.
    pub name: String,
    /// Its parent, whose step precedes this one; `None` for a root.
    pub parent: Option<BoneIndex>,
    /// Computation of its translation, parent space.
    pub translation: ChannelStep<Vec3>,
    /// Computation of its rotation, parent space.
    pub rotation: ChannelStep<Quat>,
    /// Computation of its scale.
    pub scale: ChannelStep<Vec3>,
    /// The temporary key-frame (§2.1.5.2): the three values together, relative to the parent.
    pub pose: Transform,
    /// `T · R · S` of the pose: bone space → parent space (§2.1.5.1). For a bone whose rest pose is a sheared matrix,
    /// that matrix.
    pub to_parent: Mat4,
    /// `to_root of the parent * to_parent`: bone space → scene space (§2.1.5.1).
    pub to_root: Mat4,
}

/// Computation of one property of a bone at the time.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelStep<T> {
    /// Value when nothing animates the bone.
    pub rest: T,
    /// The keys that were used; `None` when the channel has none, so that `rest` is used.
    pub keys: Option<KeysStep<T>>,
    /// The result.
    pub value: T,
}

/// The keys around the time (§2.1.5.2).
#[derive(Clone, Debug, PartialEq)]
pub struct KeysStep<T> {
    /// Number of keys of the channel.
    pub count: usize,
    /// How the two keys are combined.
    pub interpolation: Interpolation,
    /// The last key at or before the time; the first, when the time is before all.
    pub before: KeyStep<T>,
    /// The next key; the same key as `before` where the time is outside all keys.
    pub after: KeyStep<T>,
    /// Fraction of the time from `before` to `after`, 0..=1.
    pub mix: f32,
}

/// One key.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyStep<T> {
    /// Position in the channel, from 0.
    pub index: usize,
    /// Seconds.
    pub time: f32,
    /// Value used by sampling: the stored one, bit for bit, unless that is not usable.
    pub value: T,
    /// For a cubic spline, the tangent used on this side, per second: the out-tangent of `before`, the in-tangent of
    /// `after`.
    pub tangent: Option<T>,
}

/// The last step of a bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoneResult {
    /// The requested bone; its other steps are the last of [`super::Explanation::bones`].
    pub bone: BoneIndex,
    /// Bind space → bone space, as stored with the bone: that of the first skin that uses it (§2.1.2.2).
    pub offset: Mat4,
    /// `to_root * offset`: bind space → scene space (§2.1.5.1).
    pub final_pose: Mat4,
}

/// Returns the result of a bone, and the bones whose chains it needs.
pub(super) fn result(
    pose: &SampledPose<'_>,
    index: BoneIndex,
) -> Result<(Vec<BoneIndex>, Subject), ExplainError> {
    let missing = ExplainError::NoBone { bone: index, bones: pose.skeleton.len() };
    let bone = pose.skeleton.bones.get(index as usize).ok_or(missing)?;
    let final_pose = final_pose(pose.to_root[index as usize], bone.offset);
    Ok((vec![index], Subject::Bone(BoneResult { bone: index, offset: bone.offset, final_pose })))
}

/// Returns the steps of `ends` and of all their ancestors, parents first.
pub(super) fn chain(pose: &SampledPose<'_>, ends: &[BoneIndex]) -> Vec<BoneStep> {
    let mut wanted = vec![false; pose.skeleton.len()];
    for &end in ends {
        let mut at = Some(end);
        while let Some(bone) = at
            && let Some(wanted) = wanted.get_mut(bone as usize)
            && !std::mem::replace(wanted, true)
        {
            at = pose.skeleton.parent(bone);
        }
    }
    let wanted = wanted.iter().enumerate().filter(|(_, wanted)| **wanted);
    wanted.map(|(bone, _)| step(pose, bone)).collect()
}

fn step(pose: &SampledPose<'_>, index: usize) -> BoneStep {
    let bone = &pose.skeleton.bones[index];
    let rest = rest_pose(bone);
    let none = Track::default();
    let track = pose.take.and_then(|take| take.tracks.get(index)).unwrap_or(&none);
    BoneStep {
        bone: index as BoneIndex,
        name: bone.name.clone(),
        parent: pose.skeleton.parent(index as BoneIndex),
        translation: channel(&track.translation, rest.translation, pose.time),
        rotation: channel(&track.rotation, rest.rotation, pose.time),
        scale: channel(&track.scale, rest.scale, pose.time),
        pose: pose.poses[index],
        to_parent: to_parent(bone, pose.poses[index]),
        to_root: pose.to_root[index],
    }
}

fn channel<T: Value>(channel: &Channel<T>, rest: T, time: f32) -> ChannelStep<T> {
    let cubic = channel.interpolation == Interpolation::CubicSpline;
    let key = |index: usize, tangent: T| KeyStep {
        index,
        time: channel.times[index],
        value: key_value(channel, rest, index),
        tangent: cubic.then_some(tangent),
    };
    let keys = find_keys(&channel.times, time).map(|keys| KeysStep {
        count: channel.len(),
        interpolation: channel.interpolation,
        before: key(keys.before, out_tangent(channel, keys.before)),
        after: key(keys.after, in_tangent(channel, keys.after)),
        mix: keys.mix,
    });
    ChannelStep { rest, keys, value: sample_channel(channel, rest, time) }
}
