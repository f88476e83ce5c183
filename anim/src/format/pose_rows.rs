//! Poses of a bone at the times of its keys, for formats whose keys have all properties.

use crate::data::{Bone, Track, Transform};
use crate::format::straight::{straight_times, union};
use crate::sample::{rest_pose, sample_channel};

/// A row: time in seconds, and the pose of the bone in the space of the model.
pub(super) struct TimedPose {
    pub(super) time: f32,
    pub(super) pose: Transform,
}

/// Returns the rows of a track: one for each time at which a channel has a key. A track without keys has the rest pose at
/// `start`, since a list without rows is not possible. A jump takes `jump` seconds.
pub(super) fn pose_rows(track: Option<&Track>, bone: &Bone, start: f32, jump: f32) -> Vec<TimedPose> {
    let rest = rest_pose(bone);
    let times = track.map_or(Vec::new(), |track| {
        union([
            straight_times(&track.translation, jump),
            straight_times(&track.rotation, jump),
            straight_times(&track.scale, jump),
        ])
    });
    let Some(track) = track.filter(|_| !times.is_empty()) else {
        return vec![TimedPose { time: start, pose: rest }];
    };
    let pose = |time: f32| Transform {
        translation: sample_channel(&track.translation, rest.translation, time),
        rotation: sample_channel(&track.rotation, rest.rotation, time),
        scale: sample_channel(&track.scale, rest.scale, time),
    };
    times.into_iter().map(|time| TimedPose { time, pose: pose(time) }).collect()
}
