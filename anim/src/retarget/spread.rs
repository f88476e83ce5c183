//! Distribution of a bend over the bones of a chain that the source does not have.
//!
//! Where the target has more bones in a chain, the bones between two bound ones rest, and the lower bound one bends by all that the
//! source bends there. With `A_i` the product of the rest rotations from below the upper bound bone down to bone `i`, `R(t)` that of
//! the rotations down to the lower bone, `R_0` at rest, and `f_i` the share of the chain's length at bone `i`, the bones between get
//!
//! ```text
//! Δ(t) = R(t) R_0⁻¹        W_i(t) = slerp(1, Δ(t), f_i) A_i        q_i = W_(i-1)⁻¹ W_i
//! ```
//!
//! and the lower bone the rest, so that its direction stays what it was. Other children of the bones between are turned back.

use super::SkeletonBinding;
use super::rest::{RestPose, parent_of, source_of};
use crate::data::{BoneIndex, Channel, Interpolation, Skeleton, Take};
use crate::inbetween::KeyValue;
use crate::sample::sample_channel;
use glam::{DQuat, Quat};

/// Distributes the bend of each bound bone over the unbound bones right above it, where `is_chain` returns true for both:
/// they are of one chain.
pub(super) fn spread(
    take: &mut Take,
    source: &Skeleton,
    target: &Skeleton,
    binding: &SkeletonBinding,
    is_chain: impl Fn(BoneIndex, BoneIndex) -> bool,
) {
    let rest = RestPose::of(target);
    let is_bound = |bone: usize| source_of(binding, source, bone).is_some();
    for lower in (0..target.len()).filter(|&bone| is_bound(bone)) {
        let mut middle = Vec::new();
        let mut at = parent_of(target, lower);
        while let Some(bone) = at.filter(|&bone| !is_bound(bone)) {
            middle.push(bone);
            at = parent_of(target, bone);
        }
        let Some(upper) = at else { continue };
        let in_chain = |&bone: &usize| is_chain(bone as BoneIndex, lower as BoneIndex);
        if middle.is_empty() || !middle.iter().all(in_chain) {
            continue;
        }
        middle.reverse();
        let line = [&[upper], &middle[..], &[lower]].concat();
        let line: Vec<BoneIndex> = line.into_iter().map(|bone| bone as BoneIndex).collect();
        bend(take, target, &rest, &line);
    }
}

/// Distributes the bend of the last bone of a line over the bones between its ends.
fn bend(take: &mut Take, target: &Skeleton, rest: &RestPose, line: &[BoneIndex]) {
    let [_, middle @ .., lower] = line else { return };
    let lower = *lower as usize;
    let times = take.tracks[lower].rotation.times.clone();
    if times.is_empty() {
        return;
    }
    let shares = super::guess::shares(rest, line);
    // A_i, and R_0 last.
    let mut below = Vec::new();
    let mut product = DQuat::IDENTITY;
    for &bone in &line[1..] {
        product *= rest.own[bone as usize];
        below.push(product);
    }
    let above_lower = below[middle.len() - 1];
    let bend_at = |time: f32| {
        let own = sample_channel(&take.tracks[lower].rotation, rest.own[lower].as_quat(), time);
        (above_lower * own.as_dquat() * below[middle.len()].conjugate()).normalize()
    };
    let turned = |time: f32, index: usize| {
        let bend = bend_at(time);
        Quat::mix(Quat::IDENTITY, bend.as_quat(), shares[index + 1]).as_dquat() * below[index]
    };
    let mut tracks: Vec<(usize, Vec<f32>, Vec<DQuat>)> = Vec::new();
    for (index, &bone) in middle.iter().enumerate() {
        let own = |&time: &f32| match index {
            0 => turned(time, 0),
            _ => turned(time, index - 1).conjugate() * turned(time, index),
        };
        tracks.push((bone as usize, times.to_vec(), times.iter().map(own).collect()));
    }
    let last = middle.len() - 1;
    let own = |&time: &f32| turned(time, last).conjugate() * bend_at(time) * below[middle.len()];
    tracks.push((lower, times.to_vec(), times.iter().map(own).collect()));
    for (index, &bone) in middle.iter().enumerate() {
        let others = target.children(Some(bone)).filter(|child| !line.contains(child));
        for child in others.map(|child| child as usize) {
            let mut all: Vec<f32> =
                take.tracks[child].rotation.times.iter().chain(times.iter()).copied().collect();
            all.sort_by(f32::total_cmp);
            all.dedup();
            let own = |&time: &f32| {
                let before = sample_channel(&take.tracks[child].rotation, rest.own[child].as_quat(), time);
                turned(time, index).conjugate() * below[index] * before.as_dquat()
            };
            let values = all.iter().map(own).collect();
            tracks.push((child, all, values));
        }
    }
    for (bone, times, values) in tracks {
        let mut last = DQuat::IDENTITY;
        let near = |value: DQuat| -> Quat {
            let value = value.normalize();
            last = if value.dot(last) < 0.0 { -value } else { value };
            last.as_quat()
        };
        let values: Vec<Quat> = values.into_iter().map(near).collect();
        take.tracks[bone].rotation = Channel::new(times, values, Interpolation::Linear);
    }
}
