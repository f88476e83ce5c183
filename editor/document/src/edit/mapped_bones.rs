//! Pairs the bones of two versions of a skeleton.

use super::Misfit;
use dragonfly_anim::data::{BoneIndex, Skeleton};
use std::collections::HashMap;

/// The counterpart of each bone of an old version of a skeleton in a new one.
///
/// Bones are paired by name. Where several bones of either version share a name, those below the same parents are the same. Where
/// even these are several, and their number is the same in both versions, the n-th one is the n-th one.
#[derive(Debug)]
pub(crate) struct MappedBones(Vec<MappedBone>);

#[derive(Clone, Copy, Debug)]
enum MappedBone {
    /// The index of the counterpart.
    Is(BoneIndex),
    /// No bone has the name.
    Gone,
    /// Several bones have the name, and none is below the same parents.
    Unclear,
}

impl MappedBones {
    /// Pairs the bones of two versions.
    pub(crate) fn between(old: &Skeleton, new: &Skeleton) -> Self {
        let (of_old, of_new) = (by_name(old), by_name(new));
        let mut paths = Paths::default();
        let (old_paths, new_paths) = (paths.of(old), paths.of(new));
        let (by_old_path, by_new_path) = (by_path(&old_paths), by_path(&new_paths));
        let pair = |(index, bone): (usize, &dragonfly_anim::data::Bone)| {
            let name = bone.name.as_str();
            let same = match of_new.get(name) {
                None => return MappedBone::Gone,
                Some(same) => same,
            };
            if let ([one], Some([_])) = (&same[..], of_old.get(name).map(Vec::as_slice)) {
                return MappedBone::Is(*one);
            }
            let path = old_paths.get(index);
            let [old, new] = [&by_old_path, &by_new_path].map(|bones| path.and_then(|path| bones.get(path)));
            match (old, new) {
                (Some(old), Some(new)) if old.len() == new.len() => {
                    let nth = old.iter().position(|other| *other as usize == index);
                    nth.and_then(|nth| new.get(nth)).map_or(MappedBone::Unclear, |new| MappedBone::Is(*new))
                }
                _ => MappedBone::Unclear,
            }
        };
        Self(old.bones.iter().enumerate().map(pair).collect())
    }

    /// Returns the index of a bone in the new version.
    pub(crate) fn of(&self, old: BoneIndex) -> Option<BoneIndex> {
        match self.0.get(old as usize)? {
            MappedBone::Is(new) => Some(*new),
            MappedBone::Gone | MappedBone::Unclear => None,
        }
    }

    /// Returns the reason why a bone has no counterpart; `old` is the skeleton of the old version.
    pub(super) fn reason(&self, bone: BoneIndex, old: &Skeleton) -> Misfit {
        let name = bone_name(old, bone);
        match self.0.get(bone as usize) {
            Some(MappedBone::Unclear) => Misfit::ManyBones(name),
            Some(MappedBone::Is(_) | MappedBone::Gone) | None => Misfit::NoBone(name),
        }
    }
}

/// Returns the name of a bone, or `Bone 3` for one without a name.
pub(super) fn bone_name(skeleton: &Skeleton, bone: BoneIndex) -> String {
    let name = skeleton.bones.get(bone as usize).map_or("", |bone| bone.name.as_str());
    if name.is_empty() { format!("Bone {bone}") } else { name.to_owned() }
}

fn by_name(skeleton: &Skeleton) -> HashMap<&str, Vec<BoneIndex>> {
    let mut bones: HashMap<&str, Vec<BoneIndex>> = HashMap::new();
    for (index, bone) in skeleton.bones.iter().enumerate() {
        bones.entry(&bone.name).or_default().push(index as BoneIndex);
    }
    bones
}

fn by_path(paths: &[usize]) -> HashMap<usize, Vec<BoneIndex>> {
    let mut bones: HashMap<usize, Vec<BoneIndex>> = HashMap::new();
    for (index, path) in paths.iter().enumerate() {
        bones.entry(*path).or_default().push(index as BoneIndex);
    }
    bones
}

/// Numbers of paths: the names of a bone and of all bones above it.
#[derive(Default)]
struct Paths<'a>(HashMap<(Option<usize>, &'a str), usize>);

impl<'a> Paths<'a> {
    /// Returns the number of the path of each bone; parents come before their children.
    fn of(&mut self, skeleton: &'a Skeleton) -> Vec<usize> {
        let mut paths: Vec<usize> = Vec::with_capacity(skeleton.len());
        for bone in &skeleton.bones {
            let above = bone.parent.and_then(|parent| paths.get(parent as usize)).copied();
            let next = self.0.len();
            paths.push(*self.0.entry((above, bone.name.as_str())).or_insert(next));
        }
        paths
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::about::tests::bone;

    /// Makes a skeleton of names, each with the index of its parent.
    fn skeleton(bones: &[(&str, Option<u32>)]) -> Skeleton {
        let bones =
            bones.iter().map(|(name, parent)| dragonfly_anim::data::Bone { parent: *parent, ..bone(name) });
        Skeleton { bones: bones.collect() }
    }

    #[test]
    fn bones_are_paired_by_name_and_those_that_share_one_by_their_parents() {
        let old = skeleton(&[
            ("Root", None),
            ("Left", Some(0)),
            ("Hand", Some(1)),
            ("Right", Some(0)),
            ("Hand", Some(3)),
            ("", Some(0)),
            ("", Some(0)),
            ("Tail", Some(0)),
        ]);
        let new = skeleton(&[
            ("Root", None),
            ("Right", Some(0)),
            ("", Some(0)),
            ("Hand", Some(1)),
            ("", Some(0)),
            ("Left", Some(0)),
            ("Hand", Some(5)),
            ("Other", None),
            ("Hand", Some(7)),
        ]);
        let bones = MappedBones::between(&old, &new);
        let pairs: Vec<_> = (0..8).map(|bone| bones.of(bone)).collect();
        let expected = [Some(0), Some(5), Some(6), Some(1), Some(3), Some(2), Some(4), None];
        assert_eq!(pairs, expected);
        assert_eq!(bones.reason(7, &old), Misfit::NoBone("Tail".to_owned()));
    }

    #[test]
    fn a_shared_name_without_the_same_parents_is_not_guessed() {
        let old = skeleton(&[("Left", None), ("Hand", Some(0)), ("Right", None), ("Hand", Some(2))]);
        let new = skeleton(&[("Arm", None), ("Hand", Some(0)), ("Right", None), ("Hand", Some(2))]);
        let bones = MappedBones::between(&old, &new);
        assert_eq!([bones.of(1), bones.of(3)], [None, Some(3)]);
        assert_eq!(bones.reason(1, &old), Misfit::ManyBones("Hand".to_owned()));
    }

    #[test]
    fn a_bone_whose_name_is_its_own_may_move_below_another_parent() {
        let old = skeleton(&[("Hips", None), ("Prop", Some(0))]);
        let new = skeleton(&[("Armature", None), ("Prop", Some(0)), ("Hips", Some(0))]);
        let bones = MappedBones::between(&old, &new);
        assert_eq!([bones.of(0), bones.of(1), bones.of(9)], [Some(2), Some(1), None]);
    }
}
