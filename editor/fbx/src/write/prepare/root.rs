//! One root bone at the origin.

use dragonfly_anim::data::{Bone, ModelData, Skeleton};
use dragonfly_anim::root_bone::BoneShift;
use std::sync::Arc;

/// Distance in meters from the origin at which a root is at the origin.
const AT_ORIGIN: f32 = 1e-4;

/// Returns the model with a bone `root` above all others; `None` if it has one root, which is at the origin, or no bone.
pub(super) fn below_root(model: &ModelData) -> Option<ModelData> {
    let bones = &model.animation.skeleton.bones;
    let mut roots = bones.iter().filter(|bone| bone.parent.is_none());
    let first = roots.next()?;
    if roots.next().is_none() && first.rest.translation.length() <= AT_ORIGIN {
        return None;
    }
    let moved = bones.iter().map(|bone| {
        let parent = Some(bone.parent.map_or(0, |parent| parent + 1));
        Bone { parent, ..bone.clone() }
    });
    let bones = std::iter::once(Bone::root("root")).chain(moved).collect();
    BoneShift::ROOT_ADDED.model(model, &Arc::new(Skeleton { bones }))
}
