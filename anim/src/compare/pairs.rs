//! Pairs of corresponding bones in two skeletons.

use crate::data::{BoneIndex, Skeleton};
use std::collections::HashMap;

/// The bones of two skeletons, paired by name.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BonePairs {
    /// Pairs of indices, in the order of the first skeleton.
    pub both: Vec<(BoneIndex, BoneIndex)>,
    /// Bones of the first skeleton without a counterpart.
    pub only_first: Vec<BoneIndex>,
    /// Bones of the second skeleton without a counterpart.
    pub only_second: Vec<BoneIndex>,
}

/// Pairs the bones of two skeletons by name. The n-th bone of a name is paired with the n-th bone of that name, so
/// skeletons with unnamed or repeated bones pair as far as they agree.
pub fn pair_bones(first: &Skeleton, second: &Skeleton) -> BonePairs {
    let mut named: HashMap<&str, Vec<BoneIndex>> = HashMap::new();
    for (index, bone) in second.bones.iter().enumerate().rev() {
        named.entry(&bone.name).or_default().push(index as BoneIndex);
    }
    let mut pairs = BonePairs::default();
    let mut is_paired = vec![false; second.len()];
    for (index, bone) in first.bones.iter().enumerate() {
        match named.get_mut(bone.name.as_str()).and_then(Vec::pop) {
            Some(other) => {
                is_paired[other as usize] = true;
                pairs.both.push((index as BoneIndex, other));
            }
            None => pairs.only_first.push(index as BoneIndex),
        }
    }
    let alone = is_paired.iter().enumerate().filter(|(_, is_paired)| !**is_paired);
    pairs.only_second.extend(alone.map(|(index, _)| index as BoneIndex));
    pairs
}
