//! The channels of a take, by name.

use dragonfly_anim::data::{BoneIndex, Interpolation, Skeleton, Take, Track};
use dragonfly_document::edit::{BoneRef, Property};
use std::collections::HashMap;
use std::sync::Arc;

/// A channel: a bone and one of its properties.
pub type ChannelId = (BoneIndex, Property);

/// Returns the track of a bone.
pub fn track(take: &Take, bone: BoneIndex) -> Option<&Track> {
    // One track for each bone, in bone order; a take from another source may differ.
    let track = take.tracks.get(bone as usize).filter(|track| track.bone == bone);
    track.or_else(|| take.tracks.iter().find(|track| track.bone == bone))
}

/// Returns the times of a channel's keys; empty if there is none.
pub fn times(take: &Take, (bone, property): ChannelId) -> &[f32] {
    shared_times(take, (bone, property)).map_or(&[], |times| times)
}

/// Returns the times of a channel's keys as they are shared.
pub fn shared_times(take: &Take, (bone, property): ChannelId) -> Option<&Arc<[f32]>> {
    let track = track(take, bone)?;
    Some(match property {
        Property::Translation => &track.translation.times,
        Property::Rotation => &track.rotation.times,
        Property::Scale => &track.scale.times,
    })
}

/// Returns the interpolation of a channel.
pub fn interpolation(take: &Take, (bone, property): ChannelId) -> Interpolation {
    track(take, bone).map_or(Interpolation::Linear, |track| match property {
        Property::Translation => track.translation.interpolation,
        Property::Rotation => track.rotation.interpolation,
        Property::Scale => track.scale.interpolation,
    })
}

/// Returns the channels of a bone that have keys.
pub fn channels(take: &Take, bone: BoneIndex) -> impl Iterator<Item = ChannelId> + '_ {
    let of_bone = Property::ALL.into_iter().map(move |property| (bone, property));
    of_bone.filter(|&channel| !times(take, channel).is_empty())
}

/// Returns the time of the key of `channel` nearest to `time`.
pub fn nearest(take: &Take, channel: ChannelId, time: f32) -> Option<f32> {
    nearest_of(times(take, channel), time)
}

/// Returns the time of some ascending times nearest to `time`.
pub fn nearest_of(times: &[f32], time: f32) -> Option<f32> {
    let after = times.partition_point(|&key| key < time);
    let around =
        [after.checked_sub(1), Some(after)].into_iter().flatten().filter_map(|at| times.get(at).copied());
    around.min_by(|a, b| (a - time).abs().total_cmp(&(b - time).abs()))
}

/// The names of a skeleton's bones, for texts that name many bones: text with names means the same in another model.
#[derive(Debug)]
pub struct BoneNames<'a> {
    skeleton: &'a Skeleton,
    /// The first bone of each name.
    first: HashMap<&'a str, BoneIndex>,
}

impl<'a> BoneNames<'a> {
    /// Returns the names of `skeleton`.
    pub fn of(skeleton: &'a Skeleton) -> Self {
        let mut first = HashMap::with_capacity(skeleton.len());
        for (index, bone) in skeleton.bones.iter().enumerate() {
            first.entry(bone.name.as_str()).or_insert(index as BoneIndex);
        }
        Self { skeleton, first }
    }

    /// Returns a bone by its name; by its index if the name is empty or an earlier bone has it too.
    pub fn reference(&self, bone: BoneIndex) -> BoneRef {
        match self.skeleton.bones.get(bone as usize) {
            Some(rules) if !rules.name.is_empty() && self.first.get(rules.name.as_str()) == Some(&bone) => {
                BoneRef::Name(rules.name.clone())
            }
            Some(_) | None => BoneRef::Index(bone),
        }
    }
}
