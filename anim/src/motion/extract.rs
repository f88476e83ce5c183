//! Extraction of root motion from a take.

use super::keys::{Refine, slopes, spins, union, with_values};
use super::parent_space::ParentSpace;
use super::restore::{MotionDirection, apply};
use super::{MotionError, RootMotion, RootMotionOptions};
use crate::data::{BoneIndex, Channel, Interpolation, Skeleton, Take, Track, Transform};
use crate::sample::{Value, rest_pose, sample_track};
use glam::{DQuat, DVec3, Quat, Vec3};

/// Extracts the motion of `bone` from `take`. Returns the motion, and the take in place.
///
/// A bone without keys whose ancestors do not move gives a motion without keys and the unchanged take. Where ancestors
/// move, the bone gets keys at their key times too. Nothing else of the take is changed.
///
/// At the key times, everything that the options extract is removed; between them too, if only translations are
/// extracted and the ancestors do not move. With yaw, position and direction between two keys differ from the take by
/// the difference of an interpolated product from a product of interpolated values: of second order in the angle
/// between the keys. Applying [`restore`](super::restore()) to both results gives the original take at all times.
#[doc(alias = "root motion")]
pub fn extract(
    take: &Take,
    skeleton: &Skeleton,
    bone: BoneIndex,
    options: RootMotionOptions,
) -> Result<(RootMotion, Take), MotionError> {
    let rest = rest_pose(skeleton.bones.get(bone as usize).ok_or(MotionError::NoSuchBone { bone })?);
    let track = refined(take, skeleton, bone, rest, options);
    let motion = measure(take, skeleton, &track, rest, options)?;
    let track = apply(take, skeleton, &track, &motion, MotionDirection::Extract)?;
    Ok((motion, with_track(take, track)))
}

/// Returns only the take of [`extract`].
pub fn in_place(
    take: &Take,
    skeleton: &Skeleton,
    bone: BoneIndex,
    options: RootMotionOptions,
) -> Result<Take, MotionError> {
    extract(take, skeleton, bone, options).map(|(_, take)| take)
}

/// Returns `take` with another track for one bone.
pub(super) fn with_track(take: &Take, track: Track) -> Take {
    let mut take = take.clone();
    let index = track.bone as usize;
    while take.tracks.len() <= index {
        take.tracks.push(Track { bone: take.tracks.len() as BoneIndex, ..Track::default() });
    }
    take.tracks[index] = track;
    take
}

/// Returns the track of `bone`; an empty one where the take has none.
pub(super) fn track_of(take: &Take, bone: BoneIndex) -> Track {
    let track = take.tracks.get(bone as usize).cloned().unwrap_or_default();
    Track { bone, ..track }
}

/// Returns the key times of all ancestors of `bone`.
pub(super) fn times_above(take: &Take, skeleton: &Skeleton, bone: BoneIndex) -> Vec<f32> {
    let tracks = skeleton.ancestors(bone).filter_map(|above| take.tracks.get(above as usize));
    let lists =
        tracks.flat_map(|track| [&track.translation.times, &track.rotation.times, &track.scale.times]);
    union(lists.map(|times| &times[..]))
}

/// Returns whether the translation needs keys wherever the rotation has some. Where a horizontal component stays in the
/// take while the yaw does not, the yaw rotates that component.
fn is_coupled(horizontal: [bool; 3], up: usize, moves: bool) -> bool {
    moves && (0..3).any(|axis| axis != up && !horizontal[axis])
}

/// Returns the track of the bone with all keys that the conversion needs.
fn refined(
    take: &Take,
    skeleton: &Skeleton,
    bone: BoneIndex,
    rest: Transform,
    options: RootMotionOptions,
) -> Track {
    let (mut track, above) = (track_of(take, bone), times_above(take, skeleton, bone));
    if options.yaw {
        track.rotation = Quat::refined(&track.rotation, rest.rotation, &above);
    }
    let moves = !track.translation.is_empty() || !above.is_empty();
    let turning = options.yaw && !track.rotation.is_empty();
    if options.translation.contains(&true) || turning {
        track.translation = Vec3::refined(&track.translation, rest.translation, &above);
    }
    if turning && is_coupled(options.translation, options.up as usize, moves) {
        track.translation = Vec3::refined(&track.translation, rest.translation, &track.rotation.times);
    }
    track
}

/// Computes the motion of a refined track.
fn measure(
    take: &Take,
    skeleton: &Skeleton,
    track: &Track,
    rest: Transform,
    options: RootMotionOptions,
) -> Result<RootMotion, MotionError> {
    let (bone, up) = (track.bone, options.up.to_vec3().as_dvec3());
    let space = ParentSpace::at(take, skeleton, bone, take.start)?;
    let start = sample_track(track, &skeleton.bones[bone as usize], take.start);
    let origin = space.point_to_root(start.translation.as_dvec3());
    let mut motion = RootMotion {
        bone,
        up: options.up,
        pivot: (origin - up * origin.dot(up)).as_vec3(),
        start: take.start,
        length: take.length,
        ..RootMotion::default()
    };
    if options.translation.contains(&true) {
        let chosen = DVec3::from_array(options.translation.map(|axis| f64::from(u8::from(axis))));
        motion.translation = map(&track.translation, rest.translation, |time, value, rates| {
            let space = ParentSpace::at(take, skeleton, bone, time)?;
            let moved = chosen * (space.point_to_root(value.as_dvec3()) - origin);
            Ok((
                moved.as_vec3(),
                rates.map(|rate| (chosen * space.vector_to_root(rate.as_dvec3())).as_vec3()),
            ))
        })?;
    }
    if options.yaw {
        let inverse_start = space.rotation_to_root(start.rotation.as_dquat()).conjugate();
        let mut last = DQuat::IDENTITY;
        motion.rotation = map_turns(&track.rotation, rest.rotation, |time, value, rates| {
            let space = ParentSpace::at(take, skeleton, bone, time)?;
            let about =
                |rotation: Quat| along(space.rotation_to_root(rotation.as_dquat()) * inverse_start, up);
            let raw = about(value);
            let length = raw.length();
            // Half a turn about a horizontal axis: the yaw is undefined; it keeps its last value.
            let yaw = if length > 1e-6 { raw / length } else { last };
            let sign = if yaw.dot(last) < 0.0 { -1.0 } else { 1.0 };
            last = yaw * sign;
            let rates = rates.map(|rate| {
                let rate = about(rate) * (sign / length.max(1e-6));
                (rate - last * last.dot(rate)).as_quat()
            });
            Ok((last.as_quat(), rates))
        })?;
    }
    Ok(motion)
}

/// Returns the part of a quaternion about `axis`, not normalized.
fn along(rotation: DQuat, axis: DVec3) -> DQuat {
    let part = axis * rotation.xyz().dot(axis);
    DQuat::from_xyzw(part.x, part.y, part.z, rotation.w)
}

/// Returns a channel with every key's value, and a spline's tangents, changed.
pub(super) fn map(
    channel: &Channel<Vec3>,
    rest: Vec3,
    mut change: impl FnMut(f32, Vec3, [Vec3; 2]) -> Result<(Vec3, [Vec3; 2]), MotionError>,
) -> Result<Channel<Vec3>, MotionError> {
    let cubic = channel.interpolation == Interpolation::CubicSpline;
    let mut values = Vec::with_capacity(channel.values.len());
    for (key, &time) in channel.times.iter().enumerate() {
        let value = channel.value(key).map_or(rest, |value| value.healed(rest));
        let rates = if cubic { slopes(channel, rest, time) } else { [Vec3::ZERO; 2] };
        let (value, [before, after]) = change(time, value, rates)?;
        if cubic { values.extend([before, value, after]) } else { values.push(value) }
    }
    Ok(with_values(channel, values))
}

/// As [`map`], for rotations.
pub(super) fn map_turns(
    channel: &Channel<Quat>,
    rest: Quat,
    mut change: impl FnMut(f32, Quat, [Quat; 2]) -> Result<(Quat, [Quat; 2]), MotionError>,
) -> Result<Channel<Quat>, MotionError> {
    let cubic = channel.interpolation == Interpolation::CubicSpline;
    let mut values = Vec::with_capacity(channel.values.len());
    for (key, &time) in channel.times.iter().enumerate() {
        let value = channel.value(key).map_or(rest, |value| value.healed(rest));
        let rates = if cubic { spins(channel, time) } else { [Quat::from_array([0.0; 4]); 2] };
        let (value, [before, after]) = change(time, value, rates)?;
        if cubic { values.extend([before, value, after]) } else { values.push(value) }
    }
    Ok(with_values(channel, values))
}
