//! Hips that follow feet which are out of reach.
//!
//! A figure with wide hips on short legs cannot keep its feet where they are planted while the hips move and tilt as those of the
//! source. With `h` the upper joint of a leg, `L` its length, and `a` the place where its foot is planted, the hips move by the
//! smallest `d` with
//!
//! ```text
//! |h + d − a| ≤ L        for each foot in contact
//! ```
//!
//! found by moving toward one foot after the other, smoothed over time and repaired again. After the adjustment of the root in Kovar,
//! Schreiner, Gleicher, "Footskate cleanup for motion capture editing" (2002).

use super::rest::parent_of;
use crate::animation::to_root;
use crate::contact::{Contact, limb_of};
use crate::data::{BoneIndex, Channel, Interpolation, Skeleton, Take, Transform};
use crate::inbetween::gaussian;
use crate::sample::{rest_pose, sample_channel, sample_take};
use glam::{Mat3, Mat4, Vec3};

/// Part of the length of a leg that counts as its reach: a stretched leg has no direction in which the knee bends.
const REACH: f32 = 0.999;
/// Standard deviation of the smoothing of the movement of the hips, seconds.
const SMOOTH: f64 = 0.1;
/// Number of times that the movement is smoothed and repaired.
const ROUNDS: usize = 4;
/// Number of times that the hips move toward each foot.
const STEPS: usize = 16;

/// A foot in contact in one frame.
struct HeldFoot {
    hip: Vec3,
    anchor: Vec3,
    reach: f32,
}

impl HeldFoot {
    /// Returns how far the hips, moved by `by`, have to move so that the foot is in reach.
    fn missing(&self, by: Vec3) -> Vec3 {
        let way = self.anchor - self.hip - by;
        let far = way.length() - self.reach;
        if far > 0.0 { way.normalize_or_zero() * far } else { Vec3::ZERO }
    }
}

/// Moves the hips so that feet can stay at their mean places in contacts, where they are too far for that.
pub(super) fn bring_into_reach(
    take: &mut Take,
    target: &Skeleton,
    contacts: &[Contact],
    hips: BoneIndex,
    rate: f32,
) {
    let frames = (take.length * rate + 1e-3) as usize;
    let time = |frame: usize| (take.start + frame as f32 / rate).min(take.end());
    let mut poses = vec![Transform::IDENTITY; target.len()];
    let mut matrices = vec![Mat4::IDENTITY; target.len()];
    // The places of all held legs: contact, hip, foot, length.
    let mut legs: Vec<Vec<(usize, Vec3, Vec3, f32)>> = Vec::with_capacity(frames + 1);
    let mut parents: Vec<Mat3> = Vec::with_capacity(frames + 1);
    let parent = parent_of(target, hips as usize);
    for frame in 0..=frames {
        sample_take(Some(take), target, time(frame), &mut poses);
        to_root(target, &poses, &mut matrices);
        let place = |bone: BoneIndex| matrices[bone as usize].w_axis.truncate();
        let held = contacts.iter().enumerate().filter(|(_, contact)| {
            (contact.from - 0.5 / rate..=contact.to + 0.5 / rate).contains(&time(frame))
        });
        let leg = |(index, contact): (usize, &Contact)| {
            let limb = limb_of(target, contact.bone)?;
            let (root, middle, end) = (place(limb.root), place(limb.middle), place(limb.end));
            Some((index, root, end, root.distance(middle) + middle.distance(end)))
        };
        legs.push(held.filter_map(leg).collect());
        parents.push(parent.map_or(Mat3::IDENTITY, |parent| Mat3::from_mat4(matrices[parent])));
    }
    let anchors: Vec<Vec3> = (0..contacts.len())
        .map(|contact| {
            let places = legs.iter().flatten().filter(|leg| leg.0 == contact).map(|leg| leg.2);
            let (sum, count) =
                places.fold((Vec3::ZERO, 0.0), |(sum, count), place| (sum + place, count + 1.0));
            if count > 0.0 { sum / count } else { Vec3::ZERO }
        })
        .collect();
    let feet: Vec<Vec<HeldFoot>> = legs
        .iter()
        .map(|legs| {
            let foot = |&(contact, hip, _, length): &(usize, Vec3, Vec3, f32)| HeldFoot {
                hip,
                anchor: anchors[contact],
                reach: REACH * length,
            };
            legs.iter().map(foot).collect()
        })
        .collect();
    let mut moved = vec![Vec3::ZERO; feet.len()];
    repair(&mut moved, &feet);
    if moved.iter().all(|by| *by == Vec3::ZERO) {
        return;
    }
    for _ in 0..ROUNDS {
        moved = gaussian(&moved, SMOOTH * f64::from(rate));
        repair(&mut moved, &feet);
    }
    let at = |time: f32| {
        let place = ((time - take.start) * rate).max(0.0).min(frames as f32);
        let (before, part) = (place as usize, place.fract());
        let after = (before + 1).min(frames);
        let inner = |frame: usize| parents[frame].inverse() * moved[frame];
        inner(before).lerp(inner(after), part)
    };
    let rest = rest_pose(&target.bones[hips as usize]).translation;
    let Some(channel) = take.tracks.get(hips as usize).map(|track| track.translation.clone()) else {
        return;
    };
    let mut times: Vec<f32> = channel.times.iter().copied().chain((0..=frames).map(time)).collect();
    times.sort_by(f32::total_cmp);
    times.dedup_by(|later, earlier| *later - *earlier < 1e-4);
    let values: Vec<Vec3> =
        times.iter().map(|&time| sample_channel(&channel, rest, time) + at(time)).collect();
    if !values.iter().all(|value| value.is_finite()) {
        return;
    }
    take.tracks[hips as usize].translation = Channel::new(times, values, Interpolation::Linear);
}

/// Moves the hips of each frame on until all feet in contact are in reach, or as near as two feet far from each other allow.
fn repair(moved: &mut [Vec3], feet: &[Vec<HeldFoot>]) {
    for (by, feet) in moved.iter_mut().zip(feet) {
        for _ in 0..STEPS {
            let before = *by;
            for foot in feet {
                *by += foot.missing(*by);
            }
            if *by == before {
                break;
            }
        }
    }
}
