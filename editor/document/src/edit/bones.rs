//! The bones that an edit changes.

use super::target::BoneFinder;
use super::{BoneRef, KeySet};
use dragonfly_anim::data::{BoneIndex, Skeleton};
use std::collections::BTreeSet;

/// The bones that an edit changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EditedBones {
    /// The edit changes a take as a whole and all bones alike, for example its name or its length. Locks of single bones do not
    /// apply: a locked bone would fall out of step with the others.
    WholeTake,
    /// Every bone that has something to change there.
    All,
    /// These bones. Bones that the skeleton does not have are left out.
    Named(BTreeSet<BoneIndex>),
}

impl EditedBones {
    /// Returns the named bones.
    pub(crate) fn named<'a>(bones: impl IntoIterator<Item = &'a BoneRef>, skeleton: &Skeleton) -> Self {
        let mut finder = BoneFinder::new(skeleton);
        Self::Named(bones.into_iter().filter_map(|bone| finder.find(bone)).collect())
    }

    /// Returns the bones of a list in which none means all.
    pub(crate) fn listed(bones: &[BoneRef], skeleton: &Skeleton) -> Self {
        if bones.is_empty() { Self::All } else { Self::named(bones, skeleton) }
    }

    /// Returns the bones of sets of keys.
    pub(crate) fn of_keys(keys: &[KeySet], skeleton: &Skeleton) -> Self {
        if keys.iter().any(|set| set.bones.is_empty()) {
            return Self::All;
        }
        Self::named(keys.iter().flat_map(|set| &set.bones), skeleton)
    }
}
