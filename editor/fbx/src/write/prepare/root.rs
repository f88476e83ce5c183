//! One root bone at the origin.

use dragonfly_anim::data::{AnimationData, Bone, ModelData, Skeleton, Take, Track, Transform};
use glam::Mat4;
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
    let (rest, offset) = (Transform::IDENTITY, Mat4::IDENTITY);
    let root = Bone { name: "root".to_owned(), parent: None, rest, rest_matrix: None, offset, node: None };
    let moved = bones.iter().map(|bone| {
        let parent = Some(bone.parent.map_or(0, |parent| parent + 1));
        Bone { parent, ..bone.clone() }
    });
    let skeleton = Skeleton { bones: [root].into_iter().chain(moved).collect() };
    let takes = model.animation.takes.iter().map(|take| {
        let tracks = take.tracks.iter().map(|track| Track { bone: track.bone + 1, ..track.clone() });
        let tracks = [Track::default()].into_iter().chain(tracks).collect();
        Arc::new(Take { tracks, ..Take::clone(take) })
    });
    let mut below = model.clone();
    below.animation = AnimationData { skeleton: Arc::new(skeleton), takes: takes.collect() };
    for skin in &mut below.skins {
        skin.bones.iter_mut().for_each(|bone| *bone += 1);
    }
    for instance in &mut below.instances {
        instance.bone = instance.bone.map(|bone| bone + 1);
    }
    Some(below)
}
