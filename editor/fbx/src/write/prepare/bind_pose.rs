//! A skeleton that rests in the pose in which its skins are bound.

use super::super::bones::{LocalPose, rest_matrices};
use super::super::losses::FbxLosses;
use super::super::skin::bind;
use dragonfly_anim::data::{Channel, Interpolation, ModelData, Skeleton, Take, Transform};
use glam::{DMat4, Quat, Vec3};
use std::sync::Arc;

/// Largest difference between two poses that are taken for the same: of rotations as the chord of half the angle, of lengths in
/// meters, of scales as a factor.
const SAME: f32 = 1e-5;

fn is_same(a: &Transform, b: &Transform) -> bool {
    let rotation = (a.rotation - b.rotation).length().min((a.rotation + b.rotation).length());
    let others = (a.translation - b.translation).abs().max((a.scale - b.scale).abs());
    rotation <= SAME && others.max_element() <= SAME
}

/// Returns the model with the bind pose at rest, in which each take keeps the former pose of what it does not move; `None` if the
/// skeleton rests in its bind pose, or has none.
pub(in super::super) fn at_rest(model: &ModelData, losses: &mut FbxLosses) -> Option<ModelData> {
    let skeleton = &model.animation.skeleton;
    let rest = rest_matrices(skeleton);
    let mut bound: Vec<Option<DMat4>> = vec![None; skeleton.len()];
    for skin in &model.skins {
        for (&bone, &matrix) in skin.bones.iter().zip(&bind(skin, &rest).bones) {
            if let Some(bound) = bound.get_mut(bone as usize) {
                bound.get_or_insert(matrix);
            }
        }
    }
    let mut bones = skeleton.bones.clone();
    let mut matrices: Vec<DMat4> = Vec::with_capacity(bones.len());
    let mut changed = Vec::new();
    for (index, bone) in bones.iter_mut().enumerate() {
        let parent = bone.parent.and_then(|parent| matrices.get(parent as usize).copied());
        let parent = parent.unwrap_or(DMat4::IDENTITY);
        let local = bound[index].map(|matrix| parent.inverse() * matrix).and_then(LocalPose::of_matrix);
        if let Some(local) = local {
            let pose = Transform {
                translation: local.translation.as_vec3(),
                rotation: local.rotation.as_quat(),
                scale: local.scale.as_vec3(),
            };
            if !is_same(&pose, &bone.rest) {
                bone.rest = pose;
                bone.rest_matrix = None;
                changed.push(index);
            }
        }
        matrices.push(parent * LocalPose::of(&bone.rest).matrix());
    }
    if changed.is_empty() {
        return None;
    }
    let text = "the skeleton rests in its bind pose; its former rest pose is in the takes only";
    losses.add("/animation/skeleton", text);
    let takes = model.animation.takes.iter().map(|take| Arc::new(with_rest(take, skeleton, &changed)));
    let takes = takes.collect();
    let mut resting = model.clone();
    resting.animation.takes = takes;
    resting.animation.skeleton = Arc::new(Skeleton { bones });
    Some(resting)
}

/// Returns a take with a key of the pose at rest in each channel of these bones that has none.
fn with_rest(take: &Take, skeleton: &Skeleton, changed: &[usize]) -> Take {
    let mut take = take.clone();
    let start = take.start;
    for &bone in changed {
        let (Some(track), Some(bone)) = (take.tracks.get_mut(bone), skeleton.bones.get(bone)) else {
            continue;
        };
        let hold = |channel: &mut Channel<Vec3>, value: Vec3| {
            if channel.is_empty() {
                *channel = Channel::new([start], [value], Interpolation::Linear);
            }
        };
        hold(&mut track.translation, bone.rest.translation);
        hold(&mut track.scale, bone.rest.scale);
        if track.rotation.is_empty() {
            let value: [Quat; 1] = [bone.rest.rotation];
            track.rotation = Channel::new([start], value, Interpolation::Linear);
        }
    }
    take
}
