//! From selected bones to those that a drag changes.

use super::frame::GizmoTarget;
use dragonfly_anim::data::{BoneIndex, Skeleton, Transform};
use glam::{DVec3, Mat4};

/// A skeleton in a pose.
pub(super) struct Pose<'a> {
    pub(super) skeleton: &'a Skeleton,
    pub(super) poses: &'a [Transform],
    pub(super) to_root: &'a [Mat4],
}

impl Pose<'_> {
    fn target(&self, bone: BoneIndex) -> Option<GizmoTarget> {
        GizmoTarget::of(self.skeleton, self.poses, self.to_root, bone)
    }
}

/// The selected bones in the order of the skeleton; without `each`, not those that have a selected one above them: they
/// follow it already. `chosen` is room to work in.
pub(super) fn targets(
    pose: &Pose<'_>,
    selected: &[BoneIndex],
    each: bool,
    chosen: &mut Vec<bool>,
    out: &mut Vec<GizmoTarget>,
) {
    let bones = &pose.skeleton.bones;
    chosen.clear();
    chosen.resize(bones.len(), false);
    for &bone in selected {
        if let Some(chosen) = chosen.get_mut(bone as usize) {
            *chosen = true;
        }
    }
    out.clear();
    // Parents come before children, so one pass hands "selected or below" on.
    for index in 0..bones.len() {
        let below = bones[index].parent.is_some_and(|parent| chosen.get(parent as usize) == Some(&true));
        if chosen[index] && (each || !below) {
            out.extend(pose.target(index as BoneIndex));
        }
        chosen[index] |= below && !each;
    }
}

/// The mean of the joints of the selected bones.
pub(super) fn median(pose: &Pose<'_>, selected: &[BoneIndex]) -> Option<DVec3> {
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for origin in selected.iter().filter_map(|&bone| pose.target(bone)).map(|target| target.origin()) {
        sum += origin;
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count)
}
