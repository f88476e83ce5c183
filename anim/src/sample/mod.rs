//! From keys to a pose: the open path, which follows the formulas line by line (thesis §2.1.5.2).
//!
//! For each animated property of each bone: [`find_keys`] finds the two keys around the time and the fraction between
//! them, [`mix`] combines their values, and the three results form the temporary key-frame ([`keyframe_at`]) that the
//! formulas of [`crate::animation`] continue with.
//!
//! # Common rules
//!
//! * Before the first and after the last key a channel keeps that key's value (clamped). To repeat a take instead,
//!   map the time first: [`loop_time`].
//! * On a key the key's value is returned bit for bit.
//! * A channel without keys gives the rest value of its bone.
//! * Sampling is total: it never panics, and no result is NaN or infinite, whatever the data is. A stored number
//!   that is not finite is replaced: a key by the rest value, a tangent by zero, a rest value by that of
//!   [`Transform::IDENTITY`]; an interpolated value that leaves the range of `f32` by the key before. Valid data and its
//!   results are never changed by this.

mod channel;
mod keys;
pub mod mix;
mod morph;
mod time;
mod value;

pub use channel::{Between, sample_channel, sample_channel_with};
pub(crate) use channel::{in_tangent, key_value, out_tangent, sample_between};
pub(crate) use keys::{KeyCursor, mix_factor};
pub use keys::{Keys, find_keys};
pub use morph::sample_morph_weights;
pub use time::{PlayMode, clamp_time, loop_time};
pub use value::Value;

use crate::data::{Bone, Keyframe, Skeleton, Take, Track, Transform};

/// Returns the pose of `bone`, relative to its parent, when nothing animates it: its rest pose, every number finite and
/// the rotation of unit length.
///
/// A valid rest pose is returned bit for bit.
pub fn rest_pose(bone: &Bone) -> Transform {
    healthy(bone.rest, Transform::IDENTITY)
}

/// Returns the pose of `bone` relative to its parent at `time` seconds; properties that `track` does not animate have
/// the rest value.
pub fn sample_track(track: &Track, bone: &Bone, time: f32) -> Transform {
    let rest = rest_pose(bone);
    Transform {
        translation: sample_channel(&track.translation, rest.translation, time),
        rotation: sample_channel(&track.rotation, rest.rotation, time),
        scale: sample_channel(&track.scale, rest.scale, time),
    }
}

/// Returns the temporary key-frame of `bone` at `time` seconds, assembled from the columns of its track.
///
/// A time that is not finite is stored as 0; the pose is that of the first key (NaN, −∞) or the last (+∞).
pub fn keyframe_at(track: &Track, bone: &Bone, time: f32) -> Keyframe {
    Keyframe { time: if time.is_finite() { time } else { 0.0 }, pose: sample_track(track, bone, time) }
}

/// Samples the poses of all bones at `time` seconds, each relative to its parent, in bone order.
///
/// Without `take`, or for a bone whose track is missing: the rest pose. Writes up to the length of the shorter of `out`
/// and the skeleton; allocates nothing.
#[doc(alias("evaluate", "pose"))]
pub fn sample_take(take: Option<&Take>, skeleton: &Skeleton, time: f32, out: &mut [Transform]) {
    for (index, (bone, pose)) in skeleton.bones.iter().zip(out).enumerate() {
        *pose = match take.and_then(|take| take.tracks.get(index)) {
            Some(track) => sample_track(track, bone, time),
            None => rest_pose(bone),
        };
    }
}

/// Returns `pose` with every number that is not finite replaced by that of `fallback`, and its rotation normalized.
pub fn healthy(pose: Transform, fallback: Transform) -> Transform {
    Transform {
        translation: pose.translation.healed(fallback.translation),
        rotation: pose.rotation.healed(fallback.rotation),
        scale: pose.scale.healed(fallback.scale),
    }
}
