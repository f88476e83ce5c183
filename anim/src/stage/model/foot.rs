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
    let is_above =
        |hips: BoneIndex, foot: &StageFoot| skeleton.ancestors(foot.limb.root).any(|bone| bone == hips);
    skeleton.ancestors(feet.first()?.limb.root).find(|&hips| feet.iter().all(|foot| is_above(hips, foot)))
}
