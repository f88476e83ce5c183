//! The skeleton in the pose of another take, over that of the take shown, with a line between each two joints that differ.

use super::component::{ControlFrame, GraphicComponent};
use crate::appearance::Appearance;
use crate::gizmo::{GizmoRole, GizmoShape};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{Take, Transform};
use dragonfly_anim::sample::sample_take;
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// The take with which the one shown is compared; `None` for no comparison.
#[derive(Clone, Debug, Default)]
pub struct ComparedAppearance {
    /// The take, on the skeleton of the model.
    pub take: Option<Arc<Take>>,
}

/// Takes are immutable, so the same one is equal to itself; two with equal keys count as different.
impl PartialEq for ComparedAppearance {
    fn eq(&self, other: &Self) -> bool {
        match (&self.take, &other.take) {
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            (None, None) => true,
            (Some(_), None) | (None, Some(_)) => false,
        }
    }
}

impl Appearance for ComparedAppearance {}

/// Largest distance between two joints that counts as equal, as a part of the size of the skeleton.
const EQUAL: f32 = 1e-5;

/// Draws the other pose.
#[derive(Default)]
pub(super) struct ComparedGraphic {
    poses: Vec<Transform>,
    to_root: Vec<Mat4>,
}

impl GraphicComponent for ComparedGraphic {
    fn present(&mut self, frame: &ControlFrame<'_>, shape: &mut GizmoShape) {
        let compared = frame.appearances.get::<ComparedAppearance>();
        let Some(take) = compared.and_then(|compared| compared.take.as_ref()) else { return };
        let skeleton = &frame.model.loaded().model.animation.skeleton;
        self.poses.resize(skeleton.len(), Transform::IDENTITY);
        self.to_root.resize(skeleton.len(), Mat4::IDENTITY);
        sample_take(Some(take), skeleton, frame.model.at().1, &mut self.poses);
        to_root(skeleton, &self.poses, &mut self.to_root);
        let shown = |bone: usize| frame.model.to_root().get(bone).map(place);
        let joint = |bone: usize| self.to_root.get(bone).map(place);
        let apart = |bone: usize| Some(shown(bone)?.distance(joint(bone)?)).filter(|apart| apart.is_finite());
        let bones = 0..skeleton.len();
        let most = bones.clone().filter_map(apart).fold(0.0, f32::max);
        let size = bones.filter_map(shown).filter(|at| at.is_finite()).map(Vec3::length).fold(0.0, f32::max);
        if most <= EQUAL * size {
            return;
        }
        for (index, bone) in skeleton.bones.iter().enumerate() {
            if frame.look.hidden.is_hidden(index as u32) || !frame.model.shape().is_joint(index as u32) {
                continue;
            }
            let (Some(at), Some(other), Some(distance)) = (shown(index), joint(index), apart(index)) else {
                continue;
            };
            let part = distance / most;
            if distance > EQUAL * size {
                shape.add_line(at, other, GizmoRole::View, 0.9 * part);
            }
            let parent = bone.parent.filter(|parent| (*parent as usize) < index);
            let from = parent.and_then(|parent| joint(parent as usize)).filter(|from| from.is_finite());
            if let Some(from) = from.filter(|_| other.is_finite()) {
                shape.add_line(from, other, GizmoRole::Future, 0.25 + 0.7 * part);
            }
        }
    }
}

fn place(matrix: &Mat4) -> Vec3 {
    matrix.w_axis.truncate()
}
