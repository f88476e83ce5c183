//! Retargeting of a whole figure: the transfer of [`retarget`](super::retarget()), chains of different length, and contacts.

use super::attach::AttachedFeet;
use super::convention::{BodyPart, BoneRole, SkeletonRoles};
use super::reach::bring_into_reach;
use super::spread::spread;
use super::standing::standing;
use super::twist::{has_free_twist_bone, twist};
use super::{RetargetOptions, SkeletonBinding, height_ratio, leg_ratio, rebind, retarget};
use crate::contact::{
    Contact, ContactThresholds, LockError, LockSettings, contact_slide, detect_contacts, feet_by_name,
    lock_planted,
};
use crate::data::{BoneIndex, Skeleton, Take, Track};
use crate::frames::{FramesError, TakeFrames, frame_rate};
use crate::motion::{Axis, guess_hips};
use crate::sample::rest_pose;

/// Height of the hips of a grown man, meters; the thresholds of contacts are for a figure of this size.
const HIPS: f32 = 0.95;

/// Options for a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FigureOptions {
    /// Whether feet stay where they touch the ground.
    pub contacts: bool,
    /// Number of frames over which the correction of a foot fades before and after a contact.
    pub ease: u32,
}

impl Default for FigureOptions {
    fn default() -> Self {
        Self { contacts: true, ease: 4 }
    }
}

/// Reasons why a figure cannot be retargeted.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FigureError {
    /// No bone is bound.
    #[error("no bone of the target is bound to one of the source")]
    Unbound,
    /// The take cannot be sampled.
    #[error(transparent)]
    Frames(#[from] FramesError),
    /// The feet cannot be locked.
    #[error(transparent)]
    Lock(#[from] LockError),
}

/// A retargeted take, and what was done for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Retargeted {
    /// The take of the target.
    pub take: Take,
    /// The target's size over that of the source.
    pub ratio: f32,
    /// The contacts of the target's feet.
    pub contacts: Vec<Contact>,
    /// The largest distance that a foot moved on the ground in a contact before locking, millimeters.
    pub slide_before: f32,
    /// The same after locking.
    pub slide_after: f32,
    /// Whether the keys are those of the source, because both skeletons are the same where the take moves them.
    pub is_copied: bool,
}

/// Returns `take` of the skeleton `source` for the skeleton `target`, with contacts as they are in the source.
///
/// # Errors
///
/// See [`FigureError`].
pub fn retarget_figure(
    take: &Take,
    source: &Skeleton,
    target: &Skeleton,
    binding: &SkeletonBinding,
    options: &FigureOptions,
) -> Result<Retargeted, FigureError> {
    if binding.bound() == 0 {
        return Err(FigureError::Unbound);
    }
    if is_same(take, source, target, binding) {
        // Nothing to compensate: the tracks as they are, and bones that stretch.
        let take = rebind(take, binding);
        return Ok(Retargeted {
            take,
            ratio: 1.0,
            contacts: Vec::new(),
            slide_before: 0.0,
            slide_after: 0.0,
            is_copied: true,
        });
    }
    let roles = SkeletonRoles::guess(target);
    let Some(attached) = AttachedFeet::of(target, &roles) else {
        return transferred(take, source, target, (binding, &roles), options);
    };
    let roles = SkeletonRoles::guess(&attached.skeleton);
    let binding = attached.binding(binding);
    let mut result = transferred(take, source, &attached.skeleton, (&binding, &roles), options)?;
    let mut times = frame_times(take);
    times.extend(result.take.tracks.iter().flat_map(Track::key_times));
    times.sort_by(f32::total_cmp);
    times.dedup_by(|later, earlier| *later - *earlier < 1e-5);
    result.take = attached.detached(&result.take, target, &times);
    result.contacts.iter_mut().for_each(|contact| contact.bone = attached.original(contact.bone));
    Ok(result)
}

/// Returns the times of the frames of a take.
fn frame_times(take: &Take) -> Vec<f32> {
    let rate = f64::from(frame_rate(take));
    let count = (f64::from(take.length.max(0.0)) * rate + 1e-3).min(1e6) as usize;
    (0..=count).map(|frame| (f64::from(take.start) + frame as f64 / rate) as f32).collect()
}

/// Returns whether every bone that the take moves is bound to one with the same rest pose, and so is every bone above it:
/// one skeleton may have bones that the other one lacks, such as those of a weapon, but no twist bones, which get a share of
/// the roll of their limb.
fn is_same(take: &Take, source: &Skeleton, target: &Skeleton, binding: &SkeletonBinding) -> bool {
    if has_free_twist_bone(target, binding) {
        return false;
    }
    let mut follower: Vec<Option<BoneIndex>> = vec![None; source.len()];
    for (bone, from) in (0..).zip(&binding.source_of) {
        let Some(follower) = from.and_then(|from| follower.get_mut(from as usize)) else { continue };
        if follower.replace(bone).is_some() {
            return false;
        }
    }
    let same = |from: BoneIndex| {
        let Some(other) = source.bones.get(from as usize) else { return false };
        let Some(bone) = follower[from as usize].and_then(|bone| target.bones.get(bone as usize)) else {
            return false;
        };
        let (a, b) = (rest_pose(bone), rest_pose(other));
        let near = a.translation.abs_diff_eq(b.translation, 1e-6 * (1.0 + a.translation.length()))
            && a.rotation.abs_diff_eq(b.rotation, 1e-6)
            && a.scale.abs_diff_eq(b.scale, 1e-6);
        let above = other.parent.map(|parent| follower[parent as usize]);
        near && bone.rest_matrix == other.rest_matrix && above == bone.parent.map(Some)
    };
    let moved = take.tracks.iter().filter(|track| !track.is_empty()).map(|track| track.bone);
    let mut checked = vec![false; source.len()];
    for bone in moved {
        for bone in std::iter::once(bone).chain(source.ancestors(bone)) {
            match checked.get_mut(bone as usize) {
                Some(checked) if *checked => break,
                Some(checked) => *checked = true,
                None => return false,
            }
            if !same(bone) {
                return false;
            }
        }
    }
    true
}

/// Transfers a take to a skeleton whose feet are below its legs.
fn transferred(
    take: &Take,
    source: &Skeleton,
    target: &Skeleton,
    (binding, roles): (&SkeletonBinding, &SkeletonRoles),
    options: &FigureOptions,
) -> Result<Retargeted, FigureError> {
    let hips = roles.bones(BoneRole { part: BodyPart::Hips, side: 0 }).first().copied();
    let hips = hips.or_else(|| guess_hips(target)).filter(|&hips| is_bound(binding, hips));
    let transfer =
        RetargetOptions { trunk: hips.map(|hips| trunk(target, hips)), ..RetargetOptions::default() };
    let carrier = hips.and_then(|hips| binding.source_of.get(hips as usize).copied().flatten());
    let grounded = carrier.map(|carrier| standing(source, take, carrier, transfer.up));
    let source = grounded.as_deref().unwrap_or(source);
    let ratio = leg_size(source, target, binding, roles)
        .unwrap_or_else(|| height_ratio(source, target, binding, hips.unwrap_or(0), transfer.up));
    let mut result =
        retarget(take, source, target, binding, &RetargetOptions { ratio: Some(ratio), ..transfer });
    let role = |bone: BoneIndex| roles.of.get(bone as usize).copied().flatten();
    spread(&mut result, source, target, binding, |bone, lower| {
        role(bone).is_some() && role(bone) == role(lower)
    });
    let mut retargeted = Retargeted {
        take: result,
        ratio,
        contacts: Vec::new(),
        slide_before: 0.0,
        slide_after: 0.0,
        is_copied: false,
    };
    if options.contacts {
        keep_contacts(&mut retargeted, take, source, target, (binding, roles), options)?;
    }
    twist(&mut retargeted.take, target, binding, roles);
    Ok(retargeted)
}

fn is_bound(binding: &SkeletonBinding, bone: BoneIndex) -> bool {
    binding.source_of.get(bone as usize).is_some_and(Option::is_some)
}

/// Returns the hips and the bones above them.
fn trunk(skeleton: &Skeleton, hips: BoneIndex) -> Vec<BoneIndex> {
    skeleton.with_ancestors(hips).collect()
}

/// Returns the mean ratio of the lengths of both legs, target to source.
fn leg_size(
    source: &Skeleton,
    target: &Skeleton,
    binding: &SkeletonBinding,
    roles: &SkeletonRoles,
) -> Option<f32> {
    let ratio = |side| {
        let bone = |part| roles.bones(BoneRole { part, side }).first().copied();
        leg_ratio(source, target, binding, bone(BodyPart::UpperLeg)?, bone(BodyPart::Foot)?)
    };
    Some(0.5 * (ratio(1)? + ratio(2)?))
}

/// Returns the bones of the target that are feet, each with the bone of the source that moves it.
fn feet(target: &Skeleton, binding: &SkeletonBinding, roles: &SkeletonRoles) -> Vec<(BoneIndex, BoneIndex)> {
    let by_role = [1, 2].into_iter().flat_map(|side| roles.bones(BoneRole { part: BodyPart::Foot, side }));
    let mut feet: Vec<BoneIndex> = by_role.collect();
    if feet.is_empty() {
        feet = feet_by_name(target);
    }
    let source = |&foot: &BoneIndex| binding.source_of.get(foot as usize).copied().flatten();
    feet.iter().filter_map(|foot| Some((source(foot)?, *foot))).collect()
}

fn keep_contacts(
    retargeted: &mut Retargeted,
    take: &Take,
    source: &Skeleton,
    target: &Skeleton,
    (binding, roles): (&SkeletonBinding, &SkeletonRoles),
    options: &FigureOptions,
) -> Result<(), FigureError> {
    let feet = feet(target, binding, roles);
    let rate = frame_rate(take);
    let usable = !feet.is_empty() && take.length > 0.0;
    if !usable {
        return Ok(());
    }
    let meters = |skeleton: &Skeleton, feet: &[BoneIndex]| HIPS / leg_length(skeleton, feet).max(1e-6);
    let source_feet: Vec<BoneIndex> = feet.iter().map(|(from, _)| *from).collect();
    let frames = TakeFrames::of(take, source, rate)?;
    let thresholds =
        ContactThresholds { meters_per_unit: meters(source, &source_feet), ..ContactThresholds::default() };
    let found = detect_contacts(&frames, &source_feet, &thresholds);
    let moved = |contact: &Contact| {
        let targets = feet.iter().filter(|(from, _)| *from == contact.bone);
        targets.map(|(_, bone)| Contact { bone: *bone, ..*contact }).collect::<Vec<_>>()
    };
    let contacts: Vec<Contact> = found.iter().flat_map(moved).collect();
    let target_feet: Vec<BoneIndex> = feet.iter().map(|(_, to)| *to).collect();
    let unit = meters(target, &target_feet);
    let slide = |take: &Take| -> Result<f32, FigureError> {
        let frames = TakeFrames::of(take, target, rate)?;
        let drifts = contacts.iter().map(|contact| contact_slide(&frames, contact, Axis::Y, unit).drift);
        Ok(drifts.fold(0.0, f32::max))
    };
    retargeted.slide_before = slide(&retargeted.take)?;
    if !contacts.is_empty() {
        let settings = LockSettings { rate, ease: options.ease };
        let planted = retargeted.take.clone();
        let hips = roles.bones(BoneRole { part: BodyPart::Hips, side: 0 }).first().copied();
        if let Some(hips) = hips {
            bring_into_reach(&mut retargeted.take, target, &contacts, hips, rate);
        }
        retargeted.take = lock_planted(&retargeted.take, &planted, target, &contacts, &settings)?.take;
    }
    retargeted.slide_after = slide(&retargeted.take)?;
    retargeted.contacts = contacts;
    Ok(())
}

/// Returns the length of the longest leg at rest, from the second bone above the foot to the foot, times the share that it has of the
/// height of the hips.
fn leg_length(skeleton: &Skeleton, feet: &[BoneIndex]) -> f32 {
    let mut matrices = vec![glam::Mat4::IDENTITY; skeleton.len()];
    crate::animation::to_root(skeleton, &[], &mut matrices);
    let place = |bone: BoneIndex| matrices[bone as usize].w_axis.truncate();
    let length = |&foot: &BoneIndex| {
        let limb = crate::contact::limb_of(skeleton, foot)?;
        Some(place(limb.root).distance(place(limb.middle)) + place(limb.middle).distance(place(foot)))
    };
    1.1 * feet.iter().filter_map(length).fold(0.0, f32::max)
}
