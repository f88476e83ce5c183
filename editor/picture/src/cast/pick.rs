//! Picking the things of a scene, in the state computed last.

use super::{CastMember, PosedScene};
use crate::camera::CameraRay;
use dragonfly_anim::data::{BoneIndex, ModelData};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::hit::{HitPose, HitSettings, HitTree, Ray};
use dragonfly_anim::stage::ThingState;
use glam::{Affine3A, Vec3};
use std::sync::Arc;

/// A thing that was picked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PickedThing {
    /// Its id.
    pub thing: Arc<str>,
    /// The bone with the most influence where it was hit; `None` for things without bones, and for things in a region.
    pub bone: Option<BoneIndex>,
}

/// Finds where rays hit the things that share a model.
pub(super) struct GroupPicker {
    /// `None` if there are too many triangles for a tree.
    tree: Option<(Evaluator, HitPose)>,
}

impl GroupPicker {
    pub(super) fn new(model: &Arc<ModelData>) -> Self {
        let tree = HitTree::of(model).ok();
        Self { tree: tree.map(|tree| (Evaluator::new(Arc::clone(model)), HitPose::new(Arc::new(tree)))) }
    }

    /// Returns the bone and the distance of the first hit, in the space of the thing.
    fn hit(&mut self, state: &ThingState, ray: &Ray) -> Option<(Option<BoneIndex>, f32)> {
        let (evaluator, pose) = self.tree.as_mut()?;
        evaluator.pose_with(None, 0.0, |poses| {
            if let Some(shown) = state.pose.as_ref().filter(|shown| shown.pose.bones() == poses.len()) {
                shown.pose.write_to(poses);
            }
        });
        pose.refit(evaluator);
        let hit = pose.ray(evaluator, ray, &HitSettings::default())?;
        Some((hit.bone, hit.distance))
    }
}

impl PosedScene {
    /// Returns the things on a line of sight, nearest first, each once.
    pub(crate) fn pick(&mut self, ray: &CameraRay) -> Vec<PickedThing> {
        let mut hits: Vec<(f32, usize, Option<BoneIndex>)> = Vec::new();
        for thing in 0..self.members.len() {
            let Some(CastMember { group, is_placeholder, .. }) = self.members[thing] else { continue };
            if !crosses(ray, self.box_of(thing).min, self.box_of(thing).max) {
                continue;
            }
            let state = &self.state.things[thing];
            let mut place = state.transform;
            if is_placeholder {
                place.scale = Vec3::ONE;
            }
            let to_model = Affine3A::from_mat4(place.to_matrix()).inverse();
            let direction = to_model.transform_vector3(ray.direction);
            let own = Ray {
                origin: to_model.transform_point3(ray.origin),
                direction: direction.normalize_or_zero(),
            };
            if let Some((bone, distance)) = self.groups[group].picker().hit(state, &own) {
                hits.push((distance / direction.length().max(f32::MIN_POSITIVE), thing, bone));
            }
        }
        hits.sort_by(|a, b| a.0.total_cmp(&b.0));
        hits.into_iter().map(|(_, thing, bone)| self.picked(thing, bone)).collect()
    }

    /// Returns the result for a thing.
    pub(crate) fn picked(&self, thing: usize, bone: Option<BoneIndex>) -> PickedThing {
        PickedThing { thing: Arc::from(&*self.plan.things()[thing].id), bone }
    }

    /// Returns the middle of what is drawn of a thing, or its place without anything to draw.
    pub fn middle_of(&self, thing: usize) -> Vec3 {
        let around = self.box_of(thing);
        if around.is_empty() { self.state.things[thing].transform.translation } else { around.center() }
    }

    /// Returns whether a thing has a place in the scene: everything but paths, and what is hidden.
    pub fn has_place(&self, thing: usize) -> bool {
        self.plan.things()[thing].path.is_none() && !self.is_hidden(thing)
    }

    /// Returns whether something is drawn of a thing.
    pub(crate) fn is_drawn(&self, thing: usize) -> bool {
        self.members[thing].is_some()
    }
}

/// Returns whether a ray crosses a box.
fn crosses(ray: &CameraRay, min: Vec3, max: Vec3) -> bool {
    let (mut near, mut far) = (0.0_f32, f32::INFINITY);
    for axis in 0..3 {
        let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
        if direction.abs() < f32::MIN_POSITIVE {
            if origin < min[axis] || origin > max[axis] {
                return false;
            }
            continue;
        }
        let [a, b] = [min[axis], max[axis]].map(|side| (side - origin) / direction);
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    near <= far
}
