//! Bindings between the bones of two skeletons.

use super::names::normalized_name;
use crate::data::{BoneIndex, Skeleton, Take, Track};
use std::collections::HashMap;

/// Reasons why a given map is not a valid binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BindError {
    /// A bone of the map is not in the source's skeleton.
    #[error("the source has no bone {bone}")]
    NoSourceBone {
        /// The index in the map.
        bone: BoneIndex,
    },
    /// A bone of the map is not in the target's skeleton.
    #[error("the target has no bone {bone}")]
    NoTargetBone {
        /// The index in the map.
        bone: BoneIndex,
    },
    /// A bone of the target is bound twice.
    #[error("bone {bone} of the target is bound to two bones of the source")]
    BoundTwice {
        /// The target's bone.
        bone: BoneIndex,
    },
}

/// Pairs of bones of two skeletons, and the unbound rest.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SkeletonBinding {
    /// For each bone of the target, in bone order: the bone of the source that moves it.
    pub source_of: Vec<Option<BoneIndex>>,
    /// Bones of the source that move nothing, ascending.
    pub unbound_source: Vec<BoneIndex>,
    /// Bones of the target that nothing moves, ascending.
    pub unbound_target: Vec<BoneIndex>,
}

impl SkeletonBinding {
    /// Binds bones of the same name; then, of those left, bones whose [`normalized_name`] is the same.
    ///
    /// If several bones of a skeleton have the same name, the first is bound to the first of that name, the second to
    /// the second; a normalized name that several remaining bones have binds none. Bones without a name stay unbound.
    pub fn by_name(source: &Skeleton, target: &Skeleton) -> Self {
        let mut source_of = vec![None; target.len()];
        let mut used = vec![false; source.len()];
        let mut exact: HashMap<&str, Vec<BoneIndex>> = HashMap::new();
        for (index, bone) in source.bones.iter().enumerate().rev() {
            exact.entry(&bone.name).or_default().push(index as BoneIndex);
        }
        for (bone, bound) in target.bones.iter().zip(&mut source_of) {
            // The list was filled in reverse, so the last one is the first in bone order.
            *bound = exact.get_mut(&*bone.name).filter(|_| !bone.name.is_empty()).and_then(Vec::pop);
            if let Some(index) = *bound {
                used[index as usize] = true;
            }
        }
        let left_source = by_normalized(source, |index| !used[index]);
        let left_target = by_normalized(target, |index| source_of[index].is_none());
        for (name, bones) in left_target {
            if let ([bone], Some([other])) = (&*bones, left_source.get(&name).map(|bones| &**bones)) {
                source_of[*bone as usize] = Some(*other);
            }
        }
        Self::with(source.len(), source_of)
    }

    /// Binds the given pairs: bone of the source, bone of the target. A bone of the source may move several.
    pub fn from_map(
        source: &Skeleton,
        target: &Skeleton,
        pairs: &[(BoneIndex, BoneIndex)],
    ) -> Result<Self, BindError> {
        let mut source_of = vec![None; target.len()];
        for &(from, to) in pairs {
            if from as usize >= source.len() {
                return Err(BindError::NoSourceBone { bone: from });
            }
            let bound = source_of.get_mut(to as usize).ok_or(BindError::NoTargetBone { bone: to })?;
            if bound.replace(from).is_some() {
                return Err(BindError::BoundTwice { bone: to });
            }
        }
        Ok(Self::with(source.len(), source_of))
    }

    /// Returns the number of bones of the target that are bound.
    pub fn bound(&self) -> usize {
        self.source_of.len() - self.unbound_target.len()
    }

    fn with(source: usize, source_of: Vec<Option<BoneIndex>>) -> Self {
        let mut used = vec![false; source];
        source_of.iter().flatten().for_each(|&bone| used[bone as usize] = true);
        let unset = |list: Vec<bool>| {
            let unset = list.into_iter().enumerate().filter(|(_, set)| !set);
            unset.map(|(index, _)| index as BoneIndex).collect()
        };
        let unbound_target = unset(source_of.iter().map(Option::is_some).collect());
        Self { unbound_source: unset(used), unbound_target, source_of }
    }
}

/// Returns the chosen bones that have a name, by normalized name.
fn by_normalized(skeleton: &Skeleton, choose: impl Fn(usize) -> bool) -> HashMap<String, Vec<BoneIndex>> {
    let mut names: HashMap<String, Vec<BoneIndex>> = HashMap::new();
    for (index, bone) in skeleton.bones.iter().enumerate().filter(|(index, _)| choose(*index)) {
        let name = normalized_name(&bone.name);
        if !name.is_empty() {
            names.entry(name).or_default().push(index as BoneIndex);
        }
    }
    names
}

/// Assigns the tracks of `take` unchanged to the bound bones of the target: the same skeleton, another model.
///
/// Bones that are not bound get empty tracks. Morph weights belong to the source's meshes and are not copied. Start and
/// length stay. Columns are shared, not copied.
pub fn rebind(take: &Take, binding: &SkeletonBinding) -> Take {
    let track = |(index, source): (usize, &Option<BoneIndex>)| {
        let track = source.and_then(|source| take.tracks.get(source as usize)).cloned().unwrap_or_default();
        Track { bone: index as BoneIndex, ..track }
    };
    Take {
        name: take.name.clone(),
        start: take.start,
        length: take.length,
        tracks: binding.source_of.iter().enumerate().map(track).collect(),
        ..Take::default()
    }
}
