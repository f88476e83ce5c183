//! A root bone above a figure whose topmost bone is its hips, so that a bone can carry its travel.
//!
//! The new bone is the first one and rests at the origin, and the former root bones become its children. So every other
//! bone moves up by one in all lists of bones, and stays where it is in the scene: the matrix of the new bone is the
//! identity, and a product with it changes no number (at most the sign of a zero).
//!
//! [`BoneShift`] is that renumbering, in both directions: between two skeletons that are the same below their topmost
//! bones.
//!
//! ```
//! use dragonfly_anim::data::{Bone, ModelData, Skeleton};
//! use dragonfly_anim::root_bone::with_root_bone;
//! use std::sync::Arc;
//!
//! let mut model = ModelData::default();
//! model.animation.skeleton = Arc::new(Skeleton { bones: vec![Bone::root("Hips")] });
//!
//! let model = with_root_bone(&model, "Root")?;
//! let bones = &model.animation.skeleton.bones;
//! assert_eq!((bones[0].name.as_str(), bones[1].parent), ("Root", Some(0)));
//! # Ok::<(), dragonfly_anim::root_bone::RootBoneError>(())
//! ```

use crate::data::{
    AnimationData, Avatar, Bone, BoneIndex, MeshInstance, ModelData, Skeleton, Skin, Take, Track,
};
use crate::limits::{NODE_DEPTH, NODES};
use std::sync::Arc;
use thiserror::Error;

/// Reason why a skeleton gets no root bone.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RootBoneError {
    /// There is nothing that the bone could carry.
    #[error("the model has no bones that a root bone could carry")]
    NoBones,
    /// The name is empty or blank.
    #[error("the root bone needs a name")]
    NoName,
    /// Another bone has the name.
    #[error("another bone has the name {0:?}")]
    NameTaken(String),
    /// No more bones are allowed.
    #[error("the model has {0} bones already, and no more are allowed")]
    TooMany(usize),
    /// The skeleton is as deep as is allowed.
    #[error("the skeleton has {0} levels of bones already, and no more are allowed")]
    TooDeep(usize),
}

/// Returns the skeleton with a bone called `name` above all its root bones.
///
/// # Errors
///
/// See [`RootBoneError`].
pub fn skeleton_with_root(skeleton: &Skeleton, name: &str) -> Result<Skeleton, RootBoneError> {
    if skeleton.is_empty() {
        return Err(RootBoneError::NoBones);
    }
    if name.trim().is_empty() {
        return Err(RootBoneError::NoName);
    }
    if skeleton.find(name).is_some() {
        return Err(RootBoneError::NameTaken(name.to_owned()));
    }
    if skeleton.len() >= NODES {
        return Err(RootBoneError::TooMany(skeleton.len()));
    }
    let levels = levels(skeleton);
    if levels >= NODE_DEPTH {
        return Err(RootBoneError::TooDeep(levels));
    }
    let root = Bone::root(name);
    let below =
        |bone: &Bone| Bone { parent: Some(bone.parent.map_or(0, |parent| parent + 1)), ..bone.clone() };
    let bones = std::iter::once(root).chain(skeleton.bones.iter().map(below)).collect();
    Ok(Skeleton { bones })
}

/// Returns the model with a bone called `name` above all its root bones. Meshes, skins and takes follow their bones, and
/// look the same at every time.
///
/// # Errors
///
/// See [`RootBoneError`].
pub fn with_root_bone(model: &ModelData, name: &str) -> Result<ModelData, RootBoneError> {
    let skeleton = Arc::new(skeleton_with_root(&model.animation.skeleton, name)?);
    Ok(BoneShift::ROOT_ADDED.model(model, &skeleton).expect("no bone is removed"))
}

/// Returns the number of levels of a skeleton: 1 if all its bones are roots.
fn levels(skeleton: &Skeleton) -> usize {
    let mut levels: Vec<usize> = Vec::with_capacity(skeleton.len());
    for bone in &skeleton.bones {
        let above = bone.parent.and_then(|parent| levels.get(parent as usize).copied()).unwrap_or_default();
        levels.push(above + 1);
    }
    levels.into_iter().max().unwrap_or_default()
}

/// The renumbering of bones between two skeletons that are the same below their topmost bones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BoneShift {
    /// Number of topmost bones that only the first skeleton has.
    removed: u32,
    /// Number of topmost bones that only the second skeleton has.
    added: u32,
}

impl BoneShift {
    /// One root bone is added.
    pub const ROOT_ADDED: Self = Self { removed: 0, added: 1 };

    /// Returns the renumbering from one skeleton to another; `None` where they differ in more than root bones that have
    /// all others below them.
    pub fn between(from: &Skeleton, to: &Skeleton) -> Option<Self> {
        let same = |(a, b): &(&Bone, &Bone)| a.name == b.name;
        let common = from.bones.iter().rev().zip(to.bones.iter().rev()).take_while(same).count();
        let shift = Self { removed: (from.len() - common) as u32, added: (to.len() - common) as u32 };
        let has_chain = |skeleton: &Skeleton, count: u32| {
            let chain = skeleton.bones.iter().take(count as usize).enumerate();
            chain
                .into_iter()
                .all(|(index, bone)| bone.parent == index.checked_sub(1).map(|above| above as BoneIndex))
        };
        let below = |bone: &Bone, count: u32| match (bone.parent, count.checked_sub(1)) {
            (Some(parent), _) if parent >= count => Some(Some(parent - count)),
            (parent, lowest) => (parent == lowest).then_some(None),
        };
        let pairs = from.bones[shift.removed as usize..].iter().zip(&to.bones[shift.added as usize..]);
        let fits = has_chain(from, shift.removed)
            && has_chain(to, shift.added)
            && pairs.into_iter().all(|(a, b)| {
                let (a, b) = (below(a, shift.removed), below(b, shift.added));
                a.is_some() && a == b
            });
        fits.then_some(shift)
    }

    /// Returns whether every bone keeps its index.
    pub fn is_identity(self) -> bool {
        self.removed == 0 && self.added == 0
    }

    /// Returns the number of topmost bones that only the first skeleton has.
    pub fn removed(self) -> usize {
        self.removed as usize
    }

    /// Returns the number of topmost bones that only the second skeleton has.
    pub fn added(self) -> usize {
        self.added as usize
    }

    /// Returns the index of a bone in the second skeleton; `None` for a bone that it does not have.
    pub fn bone(self, bone: BoneIndex) -> Option<BoneIndex> {
        bone.checked_sub(self.removed)?.checked_add(self.added)
    }

    /// Returns the indices of the bones that both skeletons have, in the same order.
    pub fn bones(self, bones: &[BoneIndex]) -> Vec<BoneIndex> {
        bones.iter().filter_map(|&bone| self.bone(bone)).collect()
    }

    /// Returns the take for the second skeleton. Bones that only that one has get no keys; keys are shared.
    pub fn take(self, take: &Take) -> Take {
        let new = (0..self.added).map(|bone| Track { bone, ..Track::default() });
        let kept = take.tracks.iter().skip(self.removed());
        let kept = kept.filter_map(|track| Some(Track { bone: self.bone(track.bone)?, ..track.clone() }));
        let tracks = new.chain(kept).collect();
        let mut shifted = Take { tracks, ..take.clone() };
        if take.tracks.iter().take(self.removed()).any(|track| !track.is_empty()) {
            let (start, end) = shifted.range_of_keys().unwrap_or_default();
            (shifted.start, shifted.length) = (start, end - start);
        }
        shifted
    }

    /// Returns the skin for the second skeleton; `None` where a bone is a joint that only the first one has.
    pub fn skin(self, skin: &Skin) -> Option<Skin> {
        let bones = skin.bones.iter().map(|&bone| self.bone(bone)).collect::<Option<_>>()?;
        Some(Skin { bones, ..skin.clone() })
    }

    /// Returns the mesh instance for the second skeleton; `None` where a bone carries it that only the first one has.
    pub fn instance(self, instance: &MeshInstance) -> Option<MeshInstance> {
        let bone = match instance.bone {
            Some(bone) => Some(self.bone(bone)?),
            None => None,
        };
        Some(MeshInstance { bone, ..instance.clone() })
    }

    /// Returns the parts of the body for the second skeleton, without bones that only the first one has.
    fn avatar(self, avatar: &Avatar) -> Avatar {
        let mut avatar = avatar.clone();
        avatar.bones.retain_mut(|human| match self.bone(human.bone) {
            Some(bone) => {
                human.bone = bone;
                true
            }
            None => false,
        });
        for expression in &mut avatar.expressions {
            expression.weight_bone = expression.weight_bone.and_then(|bone| self.bone(bone));
        }
        avatar
    }

    /// Returns the model with the second skeleton, `to`; `None` where a mesh needs a bone that only the first one has.
    pub fn model(self, model: &ModelData, to: &Arc<Skeleton>) -> Option<ModelData> {
        let takes = model.animation.takes.iter().map(|take| Arc::new(self.take(take))).collect();
        Some(ModelData {
            name: model.name.clone(),
            meshes: model.meshes.clone(),
            instances: model
                .instances
                .iter()
                .map(|instance| self.instance(instance))
                .collect::<Option<_>>()?,
            skins: model.skins.iter().map(|skin| self.skin(skin)).collect::<Option<_>>()?,
            materials: model.materials.clone(),
            images: model.images.clone(),
            animation: AnimationData { skeleton: Arc::clone(to), takes },
            avatar: self.avatar(&model.avatar),
        })
    }
}
