//! Evaluation of a whole model at one time: bones, skins, morph weights, vertices, bounds.
//!
//! Used by the command line, and by renderers without a pipeline of their own. Everything here calls the formulas of
//! [`crate::sample`], [`crate::animation`] and [`crate::skin`], in order.

use crate::animation::{Animation, final_poses};
use crate::bounds::{BoneBoxes, Bounds, bounds_of_bones};
use crate::data::{MeshInstance, ModelData, Primitive, Transform};
use crate::sample::sample_morph_weights;
use crate::skin::{Movement, skin_normals, skin_positions};
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// A model and its most recent pose.
#[derive(Debug)]
pub struct Evaluator {
    model: Arc<ModelData>,
    animation: Animation,
    /// One list per skin, one matrix per joint.
    finals: Vec<Vec<Mat4>>,
    /// One list per instance, one weight per morph target.
    morph_weights: Vec<Vec<f32>>,
}

impl Evaluator {
    /// Creates an evaluator of `model` in its rest pose.
    pub fn new(model: Arc<ModelData>) -> Self {
        let finals = model.skins.iter().map(|skin| vec![Mat4::IDENTITY; skin.bones.len()]).collect();
        let morph_weights =
            model.instances.iter().map(|instance| vec![0.0; targets(&model, instance)]).collect();
        let animation = Animation::of(&model);
        let mut evaluator = Self { model, animation, finals, morph_weights };
        evaluator.pose(None, 0.0);
        evaluator
    }

    /// Poses the model as take number `take` at `time` seconds, clamped to the keys; `None`, or a number past the end,
    /// is the rest pose. Allocates nothing.
    pub fn pose(&mut self, take: Option<usize>, time: f32) {
        self.animation.to_root_bone_poses(take, time);
        self.pose_rest(take, time);
    }

    /// As [`Self::pose`], but `change` may alter the pose of every bone, parent space, before the matrices are
    /// computed.
    pub fn pose_with(&mut self, take: Option<usize>, time: f32, change: impl FnOnce(&mut [Transform])) {
        self.animation.to_root_bone_poses(take, time);
        self.animation.to_root_bone_poses_with(change);
        self.pose_rest(take, time);
    }

    /// Computes the matrices that depend on the bones, and the morph weights.
    fn pose_rest(&mut self, take: Option<usize>, time: f32) {
        for (skin, finals) in self.model.skins.iter().zip(&mut self.finals) {
            final_poses(skin, self.animation.to_root(), finals);
        }
        let take = take.and_then(|take| self.animation.data().takes.get(take));
        let instances = self.model.instances.iter().zip(&mut self.morph_weights);
        for (index, (instance, weights)) in instances.enumerate() {
            let take = take.map(Arc::as_ref);
            sample_morph_weights(take, index as u32, &instance.morph_weights, time, weights);
        }
    }

    /// Returns the model.
    pub fn model(&self) -> &Arc<ModelData> {
        &self.model
    }

    /// Returns the animation; a take replaced in it is used by the next [`Self::pose`].
    pub fn animation_mut(&mut self) -> &mut Animation {
        &mut self.animation
    }

    /// Returns `to_root` of every bone: bone space → scene space.
    pub fn to_root(&self) -> &[Mat4] {
        self.animation.to_root()
    }

    /// Returns the final poses of the joints of skin number `skin`: bind space → scene space. Empty when there is no
    /// such skin.
    pub fn final_poses(&self, skin: usize) -> &[Mat4] {
        self.finals.get(skin).map_or(&[], Vec::as_slice)
    }

    /// Returns the weights of the morph targets of instance number `instance`. Empty when it has none.
    pub fn morph_weights(&self, instance: usize) -> &[f32] {
        self.morph_weights.get(instance).map_or(&[], Vec::as_slice)
    }

    /// As [`Self::morph_weights`], for weights that the takes do not have; the next pose replaces them.
    pub fn morph_weights_mut(&mut self, instance: usize) -> &mut [f32] {
        self.morph_weights.get_mut(instance).map_or(&mut [], Vec::as_mut_slice)
    }

    /// Returns the primitives of instance number `instance`, in file order. Empty when there is no such instance or
    /// mesh.
    pub fn primitives(&self, instance: usize) -> &[Primitive] {
        let instance = self.model.instances.get(instance);
        let mesh = instance.and_then(|instance| self.model.meshes.get(instance.mesh as usize));
        mesh.map_or(&[], |mesh| &mesh.primitives)
    }

    /// Returns the movement of primitive number `primitive` of instance number `instance`; `None` when there is none.
    pub fn movement(&self, instance: usize, primitive: usize) -> Option<Movement<'_>> {
        let primitive = self.primitives(instance).get(primitive)?;
        let instance = self.model.instances.get(instance)?;
        let finals = instance.skin.map_or(&[][..], |skin| self.final_poses(skin as usize));
        Some(Movement::of(instance, primitive, self.to_root(), finals))
    }

    /// Writes the positions of a primitive's vertices, up to the length of `out`: scene space, morphed and skinned, in
    /// file order. Returns the number written. Allocates nothing.
    pub fn positions(&self, instance: usize, primitive: usize, out: &mut [Vec3]) -> usize {
        let Some(movement) = self.movement(instance, primitive) else { return 0 };
        let weights = self.morph_weights(instance);
        skin_positions(&self.primitives(instance)[primitive], movement, weights, out)
    }

    /// Writes the normals of a primitive's vertices, up to the length of `out`: scene space, unit length, in file
    /// order. Returns the number written. Allocates nothing.
    pub fn normals(&self, instance: usize, primitive: usize, out: &mut [Vec3]) -> usize {
        let Some(movement) = self.movement(instance, primitive) else { return 0 };
        let weights = self.morph_weights(instance);
        skin_normals(&self.primitives(instance)[primitive], movement, weights, out)
    }

    /// Returns the positions of all vertices of all instances, in order: scene space.
    pub fn all_positions(&self) -> Vec<Vec3> {
        let mut all = Vec::new();
        for instance in 0..self.model.instances.len() {
            for (index, primitive) in self.primitives(instance).iter().enumerate() {
                let start = all.len();
                all.resize(start + primitive.vertices.len(), Vec3::ZERO);
                self.positions(instance, index, &mut all[start..]);
            }
        }
        all
    }

    /// Returns the box and sphere around every vertex in this pose; around the origins of the bones when there is no
    /// vertex.
    ///
    /// Exact for a model of usual size. A file of some kilobytes may place a mesh so often that computing every vertex
    /// takes minutes and gigabytes: beyond [`MEASURED_STEPS`] the result is that of [`BoneBoxes`], never too small.
    pub fn bounds(&self) -> Bounds {
        if !self.can_measure() {
            return BoneBoxes::of(&self.model).bounds(self);
        }
        let positions = self.all_positions();
        if positions.is_empty() { bounds_of_bones(self.to_root()) } else { Bounds::of_points(&positions) }
    }

    /// Returns points around the model in this pose, for a camera that must show all of it: every vertex or, beyond
    /// [`MEASURED_STEPS`], the corners of a box around each primitive; the origins of the bones when there is no
    /// vertex.
    pub fn outline(&self) -> Vec<Vec3> {
        let mut points = if self.can_measure() { self.all_positions() } else { self.corners() };
        if points.is_empty() {
            points.extend(self.to_root().iter().map(|to_root| to_root.w_axis.truncate()));
        }
        points
    }

    /// Returns the corners of a box around each primitive of each instance.
    fn corners(&self) -> Vec<Vec3> {
        let boxes = BoneBoxes::of(&self.model);
        let mut points = Vec::new();
        for instance in 0..self.model.instances.len() {
            for primitive in 0..self.primitives(instance).len() {
                points.extend(boxes.of_primitive(self, instance, primitive).corners());
            }
        }
        points
    }

    /// Returns whether computing every vertex takes at most [`MEASURED_STEPS`].
    fn can_measure(&self) -> bool {
        let steps = |primitive: &Primitive| {
            let vertices = &primitive.vertices;
            let each = 1 + vertices.influences_per_vertex + primitive.morph_targets.len();
            (vertices.len() as u64).saturating_mul(each as u64)
        };
        let of_mesh = |primitives: &[Primitive]| primitives.iter().map(steps).fold(0, u64::saturating_add);
        let meshes: Vec<u64> = self.model.meshes.iter().map(|mesh| of_mesh(&mesh.primitives)).collect();
        let placed = self.model.instances.iter().filter_map(|instance| meshes.get(instance.mesh as usize));
        placed.copied().fold(0, u64::saturating_add) <= MEASURED_STEPS
    }
}

/// Largest cost of measuring a pose on its vertices: one step for each vertex of each instance, and one more for each
/// of its influences and morph targets.
pub const MEASURED_STEPS: u64 = 4 << 20;

/// Returns the largest number of morph targets of any primitive of the instance's mesh.
fn targets(model: &ModelData, instance: &MeshInstance) -> usize {
    let mesh = model.meshes.get(instance.mesh as usize);
    let primitives = mesh.map_or(&[][..], |mesh| &mesh.primitives);
    primitives.iter().map(|primitive| primitive.morph_targets.len()).max().unwrap_or(0)
}
