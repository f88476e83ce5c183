//! A second skeleton: in the pose of another take or time over the one shown, with a line between each two joints that differ, or
//! next to the model.

use super::component::{ControlFrame, GraphicComponent};
use crate::appearance::Appearance;
use crate::gizmo::{GizmoRole, GizmoShape};
use dragonfly_anim::animation::to_root;
use dragonfly_anim::data::{BoneIndex, Skeleton, Take, Transform};
use dragonfly_anim::sample::sample_take;
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// The second skeleton; `None` for none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ComparedAppearance {
    /// The skeleton.
    pub second: Option<SecondSkeleton>,
}

impl Appearance for ComparedAppearance {}

/// A skeleton that is drawn in the pose of a take.
#[derive(Clone, Debug)]
pub struct SecondSkeleton {
    /// The take.
    pub take: Arc<Take>,
    /// The times of its pose and of the pose that it is compared with, both of the take; `None` for the time and the pose shown.
    pub times: Option<[f32; 2]>,
    /// The skeleton that the take moves; `None` for that of the model.
    pub other: Option<OtherSkeleton>,
    /// Factor of its size.
    pub scale: f32,
    /// Its distance from its place.
    pub offset: Vec3,
}

/// A skeleton of another model.
#[derive(Clone, Debug)]
pub struct OtherSkeleton {
    /// The skeleton.
    pub skeleton: Arc<Skeleton>,
    /// For each of its bones, the bone of the model that it is compared with. Where empty, none is, and all are drawn alike.
    pub first_of: Arc<[Option<BoneIndex>]>,
    /// The bone of it that is emphasized.
    pub marked: Option<BoneIndex>,
}

impl SecondSkeleton {
    /// Returns a take of the model's own skeleton, at the time shown.
    pub fn of(take: Arc<Take>) -> Self {
        Self { take, times: None, other: None, scale: 1.0, offset: Vec3::ZERO }
    }
}

/// Takes and skeletons are immutable, so the same one is equal to itself; two with equal keys count as different.
impl PartialEq for SecondSkeleton {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.take, &other.take)
            && (self.times, self.scale, self.offset) == (other.times, other.scale, other.offset)
            && self.other == other.other
    }
}

impl PartialEq for OtherSkeleton {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.skeleton, &other.skeleton)
            && Arc::ptr_eq(&self.first_of, &other.first_of)
            && self.marked == other.marked
    }
}

/// Largest distance between two joints that counts as equal, as a part of the size of the skeleton.
const EQUAL: f32 = 1e-5;

/// A pose of a skeleton.
#[derive(Default)]
struct PosedJoints {
    poses: Vec<Transform>,
    to_root: Vec<Mat4>,
}

impl PosedJoints {
    fn sample(&mut self, take: &Take, skeleton: &Skeleton, time: f32) {
        self.poses.resize(skeleton.len(), Transform::IDENTITY);
        self.to_root.resize(skeleton.len(), Mat4::IDENTITY);
        sample_take(Some(take), skeleton, time, &mut self.poses);
        to_root(skeleton, &self.poses, &mut self.to_root);
    }
}

/// Draws the second skeleton.
#[derive(Default)]
pub(super) struct ComparedGraphic {
    second: PosedJoints,
    /// The pose that it is compared with, where that is not the pose shown.
    first: PosedJoints,
}

impl GraphicComponent for ComparedGraphic {
    fn present(&mut self, frame: &ControlFrame<'_>, shape: &mut GizmoShape) {
        let compared = frame.appearances.get::<ComparedAppearance>();
        let Some(second) = compared.and_then(|compared| compared.second.as_ref()) else { return };
        let own = &frame.model.loaded().model.animation.skeleton;
        let skeleton = second.other.as_ref().map_or(own, |other| &other.skeleton);
        let time = second.times.map_or(frame.model.at().1, |times| times[0]);
        self.second.sample(&second.take, skeleton, time);
        let first = match second.times {
            Some([_, time]) => {
                self.first.sample(&second.take, own, time);
                &self.first.to_root[..]
            }
            None => frame.model.to_root(),
        };
        let joint = |bone: usize| {
            let at = place(self.second.to_root.get(bone)?) * second.scale + second.offset;
            Some(at).filter(|at| at.is_finite())
        };
        let pair = |bone: usize| match &second.other {
            None => Some(bone),
            Some(other) => other.first_of.get(bone).copied().flatten().map(|bone| bone as usize),
        };
        let shown = |bone: usize| first.get(pair(bone)?).map(place);
        let apart = |bone: usize| Some(shown(bone)?.distance(joint(bone)?)).filter(|apart| apart.is_finite());
        let bones = 0..skeleton.len();
        let most = bones.clone().filter_map(apart).fold(0.0, f32::max);
        let size = bones.filter_map(shown).filter(|at| at.is_finite()).map(Vec3::length).fold(0.0, f32::max);
        let is_beside = second.other.as_ref().is_some_and(|other| other.first_of.is_empty());
        if most <= EQUAL * size && !is_beside {
            return;
        }
        let is_drawn = |bone: usize| {
            pair(bone).is_none_or(|bone| {
                let bone = bone as BoneIndex;
                !frame.look.hidden.is_hidden(bone) && frame.model.shape().is_joint(bone)
            })
        };
        // A bone goes from its joint to its children; the last one of a limb comes from its parent.
        let marked = second.other.as_ref().and_then(|other| other.marked);
        let is_last = !skeleton.bones.iter().any(|bone| marked.is_some() && bone.parent == marked);
        let is_marked = |bone: usize, parent: Option<usize>| {
            let end = if is_last { Some(bone) } else { parent };
            marked.is_some() && end == marked.map(|marked| marked as usize)
        };
        for (index, bone) in skeleton.bones.iter().enumerate() {
            let Some(at) = joint(index).filter(|_| is_drawn(index)) else { continue };
            let distance = apart(index).unwrap_or(0.0);
            let part = if most > 0.0 { distance / most } else { 0.0 };
            let parent = bone.parent.map(|parent| parent as usize).filter(|parent| *parent < index);
            if let Some(shown) = shown(index).filter(|shown| shown.is_finite()) {
                if distance > EQUAL * size {
                    shape.add_line(shown, at, GizmoRole::View, 0.9 * part);
                }
                let from = parent.and_then(|parent| first.get(pair(parent)?).map(place));
                if let Some(from) = from.filter(|from| second.times.is_some() && from.is_finite()) {
                    shape.add_line(from, shown, GizmoRole::Past, 0.6);
                }
            }
            // A bone at the scene's own root has no length that means anything.
            let from = parent.filter(|parent| skeleton.bones[*parent].parent.is_some() || !is_beside);
            if let Some(from) = from.and_then(joint) {
                let (role, strength) = match () {
                    () if is_marked(index, parent) => (GizmoRole::Active, 1.0),
                    () if is_beside => (GizmoRole::Future, 0.8),
                    () => (GizmoRole::Future, 0.25 + 0.7 * part),
                };
                shape.add_line(from, at, role, strength);
            }
        }
    }
}

fn place(matrix: &Mat4) -> Vec3 {
    matrix.w_axis.truncate()
}
