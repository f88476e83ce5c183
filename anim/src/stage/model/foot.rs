//! Feet of a model.

use crate::data::BoneIndex;
use crate::fast::FastTwoBone;

/// A foot: the limb whose end it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageFoot {
    /// The bone.
    pub bone: BoneIndex,
    pub(in crate::stage) limb: FastTwoBone,
}
