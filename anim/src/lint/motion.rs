//! Measures of the motion of bones, frame by frame.
//!
//! With `p(f)` the position, `v(f) = p(f+1) − p(f)` the step and `a(f) = v(f) − v(f−1)` its change:
//!
//! ```text
//! jitter   min(|a(f−1)|, |a(f)|, |a(f+1)|)     where a(f)·a(f−1) < 0 and a(f)·a(f+1) < 0
//! pop      |v(f)| − 2 max(|v(f−1)|, |v(f+1)|)   a step that its neighbors do not announce
//! flip     angle between the rotations of f and f+1
//! stretch  |length(f) / rest length − 1|
//! limit    angle between the rotation of f and the nearest that the joint allows
//! ```
//!
//! A quick movement has a large acceleration, but in one direction over several frames; a tremble changes its direction at each
//! frame. A pose that is wrong for one frame is two pops, of which the first is reported.

use super::{LintReport, LintThresholds};
use crate::contact::{Contact, detect_contacts, feet_by_name, take_slide};
use crate::data::{BoneIndex, Skeleton};
use crate::frames::TakeFrames;
use crate::loops::loop_gaps;
use crate::sample::rest_pose;
use glam::Vec3;

/// Bones shorter than this share of the longest are at the origin of their parent, and have no length to keep.
const SHORTEST: f32 = 1e-3;

/// Calls `add` for each bone with the frame of the largest amount of `measure`, if that is above zero.
fn worst(
    frames: &TakeFrames,
    range: std::ops::Range<usize>,
    add: LintReport<'_>,
    measure: impl Fn(usize, BoneIndex) -> f32,
) {
    for bone in 0..frames.bones() as BoneIndex {
        let mut largest = (0.0, 0);
        for frame in range.clone() {
            let amount = measure(frame, bone);
            if amount > largest.0 {
                largest = (amount, frame);
            }
        }
        if largest.0 > 0.0 {
            add(bone, frames.times()[largest.1], largest.0);
        }
    }
}

fn millimeters(thresholds: &LintThresholds) -> f32 {
    1000.0 * thresholds.contacts.meters_per_unit
}

pub(super) fn jitter(frames: &TakeFrames, thresholds: &LintThresholds, add: LintReport<'_>) {
    let unit = millimeters(thresholds);
    let bend = |frame: usize, bone: BoneIndex| -> Vec3 {
        let at = |frame: usize| frames.position(frame, bone);
        at(frame + 1) - at(frame) - (at(frame) - at(frame - 1))
    };
    worst(frames, 2..frames.len().saturating_sub(2), add, |frame, bone| {
        let [before, now, after] = [frame - 1, frame, frame + 1].map(|frame| bend(frame, bone));
        let alternates = now.dot(before) < 0.0 && now.dot(after) < 0.0;
        if alternates { before.length().min(now.length()).min(after.length()) * unit } else { 0.0 }
    });
}

pub(super) fn foot_slide(
    frames: &TakeFrames,
    skeleton: &Skeleton,
    thresholds: &LintThresholds,
    add: LintReport<'_>,
) {
    let (settings, given) = (&thresholds.contacts, &thresholds.given);
    let feet = if given.is_empty() { feet_by_name(skeleton) } else { given.bones() };
    for foot in feet {
        let found = match given.is_empty() {
            true => detect_contacts(frames, &[foot], settings),
            false => given.of_bone(foot).to_vec(),
        };
        let slide = |contacts: &[Contact]| {
            let slide = take_slide(frames, contacts, settings.up, settings.meters_per_unit);
            slide.millimeters_per_second()
        };
        let speeds = found.iter().map(|contact| (contact.from, slide(&[*contact])));
        let worst = speeds.max_by(|(_, a), (_, b)| a.total_cmp(b));
        add(foot, worst.map_or(0.0, |(from, _)| from), slide(&found));
    }
}

pub(super) fn floor(frames: &TakeFrames, thresholds: &LintThresholds, add: LintReport<'_>) {
    let (up, unit) = (thresholds.contacts.up.to_vec3(), millimeters(thresholds));
    worst(frames, 0..frames.len(), add, |frame, bone| {
        (thresholds.floor - frames.position(frame, bone).dot(up)) * unit
    });
}

pub(super) fn pop(frames: &TakeFrames, thresholds: &LintThresholds, add: LintReport<'_>) {
    let unit = millimeters(thresholds);
    let step = |frame: usize, bone: BoneIndex| {
        frames.position(frame + 1, bone).distance(frames.position(frame, bone))
    };
    // A pose that is wrong for one frame has two large steps, so the steps beyond the neighbors count.
    let steps = frames.len().saturating_sub(1);
    worst(frames, 2..steps.saturating_sub(2), add, |frame, bone| {
        let at = |frame: usize| step(frame, bone);
        let before = at(frame - 1).max(at(frame - 2));
        let single = at(frame) - 2.0 * before.max(at(frame + 1));
        let double = at(frame).min(at(frame + 1)) - 2.0 * before.max(at(frame + 2));
        single.max(double) * unit
    });
}

pub(super) fn flip(frames: &TakeFrames, add: LintReport<'_>) {
    worst(frames, 1..frames.len(), add, |frame, bone| {
        let (before, now) = (frames.pose(frame - 1, bone).rotation, frames.pose(frame, bone).rotation);
        let between = before.conjugate() * now;
        (2.0 * libm::atan2f(between.xyz().length(), between.w.abs())).to_degrees()
    });
}

pub(super) fn stretch(frames: &TakeFrames, skeleton: &Skeleton, add: LintReport<'_>) {
    let rest = |bone: &crate::data::Bone| bone.rest.translation.length();
    let with_parents = skeleton.bones.iter().filter(|bone| bone.parent.is_some());
    let longest = with_parents.map(rest).fold(0.0, f32::max);
    worst(frames, 0..frames.len(), add, |frame, bone| {
        let data = &skeleton.bones[bone as usize];
        let length = rest(data);
        if data.parent.is_none() || length.is_nan() || length <= SHORTEST * longest {
            return 0.0;
        }
        (frames.pose(frame, bone).translation.length() / length - 1.0).abs() * 100.0
    });
}

pub(super) fn joint_limit(
    frames: &TakeFrames,
    skeleton: &Skeleton,
    thresholds: &LintThresholds,
    add: LintReport<'_>,
) {
    for (bone, limit) in thresholds.joints.iter() {
        let Some(rest) = skeleton.bones.get(bone as usize) else { continue };
        let rest = rest_pose(rest).rotation;
        let beyond = |frame: usize| limit.clamp(frames.pose(frame, bone).rotation, rest).by.to_degrees();
        let all = (0..frames.len()).map(|frame| (frame, beyond(frame)));
        // The first of several frames that are equally far beyond.
        let worst = all.fold((0, 0.0), |worst, now| if now.1 > worst.1 { now } else { worst });
        if worst.1 > 0.0 {
            add(bone, frames.times()[worst.0], worst.1);
        }
    }
}

pub(super) fn loop_gap(frames: &TakeFrames, thresholds: &LintThresholds, add: LintReport<'_>) {
    let unit = millimeters(thresholds);
    let last = frames.times()[frames.len() - 1];
    for gap in loop_gaps(frames, None, thresholds.contacts.up) {
        add(gap.bone, last, gap.position * unit);
    }
}
