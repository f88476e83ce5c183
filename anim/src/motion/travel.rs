//! Moves travel between bones: from the hips to the root, from the root to the hips, or out of the take.
//!
//! With the motion `M(t)` of the upper or the lower bone, all positions are relative to to-root space:
//!
//! ```text
//! to an ancestor:    root' = M root        each kept bone:  x' = P⁻¹ M⁻¹ P x        P: its parent before
//! to a descendant:   root' = M⁻¹ root      each kept bone:  x' = P'⁻¹ M P' x        P': its parent after
//! ```
//!
//! On the way up, the kept bones are the children of the upper bone: everything else stays where it was. On the way down, they
//! are the lower bone, and the other children of the bones from the upper one down to the parent of the lower one: only the
//! bones between move differently. The formulas are those of
//! [`extract`](super::extract()) and [`restore`](super::restore()), for a motion that another bone has.
//!
//! Between keys a product of interpolated values differs from an interpolated product, so all changed bones get keys at
//! every frame where the motion turns or is smoothed.

use super::extract::{extract, times_above, track_of, with_track};
use super::keys::{Refine, union};
use super::restore::{MotionDirection, apply, keyed};
use super::{MotionError, RootMotion, RootMotionOptions};
use crate::data::{BoneIndex, Channel, Interpolation, Skeleton, Take};
use crate::inbetween::{KeyValue, gaussian};
use crate::retarget::normalized_name;
use crate::sample::{rest_pose, sample_channel};
use glam::{Quat, Vec3};

/// Largest number of frames of a motion.
const MOST_FRAMES: f64 = 1e6;

/// Options of extraction: the parts, and the smoothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TravelOptions {
    /// The parts of the movement.
    pub motion: RootMotionOptions,
    /// Standard deviation of the Gaussian that smooths the motion, in frames. What it removes stays in the bone. 0: the
    /// motion is not smoothed.
    pub smooth: f32,
    /// Frames per second, for smoothing and for motion that turns; must be positive.
    pub rate: f32,
}

/// A motion, and the take from which it was extracted or in which it was moved.
#[derive(Clone, Debug, PartialEq)]
pub struct Travel {
    /// The motion.
    pub motion: RootMotion,
    /// The take without it, or with the motion in the other bone.
    pub take: Take,
}

/// Extracts the motion of `bone`. Returns the motion and the take in place; [`put_back`] is its inverse.
///
/// # Errors
///
/// See [`MotionError`].
pub fn take_travel(
    take: &Take,
    skeleton: &Skeleton,
    bone: BoneIndex,
    options: &TravelOptions,
) -> Result<Travel, MotionError> {
    let motion = measured(take, skeleton, bone, options)?;
    let take = carried(take, take, skeleton, &motion, bone, MotionDirection::Extract)?;
    Ok(Travel { motion, take })
}

/// Puts a motion back into the bone from which [`take_travel`] extracted it.
///
/// # Errors
///
/// See [`MotionError`].
pub fn put_back(take: &Take, skeleton: &Skeleton, motion: &RootMotion) -> Result<Take, MotionError> {
    let bone = motion.bone;
    if bone as usize >= skeleton.len() {
        return Err(MotionError::NoSuchBone { bone });
    }
    carried(take, take, skeleton, motion, bone, MotionDirection::Restore)
}

/// Moves the motion of `from` to `to`, an ancestor or a descendant of it. The figure looks the same at all keys.
///
/// # Errors
///
/// See [`MotionError`].
pub fn move_travel(
    take: &Take,
    skeleton: &Skeleton,
    from: BoneIndex,
    to: BoneIndex,
    options: &TravelOptions,
) -> Result<Travel, MotionError> {
    for bone in [from, to] {
        if bone as usize >= skeleton.len() {
            return Err(MotionError::NoSuchBone { bone });
        }
    }
    let is_above = |upper: BoneIndex, lower| skeleton.ancestors(lower).any(|bone| bone == upper);
    let motion = || measured(take, skeleton, from, options);
    if is_above(to, from) {
        let motion = motion()?;
        let mut moved = carried(take, take, skeleton, &motion, to, MotionDirection::Restore)?;
        for bone in skeleton.children(Some(to)) {
            moved = carried(take, &moved, skeleton, &motion, bone, MotionDirection::Extract)?;
        }
        Ok(Travel { motion, take: moved })
    } else if is_above(from, to) {
        let motion = motion()?;
        let still = carried(take, take, skeleton, &motion, from, MotionDirection::Extract)?;
        let mut moved = still.clone();
        let turns =
            |bone: BoneIndex| take.tracks.get(bone as usize).is_some_and(|track| !track.rotation.is_empty());
        for bone in kept_bones(skeleton, from, to) {
            let mut source = still.clone();
            if skeleton.ancestors(bone).any(turns) {
                // Between keys, a bone below one that turns moves on a curve.
                let frames = frames(take, options.rate).ok_or(MotionError::Rate)?;
                let (mut track, rest) = (track_of(&still, bone), rest_pose(&skeleton.bones[bone as usize]));
                track.translation = Vec3::refined(&unstepped(&track.translation), rest.translation, &frames);
                source = with_track(&source, track);
            }
            moved = carried(&source, &moved, skeleton, &motion, bone, MotionDirection::Restore)?;
        }
        Ok(Travel { motion, take: moved })
    } else {
        Err(MotionError::NotInLine { from, to })
    }
}

/// Returns the bones that [`move_travel`] changes.
pub fn travel_bones(skeleton: &Skeleton, from: BoneIndex, to: BoneIndex) -> Vec<BoneIndex> {
    // A parent comes before its children.
    let mut bones: Vec<BoneIndex> =
        if to < from { skeleton.children(Some(to)).collect() } else { kept_bones(skeleton, from, to) };
    bones.push(from.min(to));
    bones.sort_unstable();
    bones
}

/// Returns `lower`, and the children of the bones from `upper` to the parent of `lower` that are not between the two.
fn kept_bones(skeleton: &Skeleton, upper: BoneIndex, lower: BoneIndex) -> Vec<BoneIndex> {
    let mut line: Vec<BoneIndex> = Vec::new();
    for bone in skeleton.ancestors(lower) {
        line.push(bone);
        if bone == upper {
            break;
        }
    }
    let is_kept = |bone: &BoneIndex| {
        let parent = skeleton.bones[*bone as usize].parent.filter(|parent| parent < bone);
        parent.is_some_and(|parent| line.contains(&parent)) && !line.contains(bone)
    };
    (0..skeleton.len() as BoneIndex).filter(is_kept).collect()
}

/// Returns the motion of a bone, with keys at every frame where it turns or is smoothed.
fn measured(
    take: &Take,
    skeleton: &Skeleton,
    bone: BoneIndex,
    options: &TravelOptions,
) -> Result<RootMotion, MotionError> {
    let track = track_of(take, bone);
    let (translation, rotation) = (unstepped(&track.translation), unstepped(&track.rotation));
    let unstepped_take = with_track(take, crate::data::Track { translation, rotation, ..track });
    let (mut motion, _) = extract(&unstepped_take, skeleton, bone, options.motion)?;
    let smooth = options.smooth > 0.0;
    let turns =
        |bone: BoneIndex| take.tracks.get(bone as usize).is_some_and(|track| !track.rotation.is_empty());
    let turned = !motion.rotation.is_empty() || skeleton.ancestors(bone).any(turns);
    if !smooth && !turned {
        return Ok(motion);
    }
    let frames = frames(take, options.rate).ok_or(MotionError::Rate)?;
    if smooth {
        let sigma = f64::from(options.smooth);
        motion.translation = smoothed(
            &motion.translation,
            &frames,
            |channel, time| sample_channel(channel, Vec3::ZERO, time),
            sigma,
        );
        motion.rotation = smoothed(
            &motion.rotation,
            &frames,
            |channel, time| sample_channel(channel, Quat::IDENTITY, time),
            sigma,
        );
    } else {
        if !motion.translation.is_empty() {
            motion.translation = Vec3::refined(&motion.translation, Vec3::ZERO, &frames);
        }
        if !motion.rotation.is_empty() {
            motion.rotation = Quat::refined(&motion.rotation, Quat::IDENTITY, &frames);
        }
    }
    Ok(motion)
}

/// Returns the times of the frames of a take and of its end; `None` where they are too many, or the rate is not positive.
fn frames(take: &Take, rate: f32) -> Option<Vec<f32>> {
    let frames = f64::from(take.length.max(0.0)) * f64::from(rate);
    let usable = rate > 0.0 && frames <= MOST_FRAMES;
    if !usable {
        return None;
    }
    let at = |frame: usize| (f64::from(take.start) + frame as f64 / f64::from(rate)) as f32;
    let mut times: Vec<f32> = (0..=frames as usize).map(at).filter(|&time| time < take.end()).collect();
    // A last frame that differs from the end by rounding is the end.
    if times.len() > 1 && times.last().is_some_and(|&last| take.end() - last < 1e-4) {
        times.pop();
    }
    times.push(take.end());
    Some(times)
}

/// Returns a linear channel with keys at `frames`, smoothed; an empty channel unchanged.
fn smoothed<T: KeyValue>(
    channel: &Channel<T>,
    frames: &[f32],
    sample: impl Fn(&Channel<T>, f32) -> T,
    sigma: f64,
) -> Channel<T> {
    if channel.is_empty() {
        return channel.clone();
    }
    let mut samples: Vec<T> = frames.iter().map(|&time| sample(channel, time)).collect();
    for index in 1..samples.len() {
        samples[index] = samples[index].near(samples[index - 1]);
    }
    Channel::new(frames.to_vec(), gaussian(&samples, sigma), Interpolation::Linear)
}

/// Returns `result` with the track of `bone` in `take` after the motion is extracted from it or restored in it.
fn carried(
    take: &Take,
    result: &Take,
    skeleton: &Skeleton,
    motion: &RootMotion,
    bone: BoneIndex,
    direction: MotionDirection,
) -> Result<Take, MotionError> {
    let turns = !motion.rotation.is_empty();
    if !turns && motion.translation.is_empty() {
        return Ok(result.clone());
    }
    let rest = rest_pose(&skeleton.bones[bone as usize]);
    let above = times_above(take, skeleton, bone);
    let times = union([&motion.translation.times[..], &motion.rotation.times, &above]);
    let mut track = track_of(take, bone);
    (track.translation, track.rotation) = (unstepped(&track.translation), unstepped(&track.rotation));
    if turns {
        track.rotation = keyed(&track.rotation, rest.rotation, &times, motion.rotation.interpolation);
    }
    let times = if turns { union([&times[..], &track.rotation.times]) } else { times };
    let kind = match motion.translation.is_empty() {
        true => motion.rotation.interpolation,
        false => motion.translation.interpolation,
    };
    track.translation = keyed(&track.translation, rest.translation, &times, kind);
    Ok(with_track(result, apply(take, skeleton, &track, motion, direction)?))
}

/// Returns a channel of steps that all have the same value within rounding as one linear key: it may then follow a motion between
/// its keys. Others are returned unchanged; where their steps differ, the bone follows in steps.
fn unstepped<T: KeyValue>(channel: &Channel<T>) -> Channel<T> {
    let steps = match channel.interpolation {
        Interpolation::Step | Interpolation::Closest => true,
        Interpolation::Linear | Interpolation::CubicSpline => false,
    };
    let (&[time, ..], &[value, ..]) = (&channel.times[..], &channel.values[..]) else {
        return channel.clone();
    };
    let same = |other: &T| {
        let (a, b) = (value.numbers(), other.near(value).numbers());
        (0..4).all(|lane| (a[lane] - b[lane]).abs() <= 1e-5 * (1.0 + a[lane].abs()))
    };
    if steps && channel.values.iter().all(same) {
        return Channel::new([time], [value], Interpolation::Linear);
    }
    channel.clone()
}

/// Returns the bone that is most likely the hips: the first of a usual name, or else the first bone with keys from which three
/// branches leave.
pub fn guess_hips(skeleton: &Skeleton) -> Option<BoneIndex> {
    let named = |name: &str| {
        let is = |bone: &crate::data::Bone| normalized_name(&bone.name) == name;
        skeleton.bones.iter().position(is).map(|bone| bone as BoneIndex)
    };
    ["hips", "hip", "pelvis", "cog", "centerofgravity", "torso", "body"].into_iter().find_map(named).or_else(
        || {
            let mut children = vec![0_u32; skeleton.len()];
            let parents = skeleton.bones.iter().filter_map(|bone| bone.parent);
            parents.for_each(|parent| children[parent as usize] += 1);
            children.iter().position(|&count| count >= 3).map(|bone| bone as BoneIndex)
        },
    )
}

/// Returns the bone that is most likely the root above `hips`: an ancestor called root, or else the topmost one. `None` where no
/// bone is above.
pub fn guess_root(skeleton: &Skeleton, hips: BoneIndex) -> Option<BoneIndex> {
    let above: Vec<usize> = skeleton.ancestors(hips).map(|bone| bone as usize).collect();
    let is_root = |bone: &&usize| normalized_name(&skeleton.bones[**bone].name).starts_with("root");
    above.iter().find(is_root).or(above.last()).map(|&bone| bone as BoneIndex)
}
