//! Transfer of a take to another skeleton.

use super::SkeletonBinding;
use super::names::normalized_name;
use super::relative_position::RelativePosition;
use super::rest::{RestPose, alignments, bound_above, height_ratio, parent_of, source_of};
use super::rotation::BoneRotation;
use super::translation::{carried, scaled};
use crate::data::{BoneIndex, Skeleton, Take, Track};
use crate::sample::rest_pose;
use glam::{DMat3, DQuat, Vec3};

/// Options of retargeting.
#[derive(Clone, Debug, PartialEq)]
pub struct RetargetOptions {
    /// The direction that points up in to-root space, for the heights of the hips.
    pub up: Vec3,
    /// Bones of the target whose translations are transferred. `None`: the bone called hips, hip or pelvis and its
    /// ancestors; without such a name, from each root down to the first bone below which more than one branch is bound;
    /// and in both cases every bone that is bound while none above it is.
    pub trunk: Option<Vec<BoneIndex>>,
    /// Target's size over source's, for translations of the trunk; must be positive and finite, or it counts as `None`:
    /// [`height_ratio`] of the last bone of the trunk. [`super::leg_ratio`] is another choice.
    pub ratio: Option<f32>,
    /// Whether to transfer translations of all other bones too (scaled by the ratio of the bones' own lengths), and
    /// scales. For takes that stretch bones; scales are correct only where both skeletons' bones have the same axes.
    pub stretch: bool,
}

impl Default for RetargetOptions {
    /// Returns options with +Y up, trunk and ratio detected, and constant bone lengths.
    fn default() -> Self {
        Self { up: Vec3::Y, trunk: None, ratio: None, stretch: false }
    }
}

/// Returns `take` of the skeleton `source`, for the skeleton `target`.
///
/// The formula is that of [`super`]. The result has a track for each bone of the target; name, start, length and key
/// times are those of the take. Bones that are not bound have empty tracks, and so keep their rest pose relative to
/// their parents; bones of the source that are not bound move their nearest bound descendants. Morph weights belong to
/// the source's meshes and are not transferred. Indices of the binding that are out of range count as not bound.
///
/// On the same skeleton (and with [`RetargetOptions::stretch`] if bones change their lengths) the result is the take.
pub fn retarget(
    take: &Take,
    source: &Skeleton,
    target: &Skeleton,
    binding: &SkeletonBinding,
    options: &RetargetOptions,
) -> Take {
    let (source_rest, target_rest) = (RestPose::of(source), RestPose::of(target));
    let aligned = alignments(binding, (source, &source_rest), (target, &target_rest));
    let trunk = options.trunk.clone().unwrap_or_else(|| trunk(binding, source, target));
    let hips = trunk.iter().copied().max().unwrap_or(0);
    let given = options.ratio.filter(|ratio| ratio.is_finite() && *ratio > 0.0);
    let ratio = given.unwrap_or_else(|| height_ratio(source, target, binding, hips, options.up));
    let pair = SkeletonPair { take, source, target, binding, source_rest, target_rest, aligned };
    let track = |bone: usize| {
        let mut track = Track { bone: bone as BoneIndex, ..Track::default() };
        if let Some(from) = source_of(binding, source, bone) {
            track.rotation = pair.turn(bone, from).channel(take, source, pair.target_rest.own[bone]);
            let is_topmost = || bound_above(binding, source, target, bone).is_none();
            let is_trunk = trunk.contains(&(bone as BoneIndex)) || (options.trunk.is_none() && is_topmost());
            if is_trunk || options.stretch {
                let size = if is_trunk { ratio } else { pair.length_ratio(bone, from).unwrap_or(ratio) };
                pair.set_translation(bone, from, size, &mut track);
            }
            if options.stretch {
                pair.stretch(bone, from, &mut track);
            }
        }
        track
    };
    Take {
        name: take.name.clone(),
        start: take.start,
        length: take.length,
        tracks: (0..target.len()).map(track).collect(),
        ..Take::default()
    }
}

/// Source and target, and the differences of their rest poses.
struct SkeletonPair<'a> {
    take: &'a Take,
    source: &'a Skeleton,
    target: &'a Skeleton,
    binding: &'a SkeletonBinding,
    source_rest: RestPose,
    target_rest: RestPose,
    aligned: Vec<DQuat>,
}

impl SkeletonPair<'_> {
    /// Returns the factors of the formula for `bone`, which `from` moves.
    fn turn(&self, bone: usize, from: usize) -> BoneRotation {
        let above = bound_above(self.binding, self.source, self.target, bone);
        let from_above = above.and_then(|above| source_of(self.binding, self.source, above));
        // K: the rest rotations between, top first.
        let (mut between, mut at) = (DQuat::IDENTITY, parent_of(self.target, bone));
        while at != above {
            let Some(unbound) = at else { break };
            between = self.target_rest.own[unbound] * between;
            at = parent_of(self.target, unbound);
        }
        let base = match (above, from_above) {
            (Some(above), Some(from_above)) => {
                let aligned = self.aligned[above] * self.target_rest.turned[above];
                aligned.conjugate() * self.source_rest.turned[from_above]
            }
            _ => DQuat::IDENTITY,
        };
        let right = self.source_rest.turned[from].conjugate() * self.aligned[bone];
        BoneRotation {
            above: from_above,
            bone: from,
            left: between.conjugate() * base,
            right: right * self.target_rest.turned[bone],
        }
    }

    /// Fills in the track's translation.
    fn set_translation(&self, bone: usize, from: usize, size: f32, track: &mut Track) {
        let linear = |rest: &RestPose, bone: Option<usize>| {
            bone.map_or(DMat3::IDENTITY, |bone| DMat3::from_mat4(rest.to_root[bone].as_dmat4()))
        };
        let parent = parent_of(self.target, bone);
        let inner = linear(&self.target_rest, parent).inverse();
        let aligned = parent.map_or(DQuat::IDENTITY, |parent| self.aligned[parent]).conjugate();
        let map = |outer: DMat3| inner * DMat3::from_quat(aligned) * outer * f64::from(size);
        let new = rest_pose(&self.target.bones[bone]).translation;
        let above = bound_above(self.binding, self.source, self.target, bone);
        let above = above.and_then(|above| source_of(self.binding, self.source, above));
        if let Some(position) = RelativePosition::of(self.take, self.source, from, above) {
            track.translation = position.carried(new, map(linear(&self.source_rest, above)));
        } else if let Some(source_track) = self.take.tracks.get(from) {
            let own = rest_pose(&self.source.bones[from]).translation;
            let outer = linear(&self.source_rest, parent_of(self.source, from));
            track.translation = carried(&source_track.translation, own, new, map(outer));
        }
    }

    /// Fills in the track's scale.
    fn stretch(&self, bone: usize, from: usize, track: &mut Track) {
        let Some(source_track) = self.take.tracks.get(from) else { return };
        let [own, new] =
            [&self.source.bones[from], &self.target.bones[bone]].map(|bone| rest_pose(bone).scale);
        track.scale = scaled(&source_track.scale, own, new);
    }

    /// Returns the length of the target's bone over that of the source's, to-root space; `None` where one has none.
    fn length_ratio(&self, bone: usize, from: usize) -> Option<f32> {
        let length = |skeleton: &Skeleton, rest: &RestPose, bone: usize| {
            let parent = parent_of(skeleton, bone)?;
            Some(rest.origin(bone).distance(rest.origin(parent)))
        };
        let ratio =
            length(self.target, &self.target_rest, bone)? / length(self.source, &self.source_rest, from)?;
        (ratio.is_finite() && ratio > 1e-6).then_some(ratio as f32)
    }
}

/// Returns the bones of the target whose translations move the figure.
fn trunk(binding: &SkeletonBinding, source: &Skeleton, target: &Skeleton) -> Vec<BoneIndex> {
    let is_bound = |bone: usize| source_of(binding, source, bone).is_some();
    let is_hips = |bone: &usize| {
        let name = normalized_name(&target.bones[*bone].name);
        is_bound(*bone) && ["hips", "hip", "pelvis"].contains(&&*name)
    };
    if let Some(hips) = (0..target.len()).find(is_hips) {
        let above = std::iter::successors(Some(hips), |&bone| parent_of(target, bone));
        return above.map(|bone| bone as BoneIndex).collect();
    }
    // In reverse, so that the descendants of a bone are known before its parent is processed.
    let mut holds: Vec<bool> = (0..target.len()).map(is_bound).collect();
    let mut branches = vec![0_u32; target.len()];
    for bone in (0..target.len()).rev().filter(|&bone| target.bones[bone].parent.is_some()) {
        if let Some(parent) = parent_of(target, bone).filter(|_| holds[bone]) {
            holds[parent] = true;
            branches[parent] += 1;
        }
    }
    let mut in_trunk = vec![false; target.len()];
    for bone in 0..target.len() {
        let parent = parent_of(target, bone);
        in_trunk[bone] = holds[bone] && parent.is_none_or(|parent| in_trunk[parent] && branches[parent] == 1);
    }
    (0..target.len()).filter(|&bone| in_trunk[bone]).map(|bone| bone as BoneIndex).collect()
}
