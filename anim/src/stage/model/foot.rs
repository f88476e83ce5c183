//! Feet of a model.

use crate::data::{BoneIndex, Skeleton};
use crate::fast::FastTwoBone;

/// A foot: the limb whose end it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageFoot {
    /// The bone.
    pub bone: BoneIndex,
    pub(in crate::stage) limb: FastTwoBone,
}

/// Returns the nearest bone that is above all `feet`; `None` without feet or without such a bone.
pub(super) fn hips_above(skeleton: &Skeleton, feet: &[StageFoot]) -> Option<BoneIndex> {
    let parent = |&bone: &BoneIndex| skeleton.bones.get(bone as usize).and_then(|bone| bone.parent);
    let above = |bone: BoneIndex| std::iter::successors(parent(&bone), parent);
    let first = feet.first()?.limb.root;
    above(first).find(|&hips| feet.iter().all(|foot| above(foot.limb.root).any(|bone| bone == hips)))
}
