//! Picking a bone by the skin that it moves.

use super::posed::PosedModel;
use crate::camera::CameraRay;
use crate::pick::surface::{SkinHit, pick_skin};
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::hit::{HitPose, HitTree};
use dragonfly_document::bones::HiddenBones;
use std::sync::Arc;

/// Picker with a tree over the triangles, created at the first click that needs it and kept, because building it is
/// most of the cost.
pub(super) struct SkinPicker {
    /// `None` if there are too many triangles for a tree.
    tree: Option<(Evaluator, HitPose)>,
    hits: Vec<SkinHit>,
}

impl SkinPicker {
    pub(super) fn new(model: &PosedModel) -> Self {
        let data = &model.loaded().model;
        let tree = HitTree::of(data)
            .ok()
            .map(|tree| (Evaluator::new(Arc::clone(data)), HitPose::new(Arc::new(tree))));
        Self { tree, hits: Vec::new() }
    }

    /// Writes the bones with the most influence on the skin under a ray, nearest first, in the pose of `model`.
    pub(super) fn pick(
        &mut self,
        model: &PosedModel,
        ray: &CameraRay,
        hidden: &HiddenBones,
        out: &mut Vec<BoneIndex>,
    ) {
        let Some((evaluator, pose)) = &mut self.tree else { return };
        let (take, time) = model.at();
        if evaluator.animation_mut().data().takes.len() == model.takes().len() {
            for (index, take) in model.takes().iter().enumerate() {
                evaluator.animation_mut().replace_take(index, Arc::clone(take));
            }
        }
        // In the pose that is drawn: with pending poses, and with the bones that are held at rest.
        evaluator.pose_with(take, time, |poses| {
            for (pose, shown) in poses.iter_mut().zip(model.poses()) {
                *pose = *shown;
            }
        });
        pose.refit(evaluator);
        pick_skin(pose, evaluator, ray, hidden, &mut self.hits);
        out.extend(self.hits.iter().map(|hit| hit.bone));
    }
}
