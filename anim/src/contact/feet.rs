//! The feet of a skeleton and the limbs that move them.

use crate::data::{BoneIndex, Skeleton};
use crate::ik::TwoBone;

/// Words in the names of feet, lower case.
const FEET: [&str; 3] = ["foot", "ankle", "paw"];

/// Words in the names of bones that only help to move a foot.
const HELPERS: [&str; 6] = ["ik", "pole", "ctrl", "control", "target", "roll"];

/// Returns the bones whose names say that they are feet, in bone order: those with a knee and a hip above them. Where the feet
/// below each other share a name, as in `LeftFoot` and `LeftFootEnd`, the upper one.
pub fn feet_by_name(skeleton: &Skeleton) -> Vec<BoneIndex> {
    let is_foot = |bone: BoneIndex| {
        let name = skeleton.bones[bone as usize].name.to_lowercase();
        let helps = name.split(|letter: char| !letter.is_alphanumeric()).any(|word| HELPERS.contains(&word));
        !helps && FEET.iter().any(|word| name.contains(word)) && limb_of(skeleton, bone).is_some()
    };
    let mut feet: Vec<BoneIndex> = (0..skeleton.len() as BoneIndex).filter(|&bone| is_foot(bone)).collect();
    let all = feet.clone();
    feet.retain(|&bone| {
        let parent = skeleton.bones[bone as usize].parent;
        parent.is_none_or(|parent| !all.contains(&parent))
    });
    feet
}

/// Returns the limb whose end is `end`: its parent bends, and the parent of that turns. `None` where it has fewer than two bones
/// above it.
pub fn limb_of(skeleton: &Skeleton, end: BoneIndex) -> Option<TwoBone> {
    let middle = skeleton.bones.get(end as usize)?.parent?;
    let root = skeleton.bones.get(middle as usize)?.parent?;
    Some(TwoBone::new(root, middle, end))
}
