//! Locking: inside a contact, the foot is held by two-bone IK; before and after, the correction fades.
//!
//! With `p(t)` the position of the foot, `a` its mean position over the frames of the contact `[t₀, t₁]`, `e` the ease in
//! seconds and `s(x) = x² (3 − 2x)` clamped to 0..=1, the target is
//!
//! ```text
//! t₀ − e < t < t₀    p(t) + s(1 − (t₀ − t) / e) · (a − p(t₀))
//! t₀ ≤ t ≤ t₁        a
//! t₁ < t < t₁ + e    p(t) + s(1 − (t − t₁) / e) · (a − p(t₁))
//! ```
//!
//! The mean is taken rather than the first frame because it is the anchor with the smallest sum of squared corrections. An
//! ease is not longer than the gap to the next contact of the bone; where two overlap, both corrections are added. The
//! foot keeps its direction in scene space. After Kovar, Schreiner, Gleicher, "Footskate cleanup for motion capture
//! editing" (2002), without their lengthening of bones: a target out of reach is left as far away as
//! [`LockedTake::farthest`] says.
//!
//! Keys are written at every frame of the contacts and eases, and at the key times of the bones above between them: the
//! hips move between existing keys of the leg, so keys at existing times only would let the foot slide between them.

use super::{Contact, limb_of};
use crate::animation::to_root;
use crate::data::{BoneIndex, Channel, Interpolation, Skeleton, Take, Track, Transform};
use crate::ik::{EndOrientation, IkError, TwoBone, two_bone};
use crate::sample::{rest_pose, sample_channel, sample_take};
use glam::{Mat4, Quat, Vec3};
use std::collections::HashSet;

/// How contacts are locked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LockSettings {
    /// Frames per second of the new keys.
    pub rate: f32,
    /// Number of frames over which the correction fades before and after a contact.
    pub ease: u32,
}

/// Reasons why contacts cannot be locked.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LockError {
    /// The bone has fewer than two bones above it, or does not exist.
    #[error("bone {bone} has no limb: two bones above it are needed")]
    NoLimb {
        /// The bone of the contact.
        bone: BoneIndex,
    },
    /// The frame rate is not a positive number, or the contacts have more than a million frames.
    #[error("the contacts cannot be sampled at {rate} frames per second")]
    Rate {
        /// The rate that was given.
        rate: f32,
    },
    /// The limb cannot be solved.
    #[error("at {seconds} s: {error}")]
    Solve {
        /// Time in the take.
        seconds: f32,
        /// The reason.
        error: IkError,
    },
}

/// A take with locked contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct LockedTake {
    /// The take; only the rotations of the limbs of the contacts differ.
    pub take: Take,
    /// Largest distance between a foot and its anchor inside a contact, in the model's unit: above zero where the anchor is out
    /// of reach.
    pub farthest: f32,
    /// The bones whose rotations have new keys, ascending.
    pub bones: Vec<BoneIndex>,
}

/// Part of the length of a limb by which its end has to move to count as moved.
const MOVED: f32 = 1e-5;

/// Largest number of frames in the contacts of one bone.
const MOST_FRAMES: f32 = 1e6;

/// Holds each bone of `contacts` at its mean position in the contact. Bones are locked from the root down, those with the same
/// number of bones above them by name, whatever the order of bones in the file; locking both an ankle and its toes moves the ankle
/// again.
///
/// A rotation channel of a limb that is not linear is first replaced by linear keys at every frame of the take.
///
/// # Errors
///
/// A bone without a limb, an unusable rate, or a limb that cannot be solved. Nothing is changed then.
pub fn lock_contacts(
    take: &Take,
    skeleton: &Skeleton,
    contacts: &[Contact],
    settings: &LockSettings,
) -> Result<LockedTake, LockError> {
    lock(take, None, skeleton, contacts, settings)
}

/// Holds each bone of `contacts` at its mean position in the take `planted`.
pub(crate) fn lock_planted(
    take: &Take,
    planted: &Take,
    skeleton: &Skeleton,
    contacts: &[Contact],
    settings: &LockSettings,
) -> Result<LockedTake, LockError> {
    lock(take, Some(planted), skeleton, contacts, settings)
}

/// Holds bones in those of `contacts` in which a change of the take moved them, at their mean position before the change: a foot stays
/// where it was planted. `before` is the take without the change. Contacts in which no bone moved stay as they are.
///
/// # Errors
///
/// As [`lock_contacts`]. Nothing is changed then.
pub fn hold_contacts(
    take: &Take,
    before: &Take,
    skeleton: &Skeleton,
    contacts: &[Contact],
    settings: &LockSettings,
) -> Result<LockedTake, LockError> {
    check_rate(take, settings)?;
    let frames = frame_times(take, settings.rate);
    let mut poses = [LegPose::of(skeleton), LegPose::of(skeleton)];
    let mut was_moved = |contact: &&Contact| {
        let reach = limb_of(skeleton, contact.bone).map_or(0.0, |limb| {
            let length = |bone: BoneIndex| skeleton.bones[bone as usize].rest.translation.length();
            length(limb.middle) + length(limb.end)
        });
        let inside = frames.iter().copied().filter(|time| (contact.from..=contact.to).contains(time));
        inside.chain([contact.from, contact.to]).any(|time| {
            let [a, b] = &mut poses;
            a.at(before, time);
            b.at(take, time);
            a.position(contact.bone).distance(b.position(contact.bone)) > MOVED * reach
        })
    };
    let has_bone = |contact: &&Contact| (contact.bone as usize) < skeleton.len();
    let moved: Vec<Contact> = contacts.iter().filter(has_bone).filter(&mut was_moved).copied().collect();
    lock_planted(take, before, skeleton, &moved, settings)
}

fn check_rate(take: &Take, settings: &LockSettings) -> Result<(), LockError> {
    let rate = settings.rate;
    let usable = rate.is_finite() && rate > 0.0 && take.length * rate <= MOST_FRAMES;
    if usable { Ok(()) } else { Err(LockError::Rate { rate }) }
}

/// Holds each bone of `contacts` at its mean position in the take `planted`, or in the take itself.
fn lock(
    take: &Take,
    planted: Option<&Take>,
    skeleton: &Skeleton,
    contacts: &[Contact],
    settings: &LockSettings,
) -> Result<LockedTake, LockError> {
    check_rate(take, settings)?;
    let held: HashSet<BoneIndex> = contacts.iter().map(|contact| contact.bone).collect();
    if let Some(&bone) = held.iter().filter(|bone| **bone as usize >= skeleton.len()).min() {
        return Err(LockError::NoLimb { bone });
    }
    let mut locked = LockedTake { take: take.clone(), farthest: 0.0, bones: Vec::new() };
    // The order of locking matters for limbs that share bones; the order of the bones in the file must not.
    for bone in skeleton.by_depth_and_name().into_iter().filter(|bone| held.contains(bone)) {
        let limb = limb_of(skeleton, bone).ok_or(LockError::NoLimb { bone })?;
        let limb = TwoBone { end_orientation: EndOrientation::KeepToRoot, ..limb };
        let spans = merged(contacts.iter().filter(|contact| contact.bone == bone), take);
        lock_limb(&mut locked, planted, skeleton, &limb, &spans, settings)?;
    }
    locked.bones.sort_unstable();
    locked.bones.dedup();
    Ok(locked)
}

/// Returns the contacts within the take, ascending; those that overlap as one.
fn merged<'a>(contacts: impl Iterator<Item = &'a Contact>, take: &Take) -> Vec<(f32, f32)> {
    let clipped = contacts.map(|contact| (contact.from.max(take.start), contact.to.min(take.end())));
    let mut spans: Vec<(f32, f32)> = clipped.filter(|(from, to)| from <= to).collect();
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut merged: Vec<(f32, f32)> = Vec::new();
    for (from, to) in spans {
        match merged.last_mut().filter(|last| from <= last.1) {
            Some(last) => last.1 = last.1.max(to),
            None => merged.push((from, to)),
        }
    }
    merged
}

/// One contact with its anchor and its corrections.
struct HeldSpan {
    from: f32,
    to: f32,
    /// Seconds before and after over which the correction fades.
    ease: [f32; 2],
    anchor: Vec3,
    /// Anchor minus position at the start and at the end.
    correction: [Vec3; 2],
}

impl HeldSpan {
    fn reaches(&self, time: f32) -> bool {
        time >= self.from - self.ease[0] && time <= self.to + self.ease[1]
    }

    /// Returns the correction at a time outside of the contact.
    fn fading(&self, time: f32) -> Vec3 {
        let (side, distance) = if time < self.from { (0, self.from - time) } else { (1, time - self.to) };
        let ease = self.ease[side];
        if ease > 0.0 { self.correction[side] * smooth(1.0 - distance / ease) } else { Vec3::ZERO }
    }
}

/// Returns `x² (3 − 2x)`, for `x` clamped to 0..=1.
fn smooth(x: f32) -> f32 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The pose of a skeleton at a time, reused from time to time.
struct LegPose<'a> {
    skeleton: &'a Skeleton,
    poses: Vec<Transform>,
    matrices: Vec<Mat4>,
}

impl<'a> LegPose<'a> {
    fn of(skeleton: &'a Skeleton) -> Self {
        let bones = skeleton.len();
        Self { skeleton, poses: vec![Transform::IDENTITY; bones], matrices: vec![Mat4::IDENTITY; bones] }
    }

    fn at(&mut self, take: &Take, time: f32) {
        sample_take(Some(take), self.skeleton, time, &mut self.poses);
        self.chain();
    }

    fn chain(&mut self) {
        to_root(self.skeleton, &self.poses, &mut self.matrices);
    }

    fn position(&self, bone: BoneIndex) -> Vec3 {
        self.matrices[bone as usize].w_axis.truncate()
    }
}

fn lock_limb(
    locked: &mut LockedTake,
    planted: Option<&Take>,
    skeleton: &Skeleton,
    limb: &TwoBone,
    spans: &[(f32, f32)],
    settings: &LockSettings,
) -> Result<(), LockError> {
    let mut pose = LegPose::of(skeleton);
    let take = &locked.take;
    let frames = frame_times(take, settings.rate);
    let longest = settings.ease as f32 / settings.rate;
    let spans: Vec<HeldSpan> = (0..spans.len())
        .map(|index| {
            let (from, to) = spans[index];
            let before = index.checked_sub(1).map_or(f32::INFINITY, |before| from - spans[before].1);
            let after = spans.get(index + 1).map_or(f32::INFINITY, |after| after.0 - to);
            let inside: Vec<f32> =
                frames.iter().copied().filter(|time| (from..=to).contains(time)).chain([from, to]).collect();
            let mut sum = glam::DVec3::ZERO;
            let mut at = |take: &Take, time: f32| {
                pose.at(take, time);
                pose.position(limb.end)
            };
            let anchors = planted.unwrap_or(take);
            inside.iter().for_each(|&time| sum += at(anchors, time).as_dvec3());
            let anchor = (sum / inside.len() as f64).as_vec3();
            let correction = [anchor - at(take, from), anchor - at(take, to)];
            HeldSpan { from, to, ease: [longest.min(before), longest.min(after)], anchor, correction }
        })
        .collect();
    let times = key_times(take, skeleton, limb, &spans, &frames);
    let mut keys: [Vec<Quat>; 3] = Default::default();
    let bones = [limb.root, limb.middle, limb.end];
    for &time in &times {
        pose.at(take, time);
        let held = spans.iter().find(|span| (span.from..=span.to).contains(&time));
        let moved: Vec3 = spans.iter().filter(|span| span.reaches(time)).map(|span| span.fading(time)).sum();
        let target = held.map_or(pose.position(limb.end) + moved, |span| span.anchor);
        if held.is_some() || moved != Vec3::ZERO {
            let solved = two_bone(skeleton, &pose.matrices, limb, target, &mut pose.poses);
            let reach = solved.map_err(|error| LockError::Solve { seconds: time, error })?;
            if held.is_some() {
                locked.farthest = locked.farthest.max(reach.distance);
            }
        }
        for (keys, bone) in keys.iter_mut().zip(bones) {
            keys.push(pose.poses[bone as usize].rotation);
        }
    }
    let in_span = |time: f32| spans.iter().any(|span| span.reaches(time));
    for (keys, bone) in keys.into_iter().zip(bones) {
        let index = bone as usize;
        while locked.take.tracks.len() <= index {
            let bone = locked.take.tracks.len() as BoneIndex;
            locked.take.tracks.push(Track { bone, ..Track::default() });
        }
        let rest = rest_pose(&skeleton.bones[index]).rotation;
        let base = linear(&locked.take.tracks[index].rotation, rest, &frames);
        locked.take.tracks[index].rotation = spliced(&base, &times, keys, in_span);
        locked.bones.push(bone);
    }
    Ok(())
}

/// Returns the times of the frames of a take, and its end.
fn frame_times(take: &Take, rate: f32) -> Vec<f32> {
    let count = (f64::from(take.length.max(0.0)) * f64::from(rate) + 1e-3) as usize;
    let at = |frame: usize| (f64::from(take.start) + frame as f64 / f64::from(rate)) as f32;
    let mut times: Vec<f32> = (0..=count).map(at).filter(|&time| time <= take.end()).collect();
    times.push(take.end());
    times.dedup();
    times
}

/// Returns the times of the new keys: frames and borders of the spans, and the keys of the limb and of the bones above.
fn key_times(
    take: &Take,
    skeleton: &Skeleton,
    limb: &TwoBone,
    spans: &[HeldSpan],
    frames: &[f32],
) -> Vec<f32> {
    let mut times = frames.to_vec();
    for span in spans {
        let borders = [span.from - span.ease[0], span.from, span.to, span.to + span.ease[1]];
        times.extend(borders.map(|time| time.max(take.start).min(take.end())));
    }
    let mut bone = Some(limb.end);
    while let Some(index) = bone {
        if let Some(track) = take.tracks.get(index as usize) {
            times.extend(track.key_times());
        }
        bone = skeleton.bones[index as usize].parent;
    }
    times.retain(|&time| spans.iter().any(|span| span.reaches(time)));
    times.sort_by(f32::total_cmp);
    // Keys nearer to each other than a tenth of a millisecond are one: times of frames and keys differ by rounding.
    times.dedup_by(|later, earlier| *later - *earlier < 1e-4);
    times
}

/// Returns a linear channel with the same values at its keys and at `frames`; a linear channel unchanged.
fn linear(channel: &Channel<Quat>, rest: Quat, frames: &[f32]) -> Channel<Quat> {
    if channel.interpolation == Interpolation::Linear || channel.is_empty() {
        return Channel { interpolation: Interpolation::Linear, ..channel.clone() };
    }
    let mut times: Vec<f32> = channel.times.iter().chain(frames).copied().collect();
    times.sort_by(f32::total_cmp);
    times.dedup();
    let values: Vec<Quat> = times.iter().map(|&time| sample_channel(channel, rest, time)).collect();
    Channel::new(times, values, Interpolation::Linear)
}

/// Returns `base` with its keys inside the spans replaced by others. Each new rotation has the sign nearest to the one before.
fn spliced(
    base: &Channel<Quat>,
    times: &[f32],
    keys: Vec<Quat>,
    in_span: impl Fn(f32) -> bool,
) -> Channel<Quat> {
    let old = base.times.iter().zip(base.values.iter()).filter(|(time, _)| !in_span(**time));
    let mut all: Vec<(f32, Quat)> = old.map(|(&time, &value)| (time, value)).collect();
    all.extend(times.iter().copied().zip(keys));
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    for index in 1..all.len() {
        if all[index - 1].1.dot(all[index].1) < 0.0 {
            all[index].1 = -all[index].1;
        }
    }
    let (times, values): (Vec<f32>, Vec<Quat>) = all.into_iter().unzip();
    Channel::new(times, values, Interpolation::Linear)
}
