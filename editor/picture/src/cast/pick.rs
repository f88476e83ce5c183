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

/// A place on the surface of a thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// The thing: a position in the cast.
    pub thing: usize,
    /// The bone with the most influence there; `None` for things without bones.
    pub bone: Option<BoneIndex>,
    /// Distance from the start of the ray, meters.
    pub distance: f32,
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
        let mut start = 0;
        for instance in 0..evaluator.model().instances.len() {
            let weights = evaluator.morph_weights_mut(instance);
            let shown = state.pose.as_ref().and_then(|pose| pose.shapes.get(start..start + weights.len()));
            if let Some(shown) = shown {
                weights.copy_from_slice(shown);
            }
            start += weights.len();
        }
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
            if self.reach(ray, thing).is_some() {
                hits.extend(self.hit(ray, thing).map(|(distance, bone)| (distance, thing, bone)));
            }
        }
        hits.sort_by(|a, b| a.0.total_cmp(&b.0));
        hits.into_iter().map(|(_, thing, bone)| self.picked(thing, bone)).collect()
    }

    /// Returns the nearest thing on a line of sight.
    pub(crate) fn pick_first(&mut self, ray: &CameraRay) -> Option<PickedThing> {
        self.hit_first(ray).map(|hit| self.picked(hit.thing, hit.bone))
    }

    /// Returns where a ray first hits the surface of a thing, as posed last. The surfaces of things whose boxes are farther away than it are not searched.
    pub fn hit_first(&mut self, ray: &CameraRay) -> Option<SurfaceHit> {
        let boxes = (0..self.members.len()).filter_map(|thing| Some((self.reach(ray, thing)?, thing)));
        let mut boxes: Vec<(f32, usize)> = boxes.collect();
        boxes.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut first: Option<(f32, usize, Option<BoneIndex>)> = None;
        for (near, thing) in boxes {
            if first.is_some_and(|first| first.0 < near) {
                break;
            }
            let hit = self.hit(ray, thing).map(|(distance, bone)| (distance, thing, bone));
            let is_nearer = |hit: &(f32, usize, _)| {
                first.is_none_or(|first| hit.0.total_cmp(&first.0).then(hit.1.cmp(&first.1)).is_lt())
            };
            first = hit.filter(is_nearer).or(first);
        }
        first.map(|(distance, thing, bone)| SurfaceHit { thing, bone, distance })
    }

    /// Returns the distance at which a ray enters the box around what is drawn of a thing; `None` where it does not.
    fn reach(&self, ray: &CameraRay, thing: usize) -> Option<f32> {
        self.members[thing]?;
        crosses(ray, self.box_of(thing).min, self.box_of(thing).max)
    }

    /// Returns the distance at which a ray hits the surface of a thing, and the bone there.
    fn hit(&mut self, ray: &CameraRay, thing: usize) -> Option<(f32, Option<BoneIndex>)> {
        let CastMember { group, is_placeholder, .. } = self.members[thing]?;
        let state = &self.state.things[thing];
        let mut place = state.transform;
        if is_placeholder {
            place.scale = Vec3::ONE;
        }
        let to_model = Affine3A::from_mat4(place.to_matrix()).inverse();
        let direction = to_model.transform_vector3(ray.direction);
        let own =
            Ray { origin: to_model.transform_point3(ray.origin), direction: direction.normalize_or_zero() };
        let (bone, distance) = self.groups[group].picker().hit(state, &own)?;
        Some((distance / direction.length().max(f32::MIN_POSITIVE), bone))
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

/// Returns the distance at which a ray enters a box, 0 from inside, in lengths of its direction; `None` where it does not cross it.
fn crosses(ray: &CameraRay, min: Vec3, max: Vec3) -> Option<f32> {
    let (mut near, mut far) = (0.0_f32, f32::INFINITY);
    for axis in 0..3 {
        let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
        if direction.abs() < f32::MIN_POSITIVE {
            if origin < min[axis] || origin > max[axis] {
                return None;
            }
            continue;
        }
        let [a, b] = [min[axis], max[axis]].map(|side| (side - origin) / direction);
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    (near <= far).then_some(near)
}
